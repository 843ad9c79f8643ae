#pragma once

#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "speedmap/property_map/lane_strips.hpp"
#include "workflows/settings/friction_config.hpp"

namespace roadbook {

/// The data that an update used, and the data that it could not use.
struct FrictionSummary {
  std::size_t frames = 0;           ///< class images
  std::size_t cells = 0;            ///< ground cells added to the map
  std::vector<std::size_t> values;  ///< measurements that changed the map, by property
  std::size_t without_pose = 0;     ///< measured at times when the map has no pose
  std::size_t off_lanes = 0;        ///< measured outside all lanes
  std::size_t without_labels = 0;   ///< not used: too few class labels at the place
  int refreshes = 0;
  std::int64_t date_ns = 0;  ///< time of the newest measurement
};

/// Updates the friction map with a drive that is session `session` of the map, in the order of
/// time. Throws BadInput, with file and line, for values outside the plausible range of their
/// property.
[[nodiscard]] FrictionSummary update_friction(const Drive& drive,
                                              const Map& map,
                                              int session,
                                              const LaneStrips& strips,
                                              const FrictionConfig& config,
                                              PropertyMapper& mapper,
                                              const Progress& progress);

}  // namespace roadbook
