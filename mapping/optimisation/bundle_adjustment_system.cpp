#include "mapping/optimisation/bundle_adjustment_system.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "mapping/optimisation/block_products.hpp"

namespace roadbook {
namespace {

// Pairs of pose variables that see a common point or share a motion.
std::vector<std::pair<int, int>> coupled_poses(const BundleProblem& problem,
                                               const BundleLayout& layout) {
  std::vector<std::pair<int, int>> pairs;
  std::vector<int> seen_by(layout.pose_of.size(), -1);
  for (std::size_t v = 0; v < layout.pose_of.size(); ++v) {
    for (std::size_t k = layout.pose_link_begin[v]; k < layout.pose_link_begin[v + 1]; ++k) {
      const std::size_t p = at(layout.link_point[layout.pose_links[k]]);
      for (std::size_t l = layout.link_begin[p]; l < layout.link_begin[p + 1]; ++l) {
        const int other = layout.link_variable[l];
        if (at(other) <= v || seen_by[at(other)] == static_cast<int>(v)) continue;
        seen_by[at(other)] = static_cast<int>(v);
        pairs.emplace_back(static_cast<int>(v), other);
      }
    }
  }
  for (const MotionConstraint& m : problem.motions) {
    const int a = layout.variable[at(m.from)];
    const int b = layout.variable[at(m.to)];
    if (a >= 0 && b >= 0 && a != b) pairs.emplace_back(a, b);
  }
  return pairs;
}

double damping(double lambda, double diagonal) { return lambda * std::max(diagonal, 1e-9); }

}  // namespace

BundleState moved(const BundleState& state, const BundleLayout& layout, const BundleStep& step) {
  BundleState next = state;
  for (std::size_t v = 0; v < layout.pose_of.size(); ++v) {
    Eigen::Isometry3d& T = next.poses[at(layout.pose_of[v])];
    T = T * se3_exp(step.poses.segment<6>(row_of(v)));
    // Rounding drifts away from a rotation over many steps; the quaternion takes that off.
    T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  }
  for (std::size_t p = 0; p < next.points.size(); ++p) next.points[p] += step.points[p];
  for (std::size_t s = 0; s < next.scales.size(); ++s)
    next.scales[s] += step.scales[static_cast<Eigen::Index>(s)];
  return next;
}

BundleSystem::BundleSystem(const BundleProblem& problem,
                           const BundleLayout& layout,
                           const BundleOptions& options)
    : problem_(problem),
      layout_(layout),
      options_(options),
      S_(layout.pose_of.size(), coupled_poses(problem, layout)),
      J_pose_(layout.terms.size()),
      r_(layout.terms.size()),
      W_(layout.link_variable.size()),
      V_(problem.points.size()),
      b_p_(problem.points.size()),
      U_(layout.pose_of.size()),
      L_inv_(problem.points.size()) {
  for (const ScaleParameter& scale : problem.scales)
    scale_column_.push_back(scale.fixed ? -1 : static_cast<int>(scale_count_++));
}

void BundleSystem::linearise(const BundleState& state) {
  linearise_points(state);
  linearise_poses();
  linearise_motions(state);
}

void BundleSystem::linearise_points(const BundleState& state) {
  parallel_for_small(problem_.points.size(), options_.num_threads, [&](std::size_t p) {
    V_[p].setZero();
    b_p_[p].setZero();
    for (std::size_t l = layout_.link_begin[p]; l < layout_.link_begin[p + 1]; ++l) W_[l].setZero();
    for (std::size_t t = layout_.term_begin[p]; t < layout_.term_begin[p + 1]; ++t) {
      const BundleTerm& term = layout_.terms[t];
      TermResidual e =
          term_residual(problem_, term, state.poses[at(term.pose)], state.points[p], true);
      const double root = std::sqrt(robust_cost(e.r.squaredNorm(), options_).weight);
      r_[t] = root * e.r;
      J_pose_[t] = root * e.J_pose;
      e.J_point *= root;
      V_[p].noalias() += e.J_point.transpose() * e.J_point;
      b_p_[p].noalias() -= e.J_point.transpose() * r_[t];
      if (term.link >= 0) W_[at(term.link)].noalias() += J_pose_[t].transpose() * e.J_point;
    }
  });
}

void BundleSystem::linearise_poses() {
  b_c_.resize(row_of(U_.size()));
  parallel_for(U_.size(), options_.num_threads, [&](std::size_t v) {
    Matrix6d U = Matrix6d::Zero();
    Vector6d b = Vector6d::Zero();
    for (std::size_t k = layout_.pose_term_begin[v]; k < layout_.pose_term_begin[v + 1]; ++k) {
      const std::size_t t = layout_.pose_terms[k];
      U.noalias() += J_pose_[t].transpose() * J_pose_[t];
      b.noalias() -= J_pose_[t].transpose() * r_[t];
    }
    U_[v] = U;
    b_c_.segment<6>(row_of(v)) = b;
  });
}

void BundleSystem::eliminate_points(double lambda) {
  parallel_for_small(problem_.points.size(), options_.num_threads, [&](std::size_t p) {
    L_inv_[p].setZero();
    if (layout_.point_free[p] == 0) return;
    Eigen::Matrix3d damped = V_[p];
    for (int i = 0; i < 3; ++i) damped(i, i) += damping(lambda, V_[p](i, i));
    const Eigen::LLT<Eigen::Matrix3d> llt(damped);
    // A point that its observations do not determine stays where it is (L^-1 = 0).
    if (llt.info() == Eigen::Success) L_inv_[p] = llt.matrixL().solve(Eigen::Matrix3d::Identity());
  });
}

void BundleSystem::assemble_column(std::size_t v, double lambda, std::vector<Matrix6d*>& place) {
  const int position = S_.position(static_cast<int>(v));
  const BlockCholesky::Column column = S_.column(position);
  for (std::size_t k = 0; k < column.count; ++k) {
    column.blocks[k].setZero();
    place[at(column.rows[k])] = column.blocks + k;
  }
  Matrix6d& diagonal = column.blocks[0];
  diagonal = U_[v];
  for (int i = 0; i < 6; ++i) diagonal(i, i) += damping(lambda, U_[v](i, i));
  for (std::size_t k = layout_.pose_link_begin[v]; k < layout_.pose_link_begin[v + 1]; ++k) {
    const std::size_t link = layout_.pose_links[k];
    const std::size_t p = at(layout_.link_point[link]);
    const Matrix63d W_V_inverse = (W_[link] * L_inv_[p].transpose()) * L_inv_[p];
    for (std::size_t l = layout_.link_begin[p]; l < layout_.link_begin[p + 1]; ++l) {
      const int row = S_.position(layout_.link_variable[l]);
      if (row >= position)
        subtract_outer_63(W_[l].data(), W_V_inverse.data(), place[at(row)]->data());
    }
  }
}

void BundleSystem::assemble(double lambda) {
  const std::size_t n = U_.size();
  constexpr std::size_t kColumns = 8;
  parallel_for((n + kColumns - 1) / kColumns, options_.num_threads, [&](std::size_t chunk) {
    thread_local std::vector<Matrix6d*> place;
    place.resize(std::max(place.size(), n));
    for (std::size_t v = chunk * kColumns; v < std::min(n, (chunk + 1) * kColumns); ++v)
      assemble_column(v, lambda, place);
  });
  for (const OffDiagonal& off : U_off_) S_.add(off.a, off.b, off.value);
}

bool BundleSystem::solve_bordered(double lambda, BundleStep& step) {
  X_.resize(b_c_.size(), scale_count_);
  for (Eigen::Index s = 0; s < scale_count_; ++s) {
    Eigen::VectorXd x = border_.col(s);
    S_.solve(x);
    X_.col(s) = x;
  }
  Eigen::MatrixXd damped = scale_H_;
  for (Eigen::Index s = 0; s < scale_count_; ++s) damped(s, s) += damping(lambda, scale_H_(s, s));
  damped -= border_.transpose() * X_;
  const Eigen::LLT<Eigen::MatrixXd> llt(damped);
  if (scale_count_ > 0 && llt.info() != Eigen::Success) return false;
  scale_inverse_ = llt.solve(Eigen::MatrixXd::Identity(scale_count_, scale_count_));
  const Eigen::VectorXd d = scale_inverse_ * (b_s_ - border_.transpose() * step.poses);
  step.poses -= X_ * d;
  step.scales = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(scale_column_.size()));
  for (std::size_t i = 0; i < scale_column_.size(); ++i)
    if (scale_column_[i] >= 0) step.scales(static_cast<Eigen::Index>(i)) = d(scale_column_[i]);
  return true;
}

bool BundleSystem::solve(double lambda, BundleStep& step) {
  eliminate_points(lambda);
  assemble(lambda);
  if (!S_.factor(options_.num_threads)) return false;
  step.poses = b_c_;
  parallel_for(U_.size(), options_.num_threads, [&](std::size_t v) {
    Vector6d b = step.poses.segment<6>(row_of(v));
    for (std::size_t k = layout_.pose_link_begin[v]; k < layout_.pose_link_begin[v + 1]; ++k) {
      const std::size_t link = layout_.pose_links[k];
      const std::size_t p = at(layout_.link_point[link]);
      b.noalias() -= W_[link] * (L_inv_[p].transpose() * (L_inv_[p] * b_p_[p]));
    }
    step.poses.segment<6>(row_of(v)) = b;
  });
  S_.solve(step.poses);
  if (!solve_bordered(lambda, step)) return false;
  back_substitute(lambda, step);
  return step.poses.allFinite() && std::isfinite(step.model_decrease);
}

// The decrease that the linear model promises: (dx . b + lambda dx . D dx) / 2.
void BundleSystem::back_substitute(double lambda, BundleStep& step) const {
  step.points.resize(problem_.points.size());
  std::vector<double> gain(problem_.points.size(), 0.0);
  parallel_for_small(problem_.points.size(), options_.num_threads, [&](std::size_t p) {
    Eigen::Vector3d reduced = b_p_[p];
    for (std::size_t l = layout_.link_begin[p]; l < layout_.link_begin[p + 1]; ++l)
      reduced.noalias() -=
          W_[l].transpose() * step.poses.segment<6>(row_of(at(layout_.link_variable[l])));
    const Eigen::Vector3d d = L_inv_[p].transpose() * (L_inv_[p] * reduced);
    step.points[p] = d;
    gain[p] = d.dot(b_p_[p]);
    for (int i = 0; i < 3; ++i) gain[p] += damping(lambda, V_[p](i, i)) * d(i) * d(i);
  });
  double sum = step.poses.dot(b_c_);
  for (std::size_t v = 0; v < U_.size(); ++v)
    for (int i = 0; i < 6; ++i) {
      const double d = step.poses(row_of(v) + i);
      sum += damping(lambda, U_[v](i, i)) * d * d;
    }
  for (const double g : gain) sum += g;
  for (std::size_t i = 0; i < scale_column_.size(); ++i) {
    if (scale_column_[i] < 0) continue;
    const double d = step.scales(static_cast<Eigen::Index>(i));
    const int s = scale_column_[i];
    sum += d * b_s_(s) + damping(lambda, scale_H_(s, s)) * d * d;
  }
  step.model_decrease = 0.5 * sum;
}

double BundleSystem::gradient_norm() const {
  double largest = b_c_.size() > 0 ? b_c_.cwiseAbs().maxCoeff() : 0.0;
  for (const Eigen::Vector3d& b : b_p_) largest = std::max(largest, b.cwiseAbs().maxCoeff());
  return largest;
}

std::vector<Matrix6d> BundleSystem::pose_covariances(Eigen::MatrixXd& scale_covariance) {
  std::vector<Matrix6d> covariances = S_.inverse_diagonal(options_.num_threads);
  scale_covariance = scale_inverse_;
  // Inverse of the bordered matrix: S^-1 + X C X^T with C the covariance of the scales.
  for (std::size_t v = 0; v < covariances.size(); ++v) {
    const auto X = X_.middleRows<6>(row_of(v));
    covariances[v] += X * scale_inverse_ * X.transpose();
  }
  return covariances;
}

}  // namespace roadbook
