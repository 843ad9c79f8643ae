#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/joined_tracks.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"
#include "mapping/optimisation/cluster_covariance.hpp"
#include "mapping/pipeline/landmark_covariance.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

// The stages of build_map after odometry, as functions without files.

/// Concatenates the odometry of several drives. The first keyframe of each further drive is marked
/// as following a gap.
[[nodiscard]] MappingInput join_drives(std::vector<VoResult> odometry,
                                       const std::vector<Rig>& rigs,
                                       const std::vector<bool>& has_wheels);

/// Says whether a motion of the session is known by the cameras alone.
[[nodiscard]] bool has_motion_without_wheels(const MappingInput& input, int session);

/// Scales the motions of a session that wheels do not know to metres, by the cameras' height above
/// ground. Changes poses, track positions and travelled distances. Returns the relative standard
/// deviation of the scale; empty if the ground was not seen.
std::optional<double> scale_by_ground(MappingInput& input, int session, const MapOptions& options);

/// Result of the pose graph.
struct Relaxed {
  std::vector<Eigen::Isometry3d> T_map_vehicle;  ///< of each keyframe
  std::vector<int> component;  ///< of each keyframe: connected by odometry and accepted loops
  int components = 1;
};

/// Relaxes the pose graph of odometry and accepted loops. Marks rejected loops in `loops`, with the
/// reason. Throws Refused if the solver finds no solution; Interrupted.
[[nodiscard]] Relaxed relax_poses(const MappingInput& input,
                                  std::vector<LoopClosure>& loops,
                                  const MapOptions& options,
                                  const Progress& progress);

/// Result of bundle adjustment.
struct Adjusted {
  std::vector<Eigen::Isometry3d> T_map_vehicle;  ///< of each keyframe
  std::vector<JoinedTrack> tracks;
  BundleStage stage;  ///< the adjusted problem
  BundleResult result;
  EqualRowsUsed rows;                       ///< used rows of MapOptions::equal_rows
  ClusterCovariance covariance;             ///< of the poses and of the wheels' factors
  LandmarkCovariances landmark_covariance;  ///< of `tracks`; empty before add_covariances
};

/// Further terms and knowledge of `adjust`.
struct AdjustTerms {
  std::vector<TrackMatch> same;  ///< tracks of one landmark
  std::vector<PosePrior> priors;
  std::vector<MotionConstraint> motions;
  /// Whether the images of two keyframes may show the same place; not set: all may.
  std::function<bool(int, int)> may_join;
  /// Called where the descriptors of `input` are needed or not: true before tracks are matched,
  /// false before a solution, which then has their memory. Not set: they stay.
  std::function<void(bool)> need_descriptors;
};

/// Finds landmarks again in other passes, joins and triangulates tracks, and adjusts poses and
/// points (two rounds). Throws Refused if bundle adjustment fails; Interrupted.
[[nodiscard]] Adjusted adjust(const MappingInput& input,
                              const std::vector<LoopClosure>& loops,
                              const Relaxed& relaxed,
                              const MapOptions& options,
                              const Progress& progress,
                              const AdjustTerms& terms = {});

/// Splits joined tracks whose views contradict each other (mapping/pipeline/track_agreement.hpp),
/// judged by the noise of key points that the last adjustment found.
void split_wrong_joins(const MappingInput& input,
                       const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                       double reprojection_median_px,
                       const MapOptions& options,
                       std::vector<JoinedTrack>& tracks);

/// The descriptor that is most like those of all views of a track.
[[nodiscard]] Descriptor descriptor_of(const MappingInput& input, const JoinedTrack& track);

/// Adds the covariances of poses, of the wheels' factors and of landmarks, if `options` want them.
/// `suspected`: errors of cameras that widen them.
void add_covariances(const MappingInput& input,
                     const Relaxed& relaxed,
                     const std::vector<CommonError>& suspected,
                     const MapOptions& options,
                     Adjusted& adjusted);

/// Makes struct Map from the results of all stages: map frames, keyframes, landmarks,
/// observations, loops. The caller adds the sessions.
[[nodiscard]] Map map_of_stages(const MappingInput& input,
                                const std::vector<LoopClosure>& loops,
                                const Adjusted& adjusted,
                                const MapOptions& options);

}  // namespace roadbook
