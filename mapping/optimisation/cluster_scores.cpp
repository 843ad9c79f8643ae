#include "mapping/optimisation/cluster_scores.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

namespace roadbook {

PointTerms point_terms(const BundleProblem& problem,
                       const BundleLayout& layout,
                       const BundleOptions& options,
                       const BundleState& state,
                       std::size_t point) {
  PointTerms result;
  if (layout.point_free[point] == 0) return result;
  Eigen::Matrix3d V = Eigen::Matrix3d::Zero();
  for (std::size_t t = layout.term_begin[point]; t < layout.term_begin[point + 1]; ++t) {
    const BundleTerm& term = layout.terms[t];
    const TermResidual e =
        term_residual(problem, term, state.poses[at(term.pose)], state.points[point], true);
    const double root = std::sqrt(robust_cost(e.r.squaredNorm(), options).weight);
    result.terms.push_back({layout.variable[at(term.pose)], term.pose, term.camera,
                            term.observation, root * term.inv_sigma, root * e.J_pose,
                            root * e.J_point, root * e.r});
    const Matrix23d& J = result.terms.back().J_point;
    V.noalias() += J.transpose() * J;
  }
  Eigen::FullPivLU<Eigen::Matrix3d> lu(V);
  lu.setThreshold(1e-14);
  if (lu.isInvertible()) result.V_inverse = lu.inverse();
  return result;
}

// trace(J_r Z J_r^T) over the degrees of freedom that the point leaves, with J_r the derivative by
// the poses after the point is eliminated, and Z the covariance of the poses.
double leverage_of(const PointTerms& point, BundleSystem& system) {
  struct Link {
    Matrix6d U = Matrix6d::Zero();
    Eigen::Matrix<double, 6, 3> W = Eigen::Matrix<double, 6, 3>::Zero();
  };
  std::map<int, Link> links;
  for (const PointTerms::Term& t : point.terms) {
    if (t.variable < 0) continue;
    Link& link = links[t.variable];
    link.U.noalias() += t.J_pose.transpose() * t.J_pose;
    link.W.noalias() += t.J_pose.transpose() * t.J_point;
  }
  double trace = 0.0;
  for (auto one = links.begin(); one != links.end(); ++one) {
    const Eigen::Matrix<double, 6, 3> Y = one->second.W * point.V_inverse;
    for (auto other = one; other != links.end(); ++other) {
      const Matrix6d Z = system.shared_covariance(one->first, other->first);
      const double shared = (Z * other->second.W).cwiseProduct(Y).sum();  // tr(Y W^T Z^T)
      trace -= (other == one ? 1.0 : 2.0) * shared;
      if (other == one) trace += one->second.U.cwiseProduct(Z).sum();
    }
  }
  const double freedom = 2.0 * static_cast<double>(point.terms.size()) - 3.0;
  return freedom > 0.0 ? std::clamp(trace / freedom, 0.0, 1.0) : 1.0;
}

BlockCholesky::Panel after_landmark(const PointTerms& point,
                                    const BlockCholesky::Panel& residuals) {
  const auto rows = [](std::size_t t) { return static_cast<Eigen::Index>(2 * t); };
  BlockCholesky::Panel moved = BlockCholesky::Panel::Zero(3, residuals.cols());
  for (std::size_t t = 0; t < point.terms.size(); ++t)
    moved += point.terms[t].J_point.transpose().lazyProduct(residuals.middleRows<2>(rows(t)));
  moved = point.V_inverse.lazyProduct(moved).eval();
  BlockCholesky::Panel left = residuals;
  for (std::size_t t = 0; t < point.terms.size(); ++t)
    left.middleRows<2>(rows(t)) -= point.terms[t].J_point.lazyProduct(moved);
  return left;
}

void add_scores(const PointTerms& point,
                const BlockCholesky::Panel& residuals,
                BlockCholesky::Panel& poses) {
  for (std::size_t t = 0; t < point.terms.size(); ++t) {
    const PointTerms::Term& term = point.terms[t];
    if (term.variable < 0) continue;
    poses.middleRows<6>(row_of(at(term.variable))) += term.J_pose.transpose().lazyProduct(
        residuals.middleRows<2>(static_cast<Eigen::Index>(2 * t)));
  }
}

}  // namespace roadbook
