#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "mapping/cameras/camera_errors.hpp"
#include "mapping/cameras/camera_tracks.hpp"
#include "sensors/rig.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {

// Solves for the point of one track while camera and poses are held, and takes the point's share
// out of the residuals and of the columns of the calibration parameters (variable projection).

inline constexpr std::size_t kMostTrackViews = 8;

/// A track with its point solved for.
struct SolvedTrack {
  int count = 0;                                          ///< views
  std::array<Eigen::Vector2d, kMostTrackViews> residual;  ///< predicted - measured [px, half size]
  std::array<Eigen::Matrix<double, 2, 10>, kMostTrackViews> columns;  ///< d residual / d errors
  double rms_px = 0.0;                                                ///< per degree of freedom
};

/// Keeps references: camera, motion and errors must outlive it.
class TrackSolver {
 public:
  TrackSolver(const MountedCamera& mounted,
              const KeyframeMotion& motion,
              const CameraErrors& errors);

  /// `point` [m, map]: where the search starts, empty for a first search; then the point found.
  /// Empty if a view cannot see the point.
  [[nodiscard]] std::optional<SolvedTrack> solve(const CameraTrack& track,
                                                 std::optional<Eigen::Vector3d>& point);

 private:
  [[nodiscard]] std::optional<Eigen::Vector3d> bearing(const CameraView& view) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> first_point(const CameraTrack& track, std::size_t n);
  bool evaluate(const CameraTrack& track,
                std::size_t n,
                const Eigen::Vector3d& p_map,
                SolvedTrack& out);
  [[nodiscard]] Eigen::Vector3d step() const;
  void eliminate(SolvedTrack& track) const;

  const MountedCamera& mounted_;
  const KeyframeMotion& motion_;
  const CameraErrors& errors_;
  Eigen::Matrix3d R_camera_vehicle_;  ///< the errors taken away
  Eigen::Vector3d p_vehicle_camera_;
  Eigen::Vector2d centre_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<Ray> rays_;
  std::array<Matrix23d, kMostTrackViews> points_;
  Eigen::Matrix3d A_;
  Eigen::Vector3d b_;
};

}  // namespace roadbook
