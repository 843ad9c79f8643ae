#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/se3.hpp"
#include "vo/feature_grid.hpp"
#include "vo/keyframe_spacing.hpp"
#include "vo/rig_pose.hpp"
#include "vo/two_view.hpp"
#include "vo/visual_odometry.hpp"
#include "vo/window/window_adjustment.hpp"

namespace roadbook {

// The state of visual odometry between frames. Private to vo/: the odometry_*.cpp files share it.

// Radii of the searches, in pixels of the half-size image.
constexpr double kFirstRadiusPx = 20.0;     // if only a constant velocity predicts the motion
constexpr double kPredictedRadiusPx = 6.0;  // if the wheels predict the motion
constexpr double kRefinedRadiusPx = 3.5;    // second search, with the pose of the first
constexpr int kWindowPoses = 14;            // newest keyframes that are adjusted without wheels
constexpr std::size_t kFewestPairs = 30;    // matched corners that a first motion needs

[[nodiscard]] std::vector<FeatureGrid> make_grids(const std::vector<Features>& features,
                                                  const Rig& rig);

struct VisualOdometry::State {
  struct Matches {
    std::vector<std::vector<int>> tracks;    // per camera: indices of the tracks searched for
    std::vector<std::vector<int>> features;  // per camera and track: index of its feature, or -1
  };

  Rig rig;
  VoOptions options;
  VoResult result;
  double tolerance_rad = 0.0;  // the inlier threshold as an angle
  // Per camera: tracks that may continue in the next frame.
  std::vector<std::vector<int>> active;
  std::size_t newest_tracks = 0;  // first of those begun in the last keyframe
  // Constant-velocity prediction where there are no wheels.
  Vector6d velocity = Vector6d::Zero();  // per second
  std::int64_t velocity_t_ns = 0;
  std::optional<VoFrame> reference;  // first view, while no motion is known
  bool has_motion = false;
  // Without wheels: the newest frame short of the next keyframe's position. It waits for the first
  // frame beyond that position; the nearer of the two becomes the keyframe.
  struct HeldFrame {
    VoFrame frame;
    Matches matches;
    VoKeyframe keyframe;
    double distance_m = 0.0;
    double turn_rad = 0.0;
  };
  KeyframeSpacing spacing;  // without wheels it carries no distance over, as the scale is uncertain
  std::optional<HeldFrame> held;

  State(Rig half_rig, const VoOptions& vo_options);

  const VoKeyframe& last() const { return result.keyframes.back(); }
  VoKeyframe& last() { return result.keyframes.back(); }
  const VoKeyframe& keyframe_at(int k) const {
    return result.keyframes[static_cast<std::size_t>(k)];
  }

  Eigen::Vector3d bearing_of(int camera, const TrackObservation& o) const;

  // Search for the corners of tracks in a new frame (odometry_search.cpp).
  enum class Searched { kKnownPlaces, kAll };  // only triangulated tracks, or all
  Matches search(const VoFrame& frame,
                 const std::vector<FeatureGrid>& grids,
                 const Eigen::Isometry3d& T_odom_new,
                 double radius_px,
                 Searched searched) const;
  std::vector<RigObservation> known_points(const VoFrame& frame, const Matches& matches) const;
  std::vector<BearingPair> pairs_with(const VoFrame& frame, double& median_flow_px) const;

  // The motion of a frame (odometry_motion.cpp).
  Eigen::Isometry3d predict(const VoFrame& frame) const;
  std::optional<RigPose> estimate(const VoFrame& frame,
                                  const std::vector<FeatureGrid>& grids,
                                  Matches& matches) const;
  std::optional<RigPose> estimate_without_places(const VoFrame& frame,
                                                 const std::vector<FeatureGrid>& grids,
                                                 Matches& matches) const;

  // The first motion without wheels (odometry_start.cpp).
  std::optional<Eigen::Isometry3d> first_motion(const std::vector<BearingPair>& pairs,
                                                double dt) const;
  VoOutcome start_segment(VoFrame&& frame, bool after_gap);
  void drop_lone_start();

  // Tracks of corners from keyframe to keyframe (odometry_tracks.cpp).
  void accept(VoFrame&& frame, const Matches& matches, VoKeyframe&& keyframe);
  bool consistent(int track,
                  int camera,
                  const Eigen::Vector2f& pixel,
                  const Eigen::Isometry3d& T_odom_new) const;
  bool has_new_size(int track, const Eigen::Isometry3d& T_odom_new) const;
  void triangulate_tracks(const VoKeyframe& keyframe);
  void forget_lone_tracks();
  // Known places of features that begin a new track, by camera and feature.
  using KnownPlaces = std::map<std::pair<std::size_t, std::size_t>, Eigen::Vector3d>;
  void start_tracks(VoKeyframe& keyframe, std::size_t index, const KnownPlaces& places);

  // Adjustment of the newest keyframes without wheels (odometry_window.cpp).
  VoWindow newest_window(std::vector<int>& tracks) const;
  void follow_ground(VoWindow& window);
  void adjust_newest();

  // One frame (visual_odometry.cpp).
  VoOutcome add_waiting(VoFrame&& frame);
  VoOutcome add_tracking(VoFrame&& frame, bool is_first_motion);
  bool is_held_nearer(double distance_m, double turn_rad) const;
  void accept_held();
};

}  // namespace roadbook
