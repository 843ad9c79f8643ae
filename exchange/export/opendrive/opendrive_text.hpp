#pragma once

#include <string>

#include "exchange/export/geo_origin.hpp"
#include "exchange/export/opendrive/opendrive_objects.hpp"

namespace roadbook {

/// Returns the OpenDRIVE 1.6 file, in the map frame, or with `to_degrees` in metres east and north
/// of the origin.
[[nodiscard]] std::string opendrive_text(const PlannerMap& planner,
                                         const DriveRoads& roads,
                                         const DriveObjects& objects,
                                         const ToDegrees* to_degrees);

}  // namespace roadbook
