#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/hidden_effects/column_injector.hpp"

namespace roadbook::test {

/// One drive with further columns logged, and what was made of its files.
struct ColumnOutcome {
  HiddenDriveOptions hidden;
  std::string hook;    ///< of what was hidden; empty: nothing
  std::string column;  ///< that it depends on
  Diagnosis found;
  double seconds = 0.0;

  /// The first unknown has hook and column.
  [[nodiscard]] bool right() const;
  [[nodiscard]] bool quiet() const { return found.causes.empty() && found.unknown.empty(); }
  [[nodiscard]] std::string to_line() const;
};

/// Route, effect (one in turn), size, sign and the column that acts, from seed and index.
[[nodiscard]] ColumnOutcome run_hidden_column(std::uint64_t seed,
                                              std::uint64_t index,
                                              const std::filesystem::path& folder);
/// The same columns logged, and nothing depends on them.
[[nodiscard]] ColumnOutcome run_idle_columns(std::uint64_t seed,
                                             std::uint64_t index,
                                             const std::filesystem::path& folder);

/// Many of one of the two kinds; prints every drive that went wrong, and a line for all.
void study_columns(std::size_t drives, std::uint64_t seed, int threads, bool acting);

}  // namespace roadbook::test
