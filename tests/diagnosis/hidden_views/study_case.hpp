#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "tests/diagnosis/hidden_views/view_injector.hpp"

namespace roadbook::test {

/// Diagnosis of one drive with hidden effects, through its map.
struct ViewOutcome {
  HiddenViewOptions hidden;
  Diagnosis found;
  double strength = 0.0;     ///< size over its standard error, nothing else free
  double oracle_gain = 0.0;  ///< [nats] of the true model over the nominal one; 0 for hinges, noise
  double seconds = 0.0;      ///< of processor time, from the read map to the result

  [[nodiscard]] bool named_first(const std::string& effect) const;
  /// True if `effect` is the first one found or in its equivalence set.
  [[nodiscard]] bool in_set(const std::string& effect) const;
  /// True if `effect` is found or in any equivalence set.
  [[nodiscard]] bool names(const std::string& effect) const;
  [[nodiscard]] const FoundCause* cause(const std::string& effect) const;
  /// Number of effects found that are neither hidden nor confounded with a hidden one.
  [[nodiscard]] std::size_t extra() const;
  [[nodiscard]] std::string to_line() const;
};

/// Writes drive and map to `folder` and diagnoses the views of the map from the files.
[[nodiscard]] ViewOutcome run_hidden_views(const HiddenViewOptions& hidden,
                                           const std::filesystem::path& folder,
                                           const std::vector<std::string>& without = {});
/// The same with all that `diagnose DRIVE -m MAP` looks at: also the map itself, as wheels, gyro
/// and other drives' landmarks judge it. Strength and the oracle's gain are not asked for. Of
/// "map.landmarks_gone" the outcome's secret holds the share that the clumps came to.
[[nodiscard]] ViewOutcome run_hidden_map(const HiddenViewOptions& hidden,
                                         const std::filesystem::path& folder);

}  // namespace roadbook::test
