#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace roadbook {

// The graph of [metric-semantic maps, figure 5]: places x_i of the map, each with its prior x_i0,
// smoothness edges between neighbours, and observations z.
//
// Minus the logarithm of (1) to (3), with weights and units, every edge once:
//   E(x) = 1/2 sum_i w0_i (x_i - x_i0)^2 + 1/2 sum_(i,j) ws_ij (x_i - x_j)^2
//        + 1/2 sum_k wz_k (z_k - x_i(k))^2
// x is the probability that somebody is met at the place during a visit: no unit. Weights are
// inverse variances: no unit either.

/// What kind of place a node is: the document's prior goes by it.
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

/// z at a node; several at one node add up.
struct PresenceObservation {
  int node = 0;
  double value = 0.0;   ///< 1: a person was there, 0: no person
  double weight = 1.0;  ///< wz, 0 or more
};

struct PresenceGraph {
  std::vector<PresenceNode> nodes;
  std::vector<PresenceEdge> edges;

  /// Throws InvalidOption: no nodes, a prior outside 0 to 1, weights that are not finite, negative
  /// or (of a prior) 0, an edge of a node with itself or one that is not there, an edge twice.
  void check() const;
};

}  // namespace roadbook
