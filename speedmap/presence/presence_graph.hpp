#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace roadbook {

// The graph of [metric-semantic maps, figure 5]: locations x_i of the map, each with its prior
// x_i0, smoothness edges between neighbours, and observations z.
//
// The energy is minus the logarithm of equations (1) to (3), with weights and units, every edge
// once:
//   E(x) = 1/2 sum_i w0_i (x_i - x_i0)^2 + 1/2 sum_(i,j) ws_ij (x_i - x_j)^2
//        + 1/2 sum_k wz_k (z_k - x_i(k))^2
// x is the probability that a person is met at the location during a visit. Weights are inverse
// variances. Both have no unit.

/// Class of a location, on which the prior of the paper depends.
enum class PlaceClass : std::uint8_t { kCrossing, kSpace, kLane, kOther };
constexpr std::size_t kPlaceClasses = 4;
[[nodiscard]] const char* to_text(PlaceClass place);

struct PresenceNode {
  double prior = 0.0;   ///< x_i0, 0 to 1
  double weight = 1.0;  ///< w0_i, above 0
};

struct PresenceEdge {
  int a = 0;
  int b = 0;
  double weight = 1.0;  ///< ws, 0 or more
};

/// An observation z at a node; several at one node add up.
struct PresenceObservation {
  int node = 0;
  double value = 0.0;   ///< 1: a person was there, 0: no person
  double weight = 1.0;  ///< wz, 0 or more
};

struct PresenceGraph {
  std::vector<PresenceNode> nodes;
  std::vector<PresenceEdge> edges;

  /// Throws InvalidOption if there are no nodes, a prior is outside 0 to 1, a weight is not finite
  /// or negative (or 0 for a prior), an edge joins a node with itself or with a missing node, or an
  /// edge occurs twice.
  void check() const;
};

}  // namespace roadbook
