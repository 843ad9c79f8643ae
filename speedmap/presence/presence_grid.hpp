#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "speedmap/presence/presence_graph.hpp"

namespace roadbook {

// The map locations of [metric-semantic maps, section V-C], as square cells: lanes, the ground next
// to them, and labelled spaces and crossings. Each cell has a class and the prior of this class.

/// Prior of a class of place before any detection. The source gives no numbers.
struct PlacePrior {
  double presence = 0.05;  ///< probability that a person is met there during a visit
  /// Standard deviation of that for a square metre. 0.5 is the largest that a probability can have,
  /// and makes the prior worth one visit.
  double sigma = 0.5;
};

struct PresenceOptions {
  double cell_m = 0.5;
  double beside_m = 6.0;  ///< ground within this distance of a lane's centre line has cells
  /// By PlaceClass: crossing, space, lane, other.
  std::array<PlacePrior, kPlaceClasses> priors{{{0.30}, {0.08}, {0.03}, {0.05}}};
  /// Range of the correlation between places: the effect of presence at one place on another place
  /// fades like exp(-d / reach).
  double reach_m = 0.75;
  /// Standard deviation of one visit's observation of a square metre that was in sight for long.
  double visit_sigma = 0.5;
  /// As printed in the source: all weights 1, every edge twice, and no observation of empty places.
  bool literal = false;

  /// Throws InvalidOption.
  void check() const;
};

/// A lane for the grid: its centre line and how wide the lane is.
struct GridLane {
  std::vector<Eigen::Vector2d> centre;  ///< [m], points at most a few metres apart
  double width_m = 3.0;
};

using Outline = std::vector<Eigen::Vector2d>;  ///< corners of a polygon [m], in order

struct PresenceValue {
  double presence = 0.0;
  double variance = 0.0;
};

/// Cells of the map and the graph over them. Immutable.
class PresenceGrid {
 public:
  /// Where areas overlap, the cell gets the class of the crossing, else of the space, else of the
  /// lane. Positions in the map frame [m]. Throws InvalidOption, also for no cells or more than
  /// 2^27.
  PresenceGrid(const std::vector<GridLane>& lanes,
               const std::vector<Outline>& spaces,
               const std::vector<Outline>& crossings,
               const PresenceOptions& options);

  [[nodiscard]] std::size_t size() const { return centres_.size(); }
  [[nodiscard]] const std::vector<Eigen::Vector2d>& centres() const { return centres_; }
  [[nodiscard]] PlaceClass place_class(std::size_t node) const { return classes_[node]; }
  [[nodiscard]] const PresenceOptions& options() const { return options_; }

  /// The graph over the cells. Weights are proportional to a cell's area, so that the result does
  /// not depend on `cell_m`.
  [[nodiscard]] PresenceGraph graph() const;
  /// The node of the cell that contains the point; empty if no cell does.
  [[nodiscard]] std::optional<int> node_at(const Eigen::Vector2d& p) const;
  /// Nodes whose centres lie within `radius_m` of the point, ascending; written to `nodes`.
  void nodes_near(const Eigen::Vector2d& p, double radius_m, std::vector<int>& nodes) const;
  /// The lattice of the cells: `node` of a column and row, counted from the corner `low` [m]; -1 if
  /// there is no cell.
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] const Eigen::Vector2d& low() const { return low_; }
  [[nodiscard]] int node(int column, int row) const;

 private:
  void span(const std::vector<GridLane>& lanes, const std::vector<Outline>& outlines);
  void paint_lane(const GridLane& lane, std::vector<signed char>& classes) const;
  void paint_outline(const Outline& outline,
                     PlaceClass place,
                     std::vector<signed char>& classes) const;
  void collect(const std::vector<signed char>& classes);

  PresenceOptions options_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  int columns_ = 0;
  int rows_ = 0;
  std::vector<int> node_of_;  ///< columns x rows
  std::vector<Eigen::Vector2d> centres_;
  std::vector<PlaceClass> classes_;
};

}  // namespace roadbook
