#pragma once

#include <filesystem>

#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

// Hides effects in friction readings: laps of a closed road at varying speed, with gravel and
// water. Shares only the names of effects with diagnosis.

struct FrictionSecret {
  std::uint64_t seed = 1;
  double duration_s = 900.0;
  Secret secret;
  int resurfaced = 1;         ///< discs of `friction0.extra_class`, apart from each other
  double wrong_labels = 0.0;  ///< share of readings that carry another class's label
  bool temperature = true;    ///< logged
  bool surface = true;        ///< labelled
};

/// Records and writes a native drive: poses and friction0.
void write_friction_drive(const FrictionSecret& hidden, const std::filesystem::path& folder);

/// Practical ranges of the ten effects.
[[nodiscard]] const std::vector<EffectRange>& friction_ranges();

}  // namespace roadbook::test
