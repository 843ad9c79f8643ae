#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "roadnet/paths/lane_path.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "speedmap/property_map/knots.hpp"

namespace roadbook {

/// The layout of all lanes of a map in one property map, so that they share the classes. Lanes
/// follow each other along s, farther apart than the kernel reaches. A closed lane is a ring.
class LaneStrips {
 public:
  /// Lanes without a path are left out. Throws Refused if none is left.
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

  /// Path coordinates of a point (map frame [m]) in all lanes whose tube contains it.
  void places_of(const Eigen::Vector2d& p, std::vector<PathPlace>& places) const;
  /// The strip that contains a position of the property map.
  [[nodiscard]] const Strip& strip_of(const PathPlace& place) const;
  /// The strip of a lane; null if it has none.
  [[nodiscard]] const Strip* find(std::uint64_t lane) const;

 private:
  std::vector<Strip> strips_;
  std::vector<KnotRing> rings_;
  KernelWidth width_;
  std::optional<Knots> knots_;
};

}  // namespace roadbook
