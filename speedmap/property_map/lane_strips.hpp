#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadnet/paths/lane_path.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "speedmap/property_map/knots.hpp"

namespace roadbook {

/// All lanes of a map in one property map, so that they share the classes: lane after lane along s,
/// farther apart than the kernel reaches. A ring closes upon itself.
class LaneStrips {
 public:
  /// Lanes without a path are left out; throws Refused where none is left.
  LaneStrips(const std::vector<LanePath>& lanes, double spacing_m, double kernel_width_m);

  struct Strip {
    std::uint64_t lane = 0;
    double begin_m = 0.0;  ///< where its s = 0 lies in the property map
    double half_width_m = 0.0;
    PathFrame frame;
    [[nodiscard]] double length_m() const { return frame.curve().length_m(); }
  };
  [[nodiscard]] const std::vector<Strip>& strips() const { return strips_; }
  /// A regular grid of knots over all of them.
  [[nodiscard]] const Knots& knots() const { return *knots_; }
  /// Other knots over the same strips.
  [[nodiscard]] Knots knots_at(std::vector<PathPlace> places) const;
  /// With a kernel of another width.
  [[nodiscard]] Knots knots_at(std::vector<PathPlace> places, const KernelWidth& width) const;

  /// Places of a point of the map frame in all the lanes whose tube holds it.
  void places_of(const Eigen::Vector2d& p, std::vector<PathPlace>& places) const;
  /// Strip that holds a place of the property map.
  [[nodiscard]] const Strip& strip_of(const PathPlace& place) const;
  /// The strip of a lane; null where it has none.
  [[nodiscard]] const Strip* find(std::uint64_t lane) const;

 private:
  std::vector<Strip> strips_;
  std::vector<KnotRing> rings_;
  KernelWidth width_;
  std::optional<Knots> knots_;
};

}  // namespace roadbook
