#include "base/index.hpp"
#include "mapping/optimisation/bundle_adjustment_system.hpp"

namespace roadbook {

// What is known of poses beside the points: motions with their scales, and priors.
void BundleSystem::linearise_motions(const BundleState& state) {
  U_off_.clear();
  border_ = Eigen::MatrixXd::Zero(b_c_.size(), scale_count_);
  scale_H_ = Eigen::MatrixXd::Zero(scale_count_, scale_count_);
  b_s_ = Eigen::VectorXd::Zero(scale_count_);
  const auto add_pose = [&](int v, const Matrix6d& J, const Matrix6d& JtO, const Vector6d& r) {
    if (v < 0) return;
    U_[at(v)].noalias() += JtO * J;
    b_c_.segment<6>(row_of(at(v))).noalias() -= JtO * r;
  };
  for (const MotionConstraint& m : problem_.motions) {
    const double scale = m.scale < 0 ? 1.0 : state.scales[at(m.scale)];
    const MotionResidual e =
        motion_residual(state.poses[at(m.from)], state.poses[at(m.to)], m.T_from_to, scale);
    const double weight = motion_cost(e.r.dot(m.information * e.r), options_).weight;
    const Matrix6d information = weight * m.information;
    const Matrix6d A = e.J_from.transpose() * information;
    const Matrix6d B = e.J_to.transpose() * information;
    const int a = layout_.variable[at(m.from)];
    const int b = layout_.variable[at(m.to)];
    add_pose(a, e.J_from, A, e.r);
    add_pose(b, e.J_to, B, e.r);
    if (a >= 0 && b >= 0) U_off_.push_back({a, b, A * e.J_to});
    const int s = m.scale < 0 ? -1 : scale_column_[at(m.scale)];
    if (s < 0) continue;
    if (a >= 0) border_.col(s).segment<6>(row_of(at(a))) += A * e.J_scale;
    if (b >= 0) border_.col(s).segment<6>(row_of(at(b))) += B * e.J_scale;
    scale_H_(s, s) += e.J_scale.dot(information * e.J_scale);
    b_s_(s) -= e.J_scale.dot(information * e.r);
  }
  for (const PosePrior& prior : problem_.priors) {
    const MotionResidual e = motion_residual(Eigen::Isometry3d::Identity(),
                                             state.poses[at(prior.pose)], prior.T_map_vehicle, 1.0);
    add_pose(layout_.variable[at(prior.pose)], e.J_to, e.J_to.transpose() * prior.information, e.r);
  }
  for (std::size_t i = 0; i < scale_column_.size(); ++i) {
    const int s = scale_column_[i];
    if (s < 0) continue;
    const double information =
        1.0 / (problem_.scales[i].prior_sigma * problem_.scales[i].prior_sigma);
    scale_H_(s, s) += information;
    b_s_(s) -= information * (state.scales[i] - problem_.scales[i].prior);
  }
}

}  // namespace roadbook
