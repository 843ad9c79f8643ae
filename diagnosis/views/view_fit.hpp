#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnosis/views/view_prediction.hpp"
#include "diagnosis/views/view_system.hpp"

namespace roadbook {

// Nominal fit of the problem of views: poses and landmarks by bundle adjustment; noise, and which
// views are outliers, with every named effect free, or either would swallow the causes.

/// A named cause as a sum of elementary columns.
struct ViewCause {
  std::string name;  ///< empty: a hinge, whose size stands in ViewPoint::linear
  std::string unit;
  double tau = 1.0;
  std::vector<std::size_t> columns;  ///< elementary; their sizes are equal
};
/// "camN.X" of every camera, then "cam.X", wheels and ground, as far as the data have rows for
/// them.
[[nodiscard]] std::vector<ViewCause> view_causes(const ViewData& data, const ViewBasis& basis);

struct ViewFit {
  ViewData data;  ///< outliers taken out
  ViewNoise noise;
  ViewPoint point;
  std::vector<std::size_t>
      views;  ///< of each camera, outliers included; landmarks that most of their views agree on
  std::vector<std::size_t> outliers;  ///< of each camera
  bool usable = false;
  std::string message;  ///< why not
};

/// Fits all views with the effects `known`. Where `hinges`, counts lines in `basis` in which the
/// ground may bend; they stand in the fit's point. The same for any number of threads.
[[nodiscard]] ViewFit fit_views(ViewData all,
                                ViewBasis& basis,
                                const EffectSizes& known,
                                bool hinges = true,
                                int num_threads = 1);

/// What a Gauss-Newton step of poses, landmarks and the sizes of `sums` did.
struct ViewStep {
  Eigen::VectorXd size;         ///< change of each sum's size
  Eigen::MatrixXd information;  ///< of the sizes
  double here = 0.0;            ///< of the residual where the step begins
  double squares = 0.0;         ///< of the residual once the step is taken, as far as all is linear
};
/// Information and score that other data add at the sizes as they are.
struct ViewPull {
  Eigen::MatrixXd information;
  Eigen::VectorXd score;
};
[[nodiscard]] ViewStep view_step(ViewSystem& system,
                                 ViewPoint& point,
                                 const ViewNoise& noise,
                                 const Eigen::MatrixXd& sums,
                                 const ViewPull& elsewhere = {});

/// A step goes too far where squares rise by more than this: at rest they do by a part of a
/// million, as what effects take off readings is that of landmarks before they settle.
inline constexpr double kNoRise = 1.0 + 1e-5;

/// Two such steps of poses and landmarks alone, landmarks settled after each; where they go too far
/// (what a large cause leaves is not linear) bundle adjustment from where they began.
void settle(ViewSystem& system, const ViewNoise& noise, ViewPoint& point);

}  // namespace roadbook
