#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exchange/export/planner/lane_bounds.hpp"
#include "exchange/export/planner/planner_map.hpp"

namespace roadbook {

// Lanes and turns as lanelets (Lanelet2, CommonRoad): stretches between two bounds with one speed
// limit each, which follow each other where they share both end points.

/// A cross section where lanelets meet, and the way over it: two lanelets follow each other where
/// the one's `last` equals the other's `first`.
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
  double longest_m = 45.0;  ///< of the centre; Lanelet2 and Autoware want at most 50
};

struct LaneletNetwork {
  /// Lanes in the order of the layout's pieces, each from its begin to its end; then turns.
  std::vector<Lanelet> lanelets;
  int sections = 0;  ///< number of cross sections
};

/// Lanelets of a map: lanes cut where their speed limit changes and at `longest_m`, rings and lanes
/// that return to their start at least once. The first lanelet of a lane has the lane's id, all
/// others have ids that follow from the lanes' (53 bits, unique).
[[nodiscard]] LaneletNetwork lanelets_of(const PlannerMap& map, const LaneletOptions& options = {});

/// The id of a lanelet driven against its direction.
[[nodiscard]] std::uint64_t id_of_way_back(const Lanelet& lanelet);
/// That lanelet: bounds and ends exchanged.
[[nodiscard]] Lanelet reversed(const Lanelet& lanelet);

/// Where a lanelet leads: its heading at the end against that at its begin; less than 30 degrees
/// is straight on.
enum class TurnDirection : std::uint8_t { kRight, kStraight, kLeft };
[[nodiscard]] TurnDirection turn_direction(const Lanelet& lanelet);

/// An id of 53 bits that follows from two others.
[[nodiscard]] std::uint64_t derived_id(std::uint64_t a, std::uint64_t b);

/// An id of 53 bits that follows from a label's: the same in every export.
enum class LabelKind : std::uint64_t { kSpace = 0x5FACE, kCrossing = 0xC5055 };
[[nodiscard]] std::uint64_t id_of_label(const std::string& label, LabelKind kind);

}  // namespace roadbook
