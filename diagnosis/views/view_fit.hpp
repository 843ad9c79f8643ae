#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnosis/views/view_prediction.hpp"
#include "diagnosis/views/view_system.hpp"

namespace roadbook {

// Nominal fit of the problem of views. Bundle adjustment gives poses and landmarks. Noise and
// outliers are estimated with all catalogued effects free, so that they do not absorb the traces of
// effects.

/// A catalogued effect, or a hinge, as a sum of elementary columns.
struct ViewCause {
  std::string name;  ///< empty for a hinge, whose size is in ViewPoint::linear
  std::string unit;
  double tau = 1.0;
  std::vector<std::size_t> columns;  ///< elementary columns; all share one size
};
/// All effects for which the data have rows: "camN.X" of every camera, then "cam.X", "rig.X",
/// wheels and ground.
[[nodiscard]] std::vector<ViewCause> view_causes(const ViewData& data, const ViewBasis& basis);

struct ViewFit {
  ViewData data;  ///< without outliers
  ViewNoise noise;
  ViewPoint point;
  std::vector<std::size_t> views;     ///< a camera; outliers included
  std::vector<std::size_t> outliers;  ///< of each camera
  bool usable = false;
  std::string message;  ///< why the fit is unusable
};

/// Fits all views with the effects `known` in the model. If `hinges`, searches for lines along
/// which the ground may be bent, sets their number in `basis` and stores them in the point of the
/// fit. `num_threads`: 0 for all cores; the result does not depend on it.
[[nodiscard]] ViewFit fit_views(ViewData all,
                                ViewBasis& basis,
                                const EffectSizes& known,
                                bool hinges = true,
                                int num_threads = 1);

/// Result of a Gauss-Newton step of poses, landmarks and the sizes of `sums`.
struct ViewStep {
  Eigen::VectorXd size;         ///< change of the size of each sum
  Eigen::MatrixXd information;  ///< information matrix of the sizes
  double here = 0.0;            ///< squared residual before the step
  double squares = 0.0;         ///< squared residual after the step, predicted linearly
};
/// Information matrix and score that other data add at the current sizes.
struct ViewPrior {
  Eigen::MatrixXd information;
  Eigen::VectorXd score;
};
[[nodiscard]] ViewStep view_step(ViewSystem& system,
                                 ViewPoint& point,
                                 const ViewNoise& noise,
                                 const Eigen::MatrixXd& sums,
                                 const ViewPrior& elsewhere = {});

/// Relative growth of the squared residual above which a step counts as too long. Near the minimum
/// it grows by about 1e-6, because the corrections by effects are those at the landmarks before
/// they moved.
inline constexpr double kNoRise = 1.0 + 1e-5;

/// Two Gauss-Newton steps of poses and landmarks alone, with landmarks refined after each. If they
/// go too far (large effects make the problem nonlinear), bundle adjustment from the starting point
/// instead.
void settle(ViewSystem& system, const ViewNoise& noise, ViewPoint& point);

}  // namespace roadbook
