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

// Where views, motions and heights are predicted when effects are on, and the columns: their change
// by each. What a pose or a landmark does is left to bundle adjustment; effects are taken off the
// readings before it sees them.

/// State and causes at which the problem is linearised.
struct ViewPoint {
  BundleState state;
  EffectSizes effects;            ///< named ones
  Eigen::VectorXd linear;         ///< sizes of elementary columns beside them (grammar, hinges)
  std::vector<HingeLine> hinges;  ///< where the ground bends
};

/// Noise of the channels, standard deviations.
struct ViewNoise {
  std::vector<double> pixel;  ///< of each camera [px]
  /// Factors on the stated deviations of the wheels' motions (x, y, z, roll, pitch, yaw).
  std::array<double, 6> motion{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  double ground_m = 0.02;
};

/// The cameras as they are by the point's effects.
[[nodiscard]] std::vector<MountedCamera> real_cameras(const std::vector<MountedCamera>& nominal,
                                                      const EffectSizes& effects);
/// The same and cameras a small step of each effect that makes another camera away, for
/// differences.
struct SteppedCameras {
  static constexpr std::array<double, 5> kSteps{1e-4, 0.05, 1e-4, 1e-4, 1e-3};
  explicit SteppedCameras(std::vector<MountedCamera> real);
  std::vector<MountedCamera> now;
  std::vector<std::array<MountedCamera, 5>> more;
  std::vector<std::array<MountedCamera, 5>> less;
};
/// Wheels by the point's effects, and a small step of each away.
struct SteppedWheels {
  explicit SteppedWheels(const EffectSizes& effects);
  WheelImperfections<double> now;
  std::array<WheelImperfections<double>, kWheelColumns.size()> more;
  std::array<WheelImperfections<double>, kWheelColumns.size()> less;
};
/// Everything that predicts one drive's readings.
class ViewPrediction {
 public:
  /// All references are kept.
  ViewPrediction(const ViewData& data, const ViewBasis& basis);

  /// The problem with the point's effects: cameras replaced, and readings less what effects change
  /// of them. Same order of everything as in `data.bundle`.
  void apply(const ViewPoint& point, BundleProblem& problem, int num_threads) const;

  /// Change of an observation's pixel by the elementary columns of its camera's strip, without
  /// noise: row 0 is x, row 1 is y. `term` is its residual at the point, not whitened.
  using Strip = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>;
  /// Only where `needed` (of the strip) is not 0; all if it is empty.
  void view_columns(const ViewPoint& point,
                    const SteppedCameras& cameras,
                    const ViewTiming& timing,
                    std::span<const std::uint8_t> needed,
                    const BundleObservation& observation,
                    const TermResidual& term,
                    Eigen::Ref<Strip> strip) const;
  /// Change of a motion's measured right perturbation by wheels, hinges and the ground's slope.
  using MotionStrip = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>;
  [[nodiscard]] MotionStrip motion_columns(const ViewPoint& point,
                                           const SteppedWheels& wheels,
                                           const MotionConstraint& motion) const;
  /// Change of a ground point's height over the wheels [m] by hinges and ground effects.
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
