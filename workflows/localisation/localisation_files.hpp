#pragma once

#include <string>
#include <vector>

#include "mapping/localisation/localise_drive.hpp"

namespace roadbook {

/// A TUM trajectory (`timestamp tx ty tz qx qy qz qw`) of the localised frames in the map frame;
/// `with_predicted`: of the predicted frames too.
[[nodiscard]] std::string localised_tum(const std::vector<TimedFrame>& frames, bool with_predicted);

/// A CSV table with a row for each frame (docs/guide/localisation.md). Unknown values are
/// empty. `map`: where the frames were localised.
[[nodiscard]] std::string localised_csv(const std::vector<TimedFrame>& frames, const Map& map);

}  // namespace roadbook
