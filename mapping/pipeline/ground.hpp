#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <vector>

#include "mapping/joined_tracks.hpp"
#include "vo/ground_scale.hpp"

namespace roadbook {

// The driven surface as reference for height and scale. A ground point has height 0 in the frame of
// the vehicle pose nearest to it. Near the vehicle an error of a camera's pitch hardly changes that
// height; an error of its mounting height does.

/// A point in the vehicle frame of the keyframe nearest to it.
struct GroundView {
  int keyframe = -1;                                    ///< -1: no pose is near enough
  Eigen::Vector3d p_vehicle = Eigen::Vector3d::Zero();  ///< [m]
};

struct GroundOptions {
  double ahead_m = 1.5;    ///< largest distance of a point before or behind the rear axle
  double beside_m = 1.6;   ///< largest distance to the side; farther out kerbs begin
  double height_m = 0.06;  ///< largest distance of a ground point from the ground level
  /// Largest difference of keyframes between a view of a point and the pose. Before loops are
  /// closed, poses of another pass have another height.
  int max_keyframe_distance = std::numeric_limits<int>::max();
};

/// For each of `tracks` the nearest pose of the same stretch of its drive (no gap between) from
/// which the point lies within the limits of `options`. Others get keyframe -1.
[[nodiscard]] std::vector<GroundView> view_from_above(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const std::vector<JoinedTrack>& tracks,
    const GroundOptions& options = {});

/// Height [m] at which most points near the driven line lie: 0 if the scale is right, else the
/// relative error of the scale times the cameras' height. 0 with too few points.
[[nodiscard]] double ground_level(const std::vector<GroundView>& views,
                                  const GroundOptions& options = {});

/// True if the point of `view` belongs to the ground at height `level_m`.
[[nodiscard]] bool on_ground(const GroundView& view,
                             double level_m,
                             const GroundOptions& options = {});

/// Scale of odometry around one keyframe.
struct LocalScale {
  int keyframe = 0;
  double log_scale = 0.0;  ///< of metres a unit
  double sigma = 0.0;      ///< standard deviation; slopes and kerbs included
};

struct ScaleProfile {
  std::vector<double> factor;  ///< on the motion from each keyframe to the next
  bool found = false;          ///< false: too few ground points
  /// Of each keyframe: relative standard deviation of the overall scale of its stretch, 0 if it is
  /// not known.
  std::vector<double> stretch_sigma;
  /// Estimates of all windows with enough ground, plausible or not; ascending keyframes.
  std::vector<LocalScale> local;
};

/// Largest standard deviation of the stretches among the keyframes [begin, end); empty if none is
/// known.
[[nodiscard]] std::optional<double> largest_sigma(const ScaleProfile& profile,
                                                  std::size_t begin,
                                                  std::size_t end);

/// Estimates the factors that scale odometry without wheels to metres, from the cameras' height
/// above ground in a window of `window` keyframes around each keyframe. A window with too few
/// ground points, or an implausible result, takes the factor of its stretch without a gap.
[[nodiscard]] ScaleProfile ground_scale_profile(const MappingInput& input,
                                                const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                                const std::vector<JoinedTrack>& tracks,
                                                int window = 25);

}  // namespace roadbook
