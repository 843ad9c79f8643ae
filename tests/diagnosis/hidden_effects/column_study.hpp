#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/hidden_effects/column_injector.hpp"

namespace roadbook::test {

/// One drive with further logged columns, and its diagnosis from the files.
struct ColumnOutcome {
  HiddenDriveOptions hidden;
  std::string hook;    ///< of what was hidden; empty: nothing
  std::string column;  ///< that it depends on
  Diagnosis found;
  double seconds = 0.0;

  /// True if the first unknown has the right stream and column.
  [[nodiscard]] bool right() const;
  [[nodiscard]] bool quiet() const { return found.causes.empty() && found.unknown.empty(); }
  [[nodiscard]] std::string to_line() const;
};

/// Draws route, effect (in turn), size, sign and the influencing column from seed and index.
[[nodiscard]] ColumnOutcome run_hidden_column(std::uint64_t seed,
                                              std::uint64_t index,
                                              const std::filesystem::path& folder);
/// The same columns, without influence on any sensor.
[[nodiscard]] ColumnOutcome run_idle_columns(std::uint64_t seed,
                                             std::uint64_t index,
                                             const std::filesystem::path& folder);

/// Runs many drives of one kind; prints every wrong one and a summary line.
void study_columns(std::size_t drives, std::uint64_t seed, int threads, bool acting);

}  // namespace roadbook::test
