#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "mapping/optimisation/adjustment_problem.hpp"

namespace roadbook {

// The residuals of bundle adjustment, laid out for the solver: grouped by landmark, so that a
// landmark's part of the normal equations is one run through memory.

/// The unknowns of bundle adjustment.
struct BundleState {
  std::vector<Eigen::Isometry3d> poses;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> scales;
};
[[nodiscard]] BundleState state_of(const BundleProblem& problem);

/// One pixel, or (camera == kGround) the height of a ground point.
struct BundleTerm {
  static constexpr int kGround = -1;
  int pose = 0;
  int camera = 0;
  int link = -1;  ///< the (landmark, pose) pair it informs; -1: landmark or pose does not move
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of a ground point: (height, 0)
  double inv_sigma = 1.0;
  int observation = -1;  ///< of the problem; -1: a ground height
};

using Matrix26d = Eigen::Matrix<double, 2, 6>;

/// Whitened residual of a term; `valid` is false where the camera cannot see the point.
struct TermResidual {
  Eigen::Vector2d r = Eigen::Vector2d::Zero();
  Matrix26d J_pose = Matrix26d::Zero();
  Matrix23d J_point = Matrix23d::Zero();
  bool valid = false;
};

struct BundleLayout {
  /// `active[o]`: observation o takes part. Observations of points with `point_active` false do
  /// not.
  BundleLayout(const BundleProblem& problem,
               const BundleOptions& options,
               const std::vector<std::uint8_t>& active,
               const std::vector<std::uint8_t>& point_active);

  std::vector<int> variable;  ///< of each pose; -1: fixed
  std::vector<int> pose_of;   ///< of each variable
  std::vector<std::uint8_t> point_free;
  std::vector<std::size_t> term_begin;  ///< of each point's terms; one more at the end
  std::vector<BundleTerm> terms;
  std::vector<std::size_t> link_begin;  ///< of each point's links; one more at the end
  std::vector<int> link_variable;       ///< pose variable of each link
  std::vector<int> link_point;
  /// (term, point) of every term with a free pose, pose by pose.
  std::vector<std::size_t> pose_term_begin;
  std::vector<std::size_t> pose_terms;
  /// Links of every pose variable, in ascending order of points.
  std::vector<std::size_t> pose_link_begin;
  std::vector<std::size_t> pose_links;

 private:
  void add_terms(const BundleProblem& problem,
                 const BundleOptions& options,
                 const std::vector<std::uint8_t>& active,
                 const std::vector<std::uint8_t>& point_active);
  void add_links();
  void add_pose_lists();
};

[[nodiscard]] TermResidual term_residual(const BundleProblem& problem,
                                         const BundleTerm& term,
                                         const Eigen::Isometry3d& T_map_vehicle,
                                         const Eigen::Vector3d& p_map,
                                         bool with_jacobians);

/// Robust cost rho(s) of a squared residual and its derivative, the weight.
struct RobustCost {
  double rho;
  double weight;
};
[[nodiscard]] RobustCost robust_cost(double squared, const BundleOptions& options);
/// The same for a motion: Huber's, of its own width.
[[nodiscard]] RobustCost motion_cost(double squared, const BundleOptions& options);

/// Half the sum of all robust squared residuals, motions and priors included. A pixel that cannot
/// be predicted costs as much as one ten loss widths off, so that hiding a point gains nothing.
[[nodiscard]] double bundle_cost(const BundleProblem& problem,
                                 const BundleLayout& layout,
                                 const BundleState& state,
                                 const BundleOptions& options);
[[nodiscard]] double invalid_cost(const BundleOptions& options);

}  // namespace roadbook
