#include "tests/diagnosis/hidden_effects/column_study.hpp"

#include <unistd.h>

#include <cstdio>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "diagnosis/logs/plain_log.hpp"
#include "tests/support/diagnosis_outcome.hpp"

namespace roadbook::test {
namespace {

void run(ColumnOutcome& outcome,
         const std::vector<CarSignal>& signals,
         const std::filesystem::path& folder) {
  const auto description = write_plain_log(record_drive(outcome.hidden), signals, folder);
  const PlainLog log = read_plain_log(description);
  const double start = thread_seconds();
  outcome.found = diagnose(log.streams, description.string());
  outcome.seconds = thread_seconds() - start;
}

}  // namespace

bool ColumnOutcome::right() const {
  if (found.unknown.empty()) return false;
  const UnknownCause& u = found.unknown.front();
  return u.stream + "." + u.hook == hook && u.depends_on == column;
}

std::string ColumnOutcome::to_line() const {
  return outcome_line(hidden.seed, hidden.secret, 0.0, found) + " by " + column;
}

ColumnOutcome run_hidden_column(std::uint64_t seed,
                                std::uint64_t index,
                                const std::filesystem::path& folder) {
  ColumnOutcome outcome;
  Random random(seed, "hidden column", index);
  outcome.hidden.seed = random() >> 1U;
  const ColumnEffect& effect = column_effects()[index % column_effects().size()];
  outcome.hidden.secret[effect.range.name] = draw_size(effect.range, outcome.hidden.seed);
  const std::vector<CarSignal> signals = draw_signals(outcome.hidden.seed);
  const CarSignal& acting = signals[random.below(signals.size())];
  outcome.hidden.acting = acting.of;
  outcome.hook = effect.hook;
  outcome.column = acting.name;
  run(outcome, signals, folder);
  return outcome;
}

ColumnOutcome run_idle_columns(std::uint64_t seed,
                               std::uint64_t index,
                               const std::filesystem::path& folder) {
  ColumnOutcome outcome;
  outcome.hidden.seed = Random(seed, "idle columns", index)() >> 1U;
  run(outcome, draw_signals(outcome.hidden.seed), folder);
  return outcome;
}

void study_columns(std::size_t drives, std::uint64_t seed, int threads, bool acting) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("roadbook_study_" + std::to_string(::getpid()));
  std::vector<ColumnOutcome> outcomes(drives);
  parallel_for(drives, threads, [&](std::size_t i) {
    const auto drive = folder / std::to_string(i);
    outcomes[i] = acting ? run_hidden_column(seed, i, drive) : run_idle_columns(seed, i, drive);
    std::filesystem::remove_all(drive);
  });
  std::filesystem::remove_all(folder);
  std::size_t good = 0;
  double seconds = 0.0;
  for (const ColumnOutcome& o : outcomes) {
    const bool right = acting ? o.right() : o.quiet();
    good += right ? 1 : 0;
    seconds += o.seconds / static_cast<double>(drives);
    if (!right || o.found.causes.size() + o.found.unknown.size() > 1)
      std::printf("  %s\n", o.to_line().c_str());
  }
  std::printf("%s: %zu of %zu right, %.3f s a drive\n", acting ? "columns" : "idle columns", good,
              drives, seconds);
}

}  // namespace roadbook::test
