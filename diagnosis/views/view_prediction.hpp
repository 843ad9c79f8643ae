#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/views/view_basis.hpp"
#include "diagnosis/views/view_data.hpp"
#include "diagnosis/views/view_timing.hpp"
#include "mapping/optimisation/bundle_adjustment_terms.hpp"
#include "sensors/effects.hpp"
#include "sensors/wheel_imperfections.hpp"

namespace roadbook {

// Predicted views, motions and ground heights with effects, and their derivatives by each effect.
// Bundle adjustment handles poses and landmarks; the effects are subtracted from the readings
// before.

/// Poses, landmarks and effects at which the problem is linearised.
struct ViewPoint {
  BundleState state;
  EffectSizes effects;            ///< sizes of catalogued effects
  Eigen::VectorXd linear;         ///< sizes of elementary columns (generic effects, hinges)
  std::vector<HingeLine> hinges;  ///< lines of the hinges
};

/// Standard deviations of the channels.
struct ViewNoise {
  std::vector<double> pixel;  ///< of each camera [px]
  /// Factors on the stated standard deviations of the wheels' motions (x, y, z, roll, pitch, yaw).
  std::array<double, 6> motion{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  double ground_m = 0.02;
};

/// The nominal cameras changed by the given effects.
[[nodiscard]] std::vector<MountedCamera> real_cameras(const std::vector<MountedCamera>& nominal,
                                                      const EffectSizes& effects);
/// Cameras at the current effects, and one small step of each camera-changing effect to either
/// side, for central differences.
struct SteppedCameras {
  /// In the order and the units of the columns from kFirstGeometryColumn on.
  static constexpr std::array<double, kGeometryColumns> kSteps{1e-4, 1e-4, 0.05, 0.05, 0.05, 1e-4,
                                                               1e-4, 1e-4, 1e-4, 1e-4, 1e-3, 1e-3,
                                                               1e-3, 1e-4, 1e-4, 1e-4};
  explicit SteppedCameras(std::vector<MountedCamera> real);
  std::vector<MountedCamera> now;
  std::vector<std::array<MountedCamera, kGeometryColumns>> more;
  std::vector<std::array<MountedCamera, kGeometryColumns>> less;
};
/// Wheels at the current effects, and one small step of each effect to either side.
struct SteppedWheels {
  explicit SteppedWheels(const EffectSizes& effects);
  WheelImperfections<double> now;
  std::array<WheelImperfections<double>, kWheelColumns.size()> more;
  std::array<WheelImperfections<double>, kWheelColumns.size()> less;
};
/// Predictions and derivatives of the readings of one drive.
class ViewPrediction {
 public:
  /// Both arguments must outlive this object.
  ViewPrediction(const ViewData& data, const ViewBasis& basis);

  /// Writes the problem corrected for the effects of `point`: cameras replaced, and the changes by
  /// effects subtracted from the readings. The order of all elements is that of `data.bundle`.
  void apply(const ViewPoint& point, BundleProblem& problem, int num_threads) const;

  /// Derivatives of an observation's pixel by the elementary columns of its camera's strip: row 0
  /// for x, row 1 for y [px]. `term`: its residual at the point, not whitened.
  using Strip = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>;
  /// `needed`: one flag a column of the strip; columns with 0 are skipped. Empty: all columns.
  void view_columns(const ViewPoint& point,
                    const SteppedCameras& cameras,
                    const ViewTiming& timing,
                    std::span<const std::uint8_t> needed,
                    const BundleObservation& observation,
                    const TermResidual& term,
                    Eigen::Ref<Strip> strip) const;
  /// Derivatives of a measured motion (right perturbation, 6 rows) by wheels, hinges and slope.
  using MotionStrip = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>;
  [[nodiscard]] MotionStrip motion_columns(const ViewPoint& point,
                                           const SteppedWheels& wheels,
                                           const MotionConstraint& motion) const;
  /// Derivatives of the height of a ground point above the wheels [m] by hinges and ground effects.
  [[nodiscard]] Eigen::VectorXd ground_columns(const ViewPoint& point,
                                               const BundlePoint& at,
                                               const Eigen::Vector3d& p_map) const;

 private:
  [[nodiscard]] Eigen::Vector2d timing_shift(const ViewPoint& point,
                                             const ViewTiming& timing,
                                             const MountedCamera& real,
                                             const BundleObservation& o) const;
  [[nodiscard]] Vector6d wheel_change(const ViewPoint& point,
                                      const MotionConstraint& motion,
                                      const WheelImperfections<double>& off,
                                      double wheels_late_s) const;
  [[nodiscard]] Vector6d hinge_change(const ViewPoint& point,
                                      const MotionConstraint& motion,
                                      const HingeLine& line) const;
  void apply_views(const ViewPoint& point, BundleProblem& problem, int num_threads) const;

  const ViewData& data_;
  const ViewBasis& basis_;
  ViewFrame frame_;
};

}  // namespace roadbook
