#include "mapping/optimisation/cluster_draws.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "mapping/optimisation/cluster_scores.hpp"

namespace roadbook {
namespace {

constexpr int kDraws = 64;  // one bit of a random word each
using Panel = BlockCholesky::Panel;
using Signs = Eigen::Matrix<double, 1, kDraws>;

Signs signs_of(std::uint64_t word) {
  Signs signs;
  for (int k = 0; k < kDraws; ++k) signs(k) = (word >> k & 1U) != 0 ? 1.0 : -1.0;
  return signs;
}

Random stream(const ClusterData& data, const char* name, std::uint64_t index, int chunk) {
  return {data.clusters.seed + 1000 * static_cast<std::uint64_t>(chunk), name, index};
}

// The words of all cameras, the ground and the wheels at the places of all poses.
class PlaceWords {
 public:
  PlaceWords(const ClusterData& data, int chunk)
      : sensors_(static_cast<int>(data.problem.cameras.size()) - kWheels) {
    for (std::size_t k = 0; k < data.state.poses.size(); ++k)
      for (int s = 0; s < sensors_; ++s)
        words_.push_back(
            stream(data, "place", place_of(data, static_cast<int>(k), s + kWheels), chunk)());
  }
  [[nodiscard]] Signs signs(int pose, int camera) const {
    return signs_of(words_[at(pose * sensors_ + camera - kWheels)]);
  }

 private:
  int sensors_;
  std::vector<std::uint64_t> words_;
};

void draw_points(const ClusterData& data, int chunk, const PlaceWords& places, Panel& poses) {
  const double noise = std::sqrt(data.chi2);
  for (std::size_t p = 0; p < data.problem.points.size(); ++p) {
    const PointTerms point = point_terms(data.problem, data.layout, data.options, data.state, p);
    if (point.terms.empty()) continue;
    Random random = stream(data, "landmark", p, chunk);
    const double grown = 1.0 / std::max(0.1, 1.0 - data.leverage[p]);
    const Signs track = grown * signs_of(random());
    Panel residuals(2 * static_cast<Eigen::Index>(point.terms.size()), kDraws);
    for (std::size_t t = 0; t < point.terms.size(); ++t) {
      const PointTerms::Term& term = point.terms[t];
      const Signs together = track + places.signs(term.pose, term.camera);
      for (int row = 0; row < 2; ++row) {
        auto out = residuals.row(2 * static_cast<Eigen::Index>(t) + row);
        out = term.r(row) * together;
        if (row == 0 || term.camera != BundleTerm::kGround) out += noise * signs_of(random());
      }
    }
    add_reduced_scores(point, residuals, poses);
  }
}

void draw_motions(
    const ClusterData& data, int chunk, const PlaceWords& places, Panel& poses, Panel& scales) {
  for (std::size_t i = 0; i < data.problem.motions.size(); ++i) {
    const MotionConstraint& motion = data.problem.motions[i];
    const MotionScore score = motion_score(data, motion);
    Random random = stream(data, "motion", i, chunk);
    Panel noise(6, kDraws);
    for (int row = 0; row < 6; ++row) noise.row(row) = signs_of(random());
    const Signs together = places.signs(motion.to, kWheels);
    const Panel sum = score.root.lazyProduct(noise) + score.score.lazyProduct(together);
    if (score.from >= 0) poses.middleRows<6>(row_of(at(score.from))) += sum.topRows<6>();
    if (score.to >= 0) poses.middleRows<6>(row_of(at(score.to))) += sum.middleRows<6>(6);
    if (score.scale >= 0) scales.row(score.scale) += sum.row(12);
  }
}

void draw_priors(const ClusterData& data, int chunk, Panel& poses, Panel& scales) {
  const std::vector<int> rows = free_scales(data.problem);
  for (std::size_t s = 0; s < rows.size(); ++s)
    if (rows[s] >= 0)
      scales.row(rows[s]) +=
          signs_of(stream(data, "scale", s, chunk)()) / data.problem.scales[s].prior_sigma;
  for (std::size_t i = 0; i < data.problem.priors.size(); ++i) {
    const PosePrior& prior = data.problem.priors[i];
    const int v = data.layout.variable[at(prior.pose)];
    if (v < 0) continue;
    Random random = stream(data, "prior", i, chunk);
    Panel noise(6, kDraws);
    for (int row = 0; row < 6; ++row) noise.row(row) = signs_of(random());
    const MotionResidual e = motion_residual(
        Eigen::Isometry3d::Identity(), data.state.poses[at(prior.pose)], prior.T_map_vehicle, 1.0);
    const Matrix6d U = prior.information.llt().matrixU();
    poses.middleRows<6>(row_of(at(v))) += (e.J_to.transpose() * U.transpose()).lazyProduct(noise);
  }
}

}  // namespace

std::uint64_t place_of(const ClusterData& data, int pose, int camera) {
  const Eigen::Isometry3d& T = data.state.poses[at(pose)];
  const auto cell = [&](double x) {
    return static_cast<std::uint64_t>(
               static_cast<std::int64_t>(std::floor(x / data.clusters.cell_m)) + (1 << 24)) &
           0x1ffffffU;
  };
  const double quarters = heading_of(T) / (0.5 * M_PI);
  const auto quarter = static_cast<std::uint64_t>(std::lround(quarters) + 4) & 3U;
  const auto number = static_cast<std::uint64_t>(camera + 3);  // ground and wheels too
  return cell(T.translation().x()) | cell(T.translation().y()) << 25U | quarter << 50U |
         number << 52U;
}

MotionScore motion_score(const ClusterData& data, const MotionConstraint& motion) {
  const double scale = motion.scale < 0 ? 1.0 : data.state.scales[at(motion.scale)];
  const MotionResidual e = motion_residual(
      data.state.poses[at(motion.from)], data.state.poses[at(motion.to)], motion.T_from_to, scale);
  MotionScore result;
  result.from = data.layout.variable[at(motion.from)];
  result.to = data.layout.variable[at(motion.to)];
  if (motion.scale >= 0) result.scale = free_scales(data.problem)[at(motion.scale)];
  Eigen::Matrix<double, 6, 13> J;
  J << e.J_from, e.J_to, e.J_scale;
  const double length = std::sqrt(e.r.dot(motion.information * e.r));
  const double weight = std::min(1.0, data.options.motion_loss_width / std::max(length, 1e-12));
  const Matrix6d U = motion.information.llt().matrixU();
  result.score = weight * J.transpose() * motion.information * e.r;
  result.root = std::sqrt(weight) * J.transpose() * U.transpose();
  return result;
}

std::vector<int> free_scales(const BundleProblem& problem) {
  std::vector<int> rows;
  int next = 0;
  for (const ScaleParameter& scale : problem.scales) rows.push_back(scale.fixed ? -1 : next++);
  return rows;
}

DrawnCovariance drawn_covariance(const ClusterData& data, const BundleSystem& system) {
  const std::size_t variables = data.layout.pose_of.size();
  const std::vector<int> rows = free_scales(data.problem);
  const Eigen::Index free = std::count_if(rows.begin(), rows.end(), [](int r) { return r >= 0; });
  DrawnCovariance result{std::vector<Matrix6d>(variables, Matrix6d::Zero()),
                         std::vector<double>(static_cast<std::size_t>(free), 0.0)};
  const int chunks = data.clusters.cases / kDraws;
  std::vector<Panel> poses(at(chunks));
  std::vector<Panel> scales(at(chunks));
  parallel_for(at(chunks), data.options.num_threads, [&](std::size_t c) {
    poses[c] = Panel::Zero(row_of(variables), kDraws);
    scales[c] = Panel::Zero(free, kDraws);
    const int chunk = static_cast<int>(c);
    const PlaceWords places(data, chunk);
    draw_points(data, chunk, places, poses[c]);
    draw_motions(data, chunk, places, poses[c], scales[c]);
    draw_priors(data, chunk, poses[c], scales[c]);
  });
  // The inverse of a covariance drawn from n cases is too large by n / (n - 7) in the mean.
  const double share = 1.0 / static_cast<double>(data.clusters.cases - 7);
  for (std::size_t c = 0; c < at(chunks); ++c) {
    system.solve_reduced(poses[c], scales[c]);
    for (std::size_t v = 0; v < variables; ++v) {
      const Eigen::Matrix<double, 6, kDraws> x = poses[c].middleRows<6>(row_of(v));
      result.poses[v].noalias() += share * x * x.transpose();
    }
    for (Eigen::Index s = 0; s < free; ++s)
      result.scale_variances[static_cast<std::size_t>(s)] += share * scales[c].row(s).squaredNorm();
    poses[c].resize(0, 0);
  }
  return result;
}

}  // namespace roadbook
