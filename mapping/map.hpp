#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/se3.hpp"
#include "mapping/known_covariance.hpp"
#include "sensors/rig.hpp"
#include "sensors/vehicle.hpp"
#include "sensors/wheels.hpp"
#include "vo/descriptor.hpp"

namespace roadbook {

// The metric map [metric-semantic maps, section IV-A]: landmarks in map frames that never move,
// vehicle poses that do, and the sessions they come from.
//
// Ids are indices into the vectors below, except where said.

enum class ScaleSource { kWheels, kCameraHeight, kFree };

/// One drive in the map.
struct Session {
  std::string name;        ///< of the drive's folder
  std::string drive_path;  ///< relative to the map file's folder where possible
  std::string drive_digest;
  Rig rig;  ///< full-resolution cameras as calibrated
  std::optional<WheelModel> wheels;
  VehicleMeasures vehicle;  ///< that carried the sensors; empty where nobody described it
  VehicleSource vehicle_source = VehicleSource::kNone;
  double wheel_scale = 1.0;  ///< estimated factor on the wheels' distance
  double wheel_scale_sigma = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown
  ScaleSource scale_source = ScaleSource::kFree;
  double scale_sigma = std::numeric_limits<double>::quiet_NaN();  ///< relative; NaN: unknown
  std::int64_t t_begin_ns = 0;
  std::int64_t t_end_ns = 0;
  /// Of its keyframes, localised in the map that it extended; NaN: mapped without a map before it.
  double localised_share = std::numeric_limits<double>::quiet_NaN();
};

/// A frame fixed in space for ever, one at each base-map pose as first estimated.
struct MapFrame {
  Eigen::Isometry3d T_map_frame = Eigen::Isometry3d::Identity();
};

/// A vehicle pose with images. Keyed by (session, t_ns).
struct Keyframe {
  int session = 0;
  std::int64_t t_ns = 0;
  int drive_frame = 0;  ///< index in the drive
  int map_frame = 0;
  Eigen::Isometry3d T_frame_vehicle = Eigen::Isometry3d::Identity();  ///< in its map frame
  /// Of the right perturbation, relative to the first keyframe of its piece; NaN: unknown.
  Matrix6d covariance = unknown_covariance<Matrix6d>();
  double travelled_m = 0.0;  ///< since the session's start, along the map's poses; gaps add nothing
  bool reversing = false;
  bool after_gap = false;  ///< the motion from the previous keyframe is not known from odometry
  int piece = 0;           ///< poses of different pieces have no common place: nothing joins them
  /// Motion from the session's keyframe before by the wheels; empty: not known.
  std::optional<PlanarMotion> wheels;
};

struct Landmark {
  int map_frame = 0;
  Eigen::Vector3d p_frame = Eigen::Vector3d::Zero();  ///< in its map frame
  /// Given the poses; NaN: unknown.
  Eigen::Matrix3d covariance = unknown_covariance<Eigen::Matrix3d>();
  Descriptor descriptor{};
  bool ground = false;  ///< lies on the driven surface
};

struct Observation {
  int landmark = 0;
  int keyframe = 0;
  int camera = 0;
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< full-resolution image
  float sigma_px = 1.0F;                            ///< full-resolution
};

/// A corner that no landmark explains yet; a later session may.
struct LoneCorner {
  int keyframe = 0;
  int camera = 0;
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  ///< full-resolution image
  Descriptor descriptor{};
};

/// What a session that came after a landmark saw of it.
struct LandmarkSession {
  int landmark = 0;
  int session = 0;
  int expected = 0;                     ///< localised keyframes in whose images it lay
  int seen = 0;                         ///< of them, keyframes that saw it
  std::optional<std::int64_t> last_ns;  ///< when it was seen for the last time
};

/// A verified or refused revisit.
struct LoopEdge {
  int from = 0;
  int to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();
  int inliers = 0;
  bool accepted = false;
  double weight = 0.0;  ///< of the robust solver, 0..1
  std::string reason;   ///< why kept or dropped
};

struct Map {
  std::vector<Session> sessions;
  std::vector<MapFrame> map_frames;
  std::vector<Keyframe> keyframes;  ///< session by session, ascending in time
  std::vector<Landmark> landmarks;
  std::vector<Observation> observations;
  std::vector<LoopEdge> loops;
  std::vector<LoneCorner> corners;                 ///< ascending in keyframe and camera
  std::vector<LandmarkSession> landmark_sessions;  ///< ascending in landmark, then session

  [[nodiscard]] Eigen::Isometry3d T_map_vehicle(int keyframe) const {
    const Keyframe& k = keyframes[static_cast<std::size_t>(keyframe)];
    return map_frames[static_cast<std::size_t>(k.map_frame)].T_map_frame * k.T_frame_vehicle;
  }
  [[nodiscard]] Eigen::Vector3d p_map(const Landmark& landmark) const {
    return map_frames[static_cast<std::size_t>(landmark.map_frame)].T_map_frame * landmark.p_frame;
  }
};

}  // namespace roadbook
