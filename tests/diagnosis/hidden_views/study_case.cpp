#include "tests/diagnosis/hidden_views/study_case.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/streams/drive_session.hpp"
#include "diagnosis/views/view_problem.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/diagnosis/hidden_views/visits.hpp"
#include "tests/support/diagnosis_outcome.hpp"

namespace roadbook::test {
namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// The oracle: the true size and no other effect.
void ask_oracle(const ViewProblem& problem, ViewOutcome& outcome) {
  const CauseModel nominal = problem.nominal();
  for (Candidate c : problem.candidates(nominal)) {
    const auto hidden = outcome.hidden.secret.find(c.name);
    if (hidden == outcome.hidden.secret.end() || c.kind != CandidateKind::kNamed) continue;
    c.columns = {0};
    CauseModel truth = nominal;
    accept(truth, c);
    problem.fit(truth, 4);
    outcome.strength =
        std::max(outcome.strength, std::abs(hidden->second) * std::sqrt(truth.information(0, 0)));
    const double off = truth.accepted[0].size[0] - hidden->second;
    outcome.oracle_gain +=
        truth.log_likelihood - 0.5 * truth.information(0, 0) * off * off - nominal.log_likelihood;
  }
}

// The hidden drive, read from its files.
struct HiddenFiles {
  Drive drive;
  Map map;
  int session = 0;
};

HiddenFiles write_and_read(const HiddenViewOptions& hidden, const std::filesystem::path& folder) {
  write_hidden_views(hidden, folder);
  DriveOptions options;
  options.num_threads = 1;
  Drive drive = Drive::open(folder / "drive", options);
  Map map = load_map(folder / "map.gpkg");
  const int session = session_of(map, drive, folder / "map.gpkg");
  return {std::move(drive), std::move(map), session};
}

}  // namespace

bool ViewOutcome::named_first(const std::string& effect) const {
  return !found.causes.empty() && found.causes.front().effect == effect;
}

bool ViewOutcome::in_set(const std::string& effect) const {
  return named_first(effect) ||
         (!found.causes.empty() && holds(found.causes.front().inseparable, effect));
}

bool ViewOutcome::names(const std::string& effect) const {
  return std::any_of(found.causes.begin(), found.causes.end(), [&](const FoundCause& c) {
    return c.effect == effect || holds(c.inseparable, effect);
  });
}

const FoundCause* ViewOutcome::cause(const std::string& effect) const {
  for (const FoundCause& c : found.causes)
    if (c.effect == effect) return &c;
  return nullptr;
}

std::size_t ViewOutcome::extra() const {
  std::size_t count = found.unknown.size();
  for (const FoundCause& c : found.causes) {
    bool known = c.effect.ends_with(".outliers") && hidden.outliers > 0.0;
    for (const auto& [name, size] : hidden.secret)
      known = known || c.effect == name || holds(c.inseparable, name);
    count += known ? 0 : 1;
  }
  return count;
}

std::string ViewOutcome::to_line() const {
  return outcome_line(hidden.seed, hidden.secret, strength, found);
}

ViewOutcome run_hidden_views(const HiddenViewOptions& hidden,
                             const std::filesystem::path& folder,
                             const std::vector<std::string>& without) {
  ViewOutcome outcome;
  outcome.hidden = hidden;
  const HiddenFiles read = write_and_read(hidden, folder);
  const double start = thread_seconds();
  LibraryOptions library;
  library.without = without;
  const ViewProblem problem(view_data(read.map, read.session, read.drive), {}, library);
  outcome.found = diagnose(problem);
  outcome.seconds = thread_seconds() - start;
  ask_oracle(problem, outcome);
  return outcome;
}

ViewOutcome run_hidden_map(const HiddenViewOptions& hidden, const std::filesystem::path& folder) {
  ViewOutcome outcome;
  outcome.hidden = hidden;
  const HiddenFiles read = write_and_read(hidden, folder);
  const double start = thread_seconds();
  outcome.found = diagnose_through_map(read.map, read.session, read.drive);
  double gone = 0.0;
  for (const GoneClump& clump : read_gone(folder / "gone.csv")) gone += clump.share;
  if (gone > 0.0) outcome.hidden.secret["map.landmarks_gone"] = gone;
  outcome.seconds = thread_seconds() - start;
  return outcome;
}

}  // namespace roadbook::test
