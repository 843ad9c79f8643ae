#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/routing/routing.hpp"

namespace roadbook {

// Links parking spaces to the lanes that lead into them, and checks whether they can be reached.

/// Position and direction of a parking space.
struct SpacePlace {
  std::uint64_t id = 0;
  Eigen::Vector3d front = Eigen::Vector3d::Zero();     ///< middle of the open side [m]
  Eigen::Vector2d outwards = Eigen::Vector2d::Zero();  ///< unit, from the back to the open side
};

/// Makes a SpacePlace from the corners [m, map]: the two of the open side first, then the two of
/// the back.
[[nodiscard]] SpacePlace space_place(std::uint64_t id, const std::vector<Eigen::Vector3d>& corners);

struct LaneLinkOptions {
  double reach_m = 10.0;  ///< from the open side to the lane's centre
  double cone_rad = 1.3;  ///< largest angle between the space's direction and that to the lane

  /// Throws InvalidOption.
  void check() const;
};

enum class LinkStatus : std::uint8_t {
  kLinked,
  kNoLaneNear,  ///< none within reach
  kNotBefore,   ///< one is within reach, but not before the open side
};

struct LaneLink {
  std::uint64_t space = 0;
  LinkStatus status = LinkStatus::kNoLaneNear;
  NetworkPlace place;  ///< of the link, or of the nearest lane if there is no link (lane -1: none)
  std::uint64_t lane = 0;  ///< id of that lane
  bool left = false;       ///< the space lies to the left of the lane's direction
  std::string reason;      ///< empty where linked
};

/// Returns one link for each space, in their order: to the nearest lane position in front of the
/// open side.
[[nodiscard]] std::vector<LaneLink> link_spaces(const RoadNetwork& network,
                                                const std::vector<SpacePlace>& spaces,
                                                const LaneLinkOptions& options = {});

struct SpaceAccess {
  std::uint64_t space = 0;
  bool reachable = false;  ///< from the entrance, and back to it
  double way_in_m = 0.0;   ///< length of the route there
  std::string reason;      ///< empty where reachable
};

/// Whether each space can be reached from `entrance` and left again.
[[nodiscard]] std::vector<SpaceAccess> space_access(const Router& router,
                                                    const std::vector<LaneLink>& links,
                                                    const NetworkPlace& entrance);

}  // namespace roadbook
