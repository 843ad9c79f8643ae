#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/index.hpp"
#include "mapping/optimisation/block_cholesky.hpp"
#include "mapping/optimisation/bundle_adjustment_terms.hpp"

namespace roadbook {

/// A change of the state: right perturbations of the free poses, and of points and scales.
struct BundleStep {
  Eigen::VectorXd poses;  ///< six for each free pose
  std::vector<Eigen::Vector3d> points;
  Eigen::VectorXd scales;
  double model_decrease = 0.0;  ///< decrease of the cost that the linearised problem predicts
};

/// The state moved by a step.
[[nodiscard]] BundleState moved(const BundleState& state,
                                const BundleLayout& layout,
                                const BundleStep& step);

/// First row of a free pose in the system.
inline Eigen::Index row_of(std::size_t variable) { return index(6 * variable); }

// Normal equations of bundle adjustment. With U of the poses, V of the points and W between them,
//   S = U - W V^-1 W^T,   S dx_c = b_c - W V^-1 b_p,   dx_p = V^-1 (b_p - W^T dx_c),
// where b is minus the gradient. The free scales border S; they are solved for last.
//
// Every sum runs in an order given by the problem alone: each thread owns whole points, then whole
// columns of S.
class BundleSystem {
 public:
  BundleSystem(const BundleProblem& problem,
               const BundleLayout& layout,
               const BundleOptions& options);

  void linearise(const BundleState& state);
  /// Frees what only `linearise` needs. It must not be called again.
  void forget_jacobians() {
    J_pose_ = {};
    r_ = {};
  }
  /// Solves (H + lambda * diag(H)) dx = b; false if the matrix is not positive definite.
  bool solve(double lambda, BundleStep& step);
  /// Solves the same system for other right-hand sides, in place, with the factor (and the lambda)
  /// of the last `solve`. Each column is one right-hand side: `poses` has six rows for each free
  /// pose, `points` three rows for each point. Free scales are held fixed.
  void solve_columns(BlockCholesky::Panel& poses, BlockCholesky::Panel& points) const;
  /// The same for right-hand sides of poses and free scales from which the points are already
  /// eliminated; free scales move. `scales` has a row for each free scale.
  void solve_reduced(BlockCholesky::Panel& poses, BlockCholesky::Panel& scales) const;
  /// Largest absolute entry of the gradient.
  [[nodiscard]] double gradient_norm() const;

  /// Marginal covariances of the free poses and of the scales. Call solve(0, ...) first; its factor
  /// is overwritten.
  [[nodiscard]] std::vector<Matrix6d> pose_covariances(Eigen::MatrixXd& scale_covariance);
  /// Block of the covariance between free poses `a` and `b` that see a common point. Call
  /// pose_covariances first.
  [[nodiscard]] Matrix6d shared_covariance(int a, int b);
  /// Information of a point given the poses.
  [[nodiscard]] const Eigen::Matrix3d& point_information(std::size_t point) const {
    return V_[point];
  }

 private:
  using Matrix63d = Eigen::Matrix<double, 6, 3>;
  void linearise_points(const BundleState& state);
  void linearise_poses();
  void linearise_motions(const BundleState& state);
  void eliminate_points(double lambda);
  void assemble(double lambda);
  void assemble_column(std::size_t v, double lambda, std::vector<Matrix6d*>& place);
  bool solve_bordered(double lambda, BundleStep& step);
  void back_substitute(double lambda, BundleStep& step) const;

  const BundleProblem& problem_;
  const BundleLayout& layout_;
  const BundleOptions& options_;
  BlockCholesky S_;
  std::vector<int> scale_column_;  ///< of each scale; -1: fixed
  Eigen::Index scale_count_ = 0;

  // At the linearisation point.
  std::vector<Matrix26d> J_pose_;  ///< of each term, times the root of its robust weight
  std::vector<Eigen::Vector2d> r_;
  std::vector<Matrix63d> W_;        ///< of each link
  std::vector<Eigen::Matrix3d> V_;  ///< of each point
  std::vector<Eigen::Vector3d> b_p_;
  std::vector<Matrix6d> U_;  ///< diagonal blocks
  struct OffDiagonal {
    int a, b;
    Matrix6d value;
  };
  std::vector<OffDiagonal> U_off_;  ///< of motions
  Eigen::VectorXd b_c_;
  Eigen::MatrixXd border_;  ///< poses x scales
  Eigen::MatrixXd scale_H_;
  Eigen::VectorXd b_s_;

  // For one lambda: V + damping = L L^T.
  std::vector<Eigen::Matrix3d> L_inv_;  ///< L^-1 of each point
  Eigen::MatrixXd X_;                   ///< S^-1 border
  Eigen::MatrixXd scale_inverse_;
};

}  // namespace roadbook
