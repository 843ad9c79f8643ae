#pragma once

#include <filesystem>

#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

// Hides effects in the readings of a range scanner that drives laps in a hall with pillars and
// parked cars. Shares only the names of effects with diagnosis.

struct RangeSecret {
  std::uint64_t seed = 1;
  int laps = 2;
  Secret secret;
};

/// Records and writes a native drive: poses and range0 with the directions of its beams.
void write_range_drive(const RangeSecret& hidden, const std::filesystem::path& folder);

/// Practical ranges of the seven effects.
[[nodiscard]] const std::vector<EffectRange>& range_ranges();

}  // namespace roadbook::test
