#include "mapping/optimisation/bundle_adjustment_terms.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

// Counting sort: begin of each group, and the item's numbers group by group in ascending order.
void group_by(const std::vector<int>& keys,
              std::size_t groups,
              std::vector<std::size_t>& begin,
              std::vector<std::size_t>& items) {
  begin.assign(groups + 1, 0);
  for (const int key : keys)
    if (key >= 0) ++begin[at(key) + 1];
  for (std::size_t g = 0; g < groups; ++g) begin[g + 1] += begin[g];
  items.resize(begin[groups]);
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i] >= 0) items[next[at(keys[i])]++] = i;
}

}  // namespace

BundleState state_of(const BundleProblem& problem) {
  BundleState state;
  state.poses.reserve(problem.poses.size());
  state.points.reserve(problem.points.size());
  for (const BundlePose& pose : problem.poses) state.poses.push_back(pose.T_map_vehicle);
  for (const BundlePoint& point : problem.points) state.points.push_back(point.p_map);
  for (const ScaleParameter& scale : problem.scales) state.scales.push_back(scale.value);
  return state;
}

BundleLayout::BundleLayout(const BundleProblem& problem,
                           const BundleOptions& options,
                           const std::vector<std::uint8_t>& active,
                           const std::vector<std::uint8_t>& point_active) {
  const bool held =
      !problem.priors.empty() || std::any_of(problem.poses.begin(), problem.poses.end(),
                                             [](const auto& pose) { return pose.fixed; });
  for (std::size_t i = 0; i < problem.poses.size(); ++i) {
    const bool fixed = problem.poses[i].fixed || (i == 0 && !held && options.fix_first_pose);
    variable.push_back(fixed ? -1 : static_cast<int>(pose_of.size()));
    if (!fixed) pose_of.push_back(static_cast<int>(i));
  }
  add_terms(problem, options, active, point_active);
  add_links();
  add_pose_lists();
}

void BundleLayout::add_terms(const BundleProblem& problem,
                             const BundleOptions& options,
                             const std::vector<std::uint8_t>& active,
                             const std::vector<std::uint8_t>& point_active) {
  std::vector<int> key(problem.observations.size(), -1);
  for (std::size_t o = 0; o < key.size(); ++o) {
    const int point = problem.observations[o].point;
    if (active[o] != 0 && point_active[at(point)] != 0) key[o] = point;
  }
  std::vector<std::size_t> begin;
  std::vector<std::size_t> order;
  group_by(key, problem.points.size(), begin, order);
  point_free.resize(problem.points.size());
  terms.reserve(order.size() + problem.points.size());
  term_begin.push_back(0);
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    const BundlePoint& point = problem.points[p];
    point_free[p] = !point.fixed && begin[p + 1] > begin[p];
    for (std::size_t k = begin[p]; k < begin[p + 1]; ++k) {
      const BundleObservation& o = problem.observations[order[k]];
      terms.push_back(
          {o.pose, o.camera, -1, o.pixel, 1.0 / o.sigma_px, static_cast<int>(order[k])});
    }
    if (point_free[p] != 0 && point.ground && point.ground_pose >= 0) {
      terms.push_back({point.ground_pose, BundleTerm::kGround, -1,
                       Eigen::Vector2d(point.ground_height_m, 0.0), 1.0 / options.ground_sigma_m});
    }
    term_begin.push_back(terms.size());
  }
}

void BundleLayout::add_links() {
  link_begin.push_back(0);
  for (std::size_t p = 0; p + 1 < term_begin.size(); ++p) {
    for (std::size_t t = term_begin[p]; t < term_begin[p + 1]; ++t) {
      const int v = variable[at(terms[t].pose)];
      if (v < 0 || point_free[p] == 0) continue;
      const auto first = link_variable.begin() + static_cast<std::ptrdiff_t>(link_begin[p]);
      const auto found = std::find(first, link_variable.end(), v);
      terms[t].link = static_cast<int>(found - link_variable.begin());
      if (found != link_variable.end()) continue;
      link_variable.push_back(v);
      link_point.push_back(static_cast<int>(p));
    }
    link_begin.push_back(link_variable.size());
  }
}

void BundleLayout::add_pose_lists() {
  std::vector<int> term_variable;
  term_variable.reserve(terms.size());
  for (const BundleTerm& term : terms) term_variable.push_back(variable[at(term.pose)]);
  group_by(term_variable, pose_of.size(), pose_term_begin, pose_terms);
  group_by(link_variable, pose_of.size(), pose_link_begin, pose_links);
}

TermResidual term_residual(const BundleProblem& problem,
                           const BundleTerm& term,
                           const Eigen::Isometry3d& T_map_vehicle,
                           const Eigen::Vector3d& p_map,
                           bool with_jacobians) {
  TermResidual result;
  const Eigen::Matrix3d Rt = T_map_vehicle.linear().transpose();
  const Eigen::Vector3d q = Rt * (p_map - T_map_vehicle.translation());  // in the vehicle frame
  // d q / d xi = (-I, [q]x), d q / d p_map = R^T.
  if (term.camera == BundleTerm::kGround) {
    result.valid = true;
    result.r.x() = (q.z() - term.pixel.x()) * term.inv_sigma;
    if (!with_jacobians) return result;
    result.J_pose.row(0) << 0.0, 0.0, -term.inv_sigma, -q.y() * term.inv_sigma,
        q.x() * term.inv_sigma, 0.0;
    result.J_point.row(0) = term.inv_sigma * Rt.row(2);
    return result;
  }
  const MountedCamera& mounted = problem.cameras[at(term.camera)];
  const Eigen::Matrix3d R_cv = mounted.T_vehicle_camera.linear().transpose();
  const Eigen::Vector3d p_camera = R_cv * (q - mounted.T_vehicle_camera.translation());
  Matrix23d J_camera;
  const auto pixel = with_jacobians ? mounted.camera.project(p_camera, &J_camera)
                                    : mounted.camera.project(p_camera);
  if (!pixel || !pixel->allFinite()) return result;
  result.valid = true;
  result.r = term.inv_sigma * (*pixel - term.pixel);
  if (!with_jacobians) return result;
  const Matrix23d J_q = term.inv_sigma * J_camera * R_cv;
  result.J_pose.leftCols<3>() = -J_q;
  result.J_pose.rightCols<3>() = J_q * skew<double>(q);
  result.J_point = J_q * Rt;
  return result;
}

RobustCost robust_cost(double squared, const BundleOptions& options) {
  const double b = options.loss_width * options.loss_width;
  switch (options.loss) {
    case RobustLoss::kHuber:
      if (squared > b) {
        const double root = std::sqrt(squared);
        return {2.0 * options.loss_width * root - b, options.loss_width / root};
      }
      break;
    case RobustLoss::kCauchy:
      return {b * std::log1p(squared / b), 1.0 / (1.0 + squared / b)};
    case RobustLoss::kNone:
      break;
  }
  return {squared, 1.0};
}

RobustCost motion_cost(double squared, const BundleOptions& options) {
  const double width = options.motion_loss_width;
  if (options.loss == RobustLoss::kNone || squared <= width * width) return {squared, 1.0};
  const double root = std::sqrt(squared);
  return {2.0 * width * root - width * width, width / root};
}

double invalid_cost(const BundleOptions& options) {
  return robust_cost(100.0 * options.loss_width * options.loss_width, options).rho;
}

double bundle_cost(const BundleProblem& problem,
                   const BundleLayout& layout,
                   const BundleState& state,
                   const BundleOptions& options) {
  constexpr std::size_t kChunk = 512;  // points; sums of chunks are added in order
  const std::size_t points = state.points.size();
  std::vector<double> partial((points + kChunk - 1) / kChunk, 0.0);
  const double invalid = invalid_cost(options);
  parallel_for(partial.size(), options.num_threads, [&](std::size_t chunk) {
    double sum = 0.0;
    for (std::size_t p = chunk * kChunk; p < std::min(points, (chunk + 1) * kChunk); ++p) {
      for (std::size_t t = layout.term_begin[p]; t < layout.term_begin[p + 1]; ++t) {
        const BundleTerm& term = layout.terms[t];
        const TermResidual r =
            term_residual(problem, term, state.poses[at(term.pose)], state.points[p], false);
        sum += r.valid ? robust_cost(r.r.squaredNorm(), options).rho : invalid;
      }
    }
    partial[chunk] = sum;
  });
  double cost = 0.0;
  for (const double sum : partial) cost += sum;
  for (const MotionConstraint& m : problem.motions) {
    const double scale = m.scale < 0 ? 1.0 : state.scales[at(m.scale)];
    const Vector6d r =
        motion_error(state.poses[at(m.from)], state.poses[at(m.to)], m.T_from_to, scale);
    cost += motion_cost(r.dot(m.information * r), options).rho;
  }
  for (const PosePrior& prior : problem.priors) {
    const Vector6d r = motion_error(Eigen::Isometry3d::Identity(), state.poses[at(prior.pose)],
                                    prior.T_map_vehicle, 1.0);
    cost += r.dot(prior.information * r);
  }
  for (std::size_t s = 0; s < problem.scales.size(); ++s) {
    if (problem.scales[s].fixed) continue;
    const double r = (state.scales[s] - problem.scales[s].prior) / problem.scales[s].prior_sigma;
    cost += r * r;
  }
  return 0.5 * cost;
}

}  // namespace roadbook
