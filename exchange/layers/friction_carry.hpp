#pragma once

#include <optional>

#include "exchange/layers/friction_layers.hpp"
#include "mapping/session_track.hpp"

namespace roadbook {

/// A knot as a map file stores it.
struct StoredKnot {
  std::uint64_t lane = 0;
  double s_share = 0.0;  ///< of its lane's length
  double e_m = 0.0;
  KnotAnchor anchor;
  std::vector<double> belief;
  double evidence = 0.0;
};

/// Finds the positions of stored knots on the current paths. Keeps references to its arguments.
class KnotCarrier {
 public:
  KnotCarrier(const Map& map, const LaneStrips& strips, double reach_m);

  /// Position in the property map; empty if the ground is on no path. Ground within `reach_m` of a
  /// tube or end still counts, because knots there influence the inside.
  [[nodiscard]] std::optional<PathPlace> place_of(const StoredKnot& knot) const;

 private:
  [[nodiscard]] std::optional<Eigen::Vector2d> ground_of(const KnotAnchor& anchor) const;
  [[nodiscard]] std::optional<PathPlace> on_strip(std::size_t strip,
                                                  const Eigen::Vector2d& p) const;

  const LaneStrips& strips_;
  double reach_m_;
  std::vector<std::pair<std::string, SessionTrack>> tracks_;
  std::vector<PathFrame> wide_;  ///< by strip: its tube and `reach_m` more
};

}  // namespace roadbook
