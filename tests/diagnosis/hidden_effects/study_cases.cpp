#include "tests/diagnosis/hidden_effects/study_cases.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/oracle.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "drive/drive.hpp"
#include "tests/support/diagnosis_outcome.hpp"

namespace roadbook::test {

bool Outcome::named_first(const std::string& effect) const {
  return !found.causes.empty() && found.causes.front().effect == effect &&
         (found.unknown.empty() ||
          found.unknown.front().gain.total < found.causes.front().gain.total);
}

bool Outcome::in_set(const std::string& effect) const {
  if (named_first(effect)) return true;
  if (found.causes.empty()) return false;
  const auto& set = found.causes.front().inseparable;
  return std::find(set.begin(), set.end(), effect) != set.end();
}

const FoundCause* Outcome::cause(const std::string& effect) const {
  for (const FoundCause& c : found.causes)
    if (c.effect == effect) return &c;
  return nullptr;
}

bool Outcome::unknown_but_right(const OutsideEffect& outside) const {
  if (found.unknown.empty()) return false;
  const UnknownCause& u = found.unknown.front();
  const std::pair<std::string, std::string> said{u.stream + "." + u.hook, u.depends_on};
  return std::find(outside.readings.begin(), outside.readings.end(), said) !=
         outside.readings.end();
}

std::string Outcome::to_line() const {
  return outcome_line(hidden.seed, hidden.secret, strength, found);
}

namespace {

MotionStreams record_and_read(const HiddenDriveOptions& hidden,
                              const std::filesystem::path& folder) {
  write_recording(record_drive(hidden), folder);
  DriveOptions options;
  options.num_threads = 1;
  return motion_streams(Drive::open(folder, options));
}

Outcome diagnosis_alone(const MotionStreams& streams,
                        const HiddenDriveOptions& hidden,
                        const std::filesystem::path& folder,
                        const std::vector<std::string>& without) {
  Outcome outcome;
  outcome.hidden = hidden;
  DiagnosisOptions options;
  options.library.without = without;
  const double start = thread_seconds();
  outcome.found = diagnose(streams, folder.string(), options);
  outcome.seconds = thread_seconds() - start;
  return outcome;
}

}  // namespace

Outcome diagnose_hidden(const HiddenDriveOptions& hidden,
                        const std::filesystem::path& folder,
                        const std::vector<std::string>& without) {
  return diagnosis_alone(record_and_read(hidden, folder), hidden, folder, without);
}

Outcome run_hidden(const HiddenDriveOptions& hidden,
                   const std::filesystem::path& folder,
                   const std::vector<std::string>& without) {
  const MotionStreams streams = record_and_read(hidden, folder);
  Outcome outcome = diagnosis_alone(streams, hidden, folder, without);
  const OracleAnswer oracle = ask_oracle(streams, hidden.secret);
  outcome.strength = oracle.strength;
  outcome.oracle_gain = oracle.gain;
  return outcome;
}

}  // namespace roadbook::test
