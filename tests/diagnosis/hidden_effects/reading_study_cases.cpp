#include "tests/diagnosis/hidden_effects/reading_study_cases.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"

namespace roadbook::test {
namespace {

ReadingOutcome diagnosed(const std::filesystem::path& folder,
                         const Secret& secret,
                         std::uint64_t seed,
                         const std::vector<std::string>& without) {
  ReadingOutcome outcome;
  outcome.secret = secret;
  outcome.seed = seed;
  LibraryOptions library;
  library.without = without;
  const auto before = std::clock();
  const Drive drive = Drive::open(folder);
  const DriveReadings readings = drive_readings(drive, motion_streams(drive).poses);
  outcome.found = diagnose_readings(readings, {}, library);
  outcome.seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  if (without.empty()) outcome.oracle = ask_oracle(readings, secret);
  return outcome;
}

}  // namespace

bool ReadingOutcome::named_first(const std::string& effect) const {
  return !found.causes.empty() && found.causes.front().effect == effect;
}

bool ReadingOutcome::in_set(const std::string& effect) const {
  if (found.causes.empty()) return false;
  const auto& set = found.causes.front().inseparable;
  return named_first(effect) || std::find(set.begin(), set.end(), effect) != set.end();
}

const FoundCause* ReadingOutcome::cause(const std::string& effect) const {
  for (const FoundCause& c : found.causes)
    if (c.effect == effect) return &c;
  return nullptr;
}

std::string ReadingOutcome::to_line() const {
  char text[200];
  std::string line = "seed " + std::to_string(seed) + ":";
  for (const auto& [name, size] : secret) {
    std::snprintf(text, sizeof text, " %s=%.4g", name.c_str(), size);
    line += text;
  }
  line += " ->";
  for (const FoundCause& c : found.causes) {
    std::snprintf(text, sizeof text, " %s=%.4g(%.4g..%.4g)gain%.1f", c.effect.c_str(), c.size,
                  c.low, c.high, c.gain.total);
    line += text;
    for (const auto& other : c.inseparable) line += "|" + other;
  }
  for (const UnknownCause& u : found.unknown) line += " ?" + u.hook + "~" + u.depends_on;
  for (const std::string& u : found.unexplained) line += " !" + u;
  std::snprintf(text, sizeof text, " oracle z%.1f gain%.1f %.2fs", oracle.strength, oracle.gain,
                seconds);
  return line + text;
}

ReadingOutcome run_friction(const FrictionSecret& hidden,
                            const std::filesystem::path& folder,
                            const std::vector<std::string>& without) {
  write_friction_drive(hidden, folder);
  return diagnosed(folder, hidden.secret, hidden.seed, without);
}

ReadingOutcome run_range(const RangeSecret& hidden,
                         const std::filesystem::path& folder,
                         const std::vector<std::string>& without) {
  write_range_drive(hidden, folder);
  return diagnosed(folder, hidden.secret, hidden.seed, without);
}

ReadingOutcome run_detector(const DetectorSecret& hidden,
                            const std::filesystem::path& folder,
                            const std::vector<std::string>& without) {
  write_detector_drive(hidden, folder);
  return diagnosed(folder, hidden.secret, hidden.seed, without);
}

}  // namespace roadbook::test
