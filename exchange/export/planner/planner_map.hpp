#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exchange/layers/speed_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "roadnet/routing/lane_layout.hpp"
#include "speedmap/speeds/speed_pieces.hpp"

namespace roadbook {

// The content of a map for planners' formats: lanes and turns with their speed limits, parking
// spaces and crossings with the lanes they belong to.

/// The lane position from which a vehicle enters a parking space.
struct SpaceLink {
  std::uint64_t lane = 0;   ///< id
  int piece = -1;           ///< index in `LaneLayout::pieces`
  double s_m = 0.0;         ///< on the curve of that piece, nearest to the middle of the open side
  bool left = false;        ///< the space lies to the left of the piece's curve
  double distance_m = 0.0;  ///< from the curve to the middle of the open side
};

/// A parking space in the map frame.
struct PlannerSpace {
  std::string id;
  /// Ring without repetition [m]; of a rectangle the two corners of the open side come first.
  std::vector<Eigen::Vector3d> corners;
  bool rectangle = false;
  std::optional<SpaceLink> link{};
  std::string no_link{};  ///< why there is no link; empty where there is one
};

/// A pedestrian crossing in the map frame.
struct PlannerCrossing {
  std::string id;
  std::vector<Eigen::Vector3d> corners;  ///< ring without repetition [m]
};

class PlannerMap {
 public:
  /// Throws BadInput if `roads` was not run on the map.
  explicit PlannerMap(const std::filesystem::path& map);

  [[nodiscard]] const StoredPaths& stored() const { return stored_; }
  [[nodiscard]] const LaneLayout& layout() const { return layout_; }
  [[nodiscard]] const std::vector<PlannerSpace>& spaces() const { return spaces_; }
  [[nodiscard]] const std::vector<PlannerCrossing>& crossings() const { return crossings_; }
  /// Number of labels of other classes, which no planner's format can represent.
  [[nodiscard]] std::size_t other_labels() const { return other_labels_; }
  /// Whether the map has a speed map. Otherwise speeds follow from bends and the default limit
  /// only.
  [[nodiscard]] bool speeds_known() const { return speeds_known_; }

  /// Whether the lane begins and ends at one point: a ring, or both ends at one intersection.
  /// Formats that allow no edge from a node to itself must cut it.
  [[nodiscard]] bool returns_to_its_start(int piece) const;

  /// Least speed [m/s] of a lane's profile between two places on its piece's curve.
  [[nodiscard]] double least_speed(int piece, double from_m, double to_m) const;
  /// Speed limits over a piece, from its `s_begin_m` to its `s_end_m`.
  [[nodiscard]] std::vector<SpeedPiece> lane_speeds(int piece,
                                                    const SpeedPieceOptions& options = {}) const;
  /// Speed limit [m/s] of a turn: the least of the limits by bend, people, grip and law along it,
  /// and of the profiles of the lane parts that it replaces.
  [[nodiscard]] double turn_speed(int connector) const;

 private:
  void set_profiles(const MapLayers& layers);
  void set_turn_speeds(const MapLayers& layers, const SpeedMap* speeds);
  void read_places(const MapLayers& layers);
  [[nodiscard]] std::optional<SpaceLink> link_of(const SpacePlace& space, std::string& why) const;
  [[nodiscard]] double cut_off_speed(const PieceEnd& end) const;

  StoredPaths stored_;
  LaneLayout layout_;
  LaneSpeedOptions options_;
  bool speeds_known_ = false;
  std::vector<LaneProfile> profiles_;  ///< one a piece, along the lane's path
  std::vector<double> turn_speeds_;    ///< one a connector
  std::vector<PlannerSpace> spaces_;
  std::vector<PlannerCrossing> crossings_;
  std::size_t other_labels_ = 0;
};

}  // namespace roadbook
