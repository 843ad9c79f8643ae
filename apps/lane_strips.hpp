#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadnet/lane_path.hpp"
#include "roadnet/path_frame.hpp"
#include "speedmap/knots.hpp"

namespace roadbook {

/// All lanes of a map in one property map, so that they share the classes: lane after lane along s,
/// farther apart than the kernel reaches. A ring is a strip that ends where it begins.
class LaneStrips {
 public:
  /// Lanes without a path are left out; throws Refused where none is left.
  LaneStrips(const std::vector<LanePath>& lanes, double spacing_m, double kernel_width_m);

  struct Strip {
    std::uint64_t lane = 0;
    double begin_m = 0.0;  ///< where its s = 0 lies in the property map
    double half_width_m = 0.0;
    PathFrame frame;
  };
  [[nodiscard]] const std::vector<Strip>& strips() const { return strips_; }
  [[nodiscard]] const Knots& knots() const { return *knots_; }

  /// Places of a point of the map frame in all the lanes whose tube holds it.
  void places_of(const Eigen::Vector2d& p, std::vector<PathPlace>& places) const;
  /// Strip that holds a place of the property map, and s within its lane.
  [[nodiscard]] const Strip& strip_of(const PathPlace& place) const;

 private:
  std::vector<Strip> strips_;
  std::optional<Knots> knots_;
};

}  // namespace roadbook
