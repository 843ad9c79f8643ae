#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exchange/export/planner/lane_bounds.hpp"
#include "exchange/export/planner/planner_map.hpp"

namespace roadbook {

// Lanes and turns as lanelets (Lanelet2, CommonRoad): stretches between two bounds, each with one
// speed limit. Lanelets that share both end points follow each other.

/// A cross section where lanelets meet, with a direction: two lanelets follow each other if `last`
/// of the first equals `first` of the second.
struct LaneletEnd {
  int section = -1;
  bool turned = false;  ///< driven against the lane that the section belongs to
  friend bool operator==(const LaneletEnd&, const LaneletEnd&) = default;
  [[nodiscard]] LaneletEnd reversed() const { return {section, !turned}; }
};

struct Lanelet {
  std::uint64_t id = 0;
  int piece = -1;      ///< index in the layout; -1: a turn
  int connector = -1;  ///< index in the layout; -1: part of a lane
  LaneBounds bounds;   ///< in driving direction
  LaneletEnd first;
  LaneletEnd last;
  bool both_ways = false;
  double speed = 0.0;  ///< [m/s] limit
};

struct LaneletOptions {
  double longest_m = 45.0;  ///< of the centre; Lanelet2 and Autoware allow at most 50
};

struct LaneletNetwork {
  /// Lanes in the order of the layout's pieces, each from its begin to its end; then turns.
  std::vector<Lanelet> lanelets;
  int sections = 0;  ///< number of cross sections
};

/// Makes the lanelets of a map. Lanes are cut where their speed limit changes and at `longest_m`;
/// rings and lanes that return to their start are cut at least once. The first lanelet of a lane
/// has the lane's id; all others have unique ids of 53 bits derived from the lanes'.
[[nodiscard]] LaneletNetwork lanelets_of(const PlannerMap& map, const LaneletOptions& options = {});

/// The id of a lanelet driven against its direction.
[[nodiscard]] std::uint64_t id_of_way_back(const Lanelet& lanelet);
/// The lanelet in the opposite direction, with bounds and ends exchanged.
[[nodiscard]] Lanelet reversed(const Lanelet& lanelet);

/// Direction of a lanelet: its heading at the end relative to that at its begin. Less than 30
/// degrees is straight.
enum class TurnDirection : std::uint8_t { kRight, kStraight, kLeft };
[[nodiscard]] TurnDirection turn_direction(const Lanelet& lanelet);

/// An id of 53 bits derived from two others.
[[nodiscard]] std::uint64_t derived_id(std::uint64_t a, std::uint64_t b);

/// An id of 53 bits derived from the id of a label; the same in every export.
enum class LabelKind : std::uint64_t { kSpace = 0x5FACE, kCrossing = 0xC5055 };
[[nodiscard]] std::uint64_t id_of_label(const std::string& label, LabelKind kind);

}  // namespace roadbook
