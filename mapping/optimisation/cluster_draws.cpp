#include "mapping/optimisation/cluster_draws.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "mapping/optimisation/cluster_scores.hpp"

namespace roadbook {
namespace {

constexpr int kDraws = 64;  // one bit of a random word each
constexpr int kHalfDraws = kDraws / 2;
using Panel = BlockCholesky::Panel;
using Signs = Eigen::Matrix<double, 1, kHalfDraws>;

// Some draws that one thread makes: half the columns of a chunk.
struct Draws {
  int chunk;
  int half;
};

Signs signs_of(std::uint64_t word, Draws draws) {
  Signs signs;
  for (int k = 0; k < kHalfDraws; ++k)
    signs(k) = (word >> (kHalfDraws * draws.half + k) & 1U) != 0 ? 1.0 : -1.0;
  return signs;
}

Random stream(const ClusterData& data, const char* name, std::uint64_t index, Draws draws) {
  return {data.clusters.seed + 1000 * static_cast<std::uint64_t>(draws.chunk), name, index};
}

// The signs of all cameras, the ground and the wheels at the places of all poses.
class PlaceSigns {
 public:
  PlaceSigns(const ClusterData& data, Draws draws)
      : draws_(draws), sensors_(static_cast<int>(data.problem.cameras.size()) - kWheels) {
    for (std::size_t k = 0; k < data.state.poses.size(); ++k)
      for (int s = 0; s < sensors_; ++s)
        words_.push_back(
            stream(data, "place", place_of(data, static_cast<int>(k), s + kWheels), draws)());
  }
  [[nodiscard]] Signs of(int pose, int camera) const {
    return signs_of(words_[at(pose * sensors_ + camera - kWheels)], draws_);
  }

 private:
  Draws draws_;
  int sensors_;
  std::vector<std::uint64_t> words_;
};

// Right-hand sides of one chunk, one column for each draw.
struct Scores {
  Panel poses;
  Panel scales;

  Scores(std::size_t variables, Eigen::Index free)
      : poses(Panel::Zero(row_of(variables), kDraws)), scales(Panel::Zero(free, kDraws)) {}
  auto pose(int variable, Draws draws) {
    return poses.block<6, kHalfDraws>(row_of(at(variable)), kHalfDraws * draws.half);
  }
  auto scale(int row, Draws draws) {
    return scales.block<1, kHalfDraws>(row, kHalfDraws * draws.half);
  }
  void add(const MotionScore& motion,
           const Eigen::Matrix<double, 13, kHalfDraws>& sum,
           Draws draws) {
    if (motion.from >= 0) pose(motion.from, draws) += sum.topRows<6>();
    if (motion.to >= 0) pose(motion.to, draws) += sum.middleRows<6>(6);
    if (motion.scale >= 0) scale(motion.scale, draws) += sum.row(12);
  }
};

struct PartScores {
  Scores landmarks, places, both;
  PartScores(std::size_t variables, Eigen::Index free)
      : landmarks(variables, free), places(variables, free), both(variables, free) {}
};

void draw_points(const ClusterData& data,
                 Draws draws,
                 const PlaceSigns& places,
                 PartScores& parts) {
  Panel residuals;
  for (std::size_t p = 0; p < data.problem.points.size(); ++p) {
    const PointTerms point = point_terms(data.problem, data.layout, data.options, data.state, p);
    if (point.terms.empty()) continue;
    const int corner = data.problem.points[p].corner;
    const Signs track =
        signs_of(stream(data, "landmark", corner < 0 ? p : at(corner), draws)(), draws);
    const double grown = 1.0 / std::max(0.1, 1.0 - data.leverage[p]);
    Eigen::VectorXd own(2 * static_cast<Eigen::Index>(point.terms.size()));
    residuals.resize(own.size(), kHalfDraws);
    for (std::size_t t = 0; t < point.terms.size(); ++t) {
      const PointTerms::Term& term = point.terms[t];
      const auto row = static_cast<Eigen::Index>(2 * t);
      own.segment<2>(row) = term.r;
      residuals.middleRows<2>(row) = term.r * places.of(term.pose, term.camera);
    }
    const Panel of_landmark = after_landmark(point, own);
    const Panel of_places = after_landmark(point, residuals);
    for (std::size_t t = 0; t < point.terms.size(); ++t) {
      const PointTerms::Term& term = point.terms[t];
      if (term.variable < 0) continue;
      const auto row = static_cast<Eigen::Index>(2 * t);
      const Vector6d score = grown * term.J_pose.transpose() * of_landmark.middleRows<2>(row);
      const Eigen::Matrix<double, 6, kHalfDraws, Eigen::RowMajor> of_place =
          term.J_pose.transpose().lazyProduct(of_places.middleRows<2>(row));
      parts.landmarks.pose(term.variable, draws) += score.lazyProduct(track);
      parts.places.pose(term.variable, draws) += of_place;
      parts.both.pose(term.variable, draws).array() += of_place.array().rowwise() * track.array();
    }
  }
}

void draw_motions(const ClusterData& data,
                  Draws draws,
                  const PlaceSigns& places,
                  PartScores& parts) {
  for (std::size_t i = 0; i < data.problem.motions.size(); ++i) {
    const MotionConstraint& motion = data.problem.motions[i];
    const MotionScore score = motion_score(data, motion);
    Random random = stream(data, "motion", i, draws);
    Panel noise(6, kHalfDraws);
    for (int row = 0; row < 6; ++row) noise.row(row) = signs_of(random(), draws);
    parts.landmarks.add(score, score.root.lazyProduct(noise), draws);
    parts.places.add(score, score.score.lazyProduct(places.of(motion.to, kWheels)), draws);
    parts.both.add(score, score.score.lazyProduct(signs_of(random(), draws)), draws);
  }
}

void draw_priors(const ClusterData& data, Draws draws, Scores& scores) {
  const std::vector<int> rows = free_scales(data.problem);
  for (std::size_t s = 0; s < rows.size(); ++s)
    if (rows[s] >= 0)
      scores.scale(rows[s], draws) +=
          signs_of(stream(data, "scale", s, draws)(), draws) / data.problem.scales[s].prior_sigma;
  for (std::size_t i = 0; i < data.problem.priors.size(); ++i) {
    const PosePrior& prior = data.problem.priors[i];
    const int v = data.layout.variable[at(prior.pose)];
    if (v < 0) continue;
    Random random = stream(data, "prior", i, draws);
    Panel noise(6, kHalfDraws);
    for (int row = 0; row < 6; ++row) noise.row(row) = signs_of(random(), draws);
    const MotionResidual e = motion_residual(
        Eigen::Isometry3d::Identity(), data.state.poses[at(prior.pose)], prior.T_map_vehicle, 1.0);
    const Matrix6d U = prior.information.llt().matrixU();
    scores.pose(v, draws) += (e.J_to.transpose() * U.transpose()).lazyProduct(noise);
  }
}

// Adds a chunk of one part to the covariance of that part. Frees the chunk: of a large map the
// draws are large.
void add_to(const BundleSystem& system, double share, Scores& chunk, DrawnCovariance& sum) {
  system.solve_reduced(chunk.poses, chunk.scales);
  for (std::size_t v = 0; v < sum.poses.size(); ++v) {
    const Eigen::Matrix<double, 6, kDraws> x = chunk.poses.middleRows<6>(row_of(v));
    sum.poses[v].noalias() += share * x * x.transpose();
  }
  for (std::size_t s = 0; s < sum.scale_variances.size(); ++s)
    sum.scale_variances[s] += share * chunk.scales.row(static_cast<Eigen::Index>(s)).squaredNorm();
  chunk.poses.resize(0, 0);
}

// A plus the part of B that is positive where A is the unit (Cameron, Gelbach and Miller 2011,
// section 2.3, drop negative eigenvalues).
Matrix6d plus_positive_part(const Matrix6d& A, const Matrix6d& B) {
  const Eigen::LLT<Matrix6d> llt(A);
  if (llt.info() != Eigen::Success) return A;
  const Matrix6d inverse = llt.matrixL().solve(Matrix6d::Identity());
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(inverse * B * inverse.transpose());
  const Matrix6d axes = Matrix6d(llt.matrixL()) * solver.eigenvectors();
  const Vector6d sizes = solver.eigenvalues().cwiseMax(0.0) + Vector6d::Ones();
  return axes * sizes.asDiagonal() * axes.transpose();
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
                         std::vector<double>(at(static_cast<int>(free)), 0.0)};
  DrawnCovariance of_places = result;
  DrawnCovariance of_both = result;
  // The inverse of a covariance drawn from n cases is too large by n / (n - 7) in the mean.
  const double share = 1.0 / static_cast<double>(data.clusters.cases - 7);
  for (int chunk = 0; chunk < data.clusters.cases / kDraws; ++chunk) {
    PartScores parts(variables, free);
    parallel_for(2, data.options.num_threads, [&](std::size_t half) {
      const Draws draws{chunk, static_cast<int>(half)};
      const PlaceSigns signs(data, draws);
      draw_points(data, draws, signs, parts);
      draw_motions(data, draws, signs, parts);
      draw_priors(data, draws, parts.landmarks);
    });
    add_to(system, share, parts.landmarks, result);
    add_to(system, share, parts.places, of_places);
    add_to(system, share, parts.both, of_both);
  }
  for (std::size_t v = 0; v < variables; ++v)
    result.poses[v] = plus_positive_part(result.poses[v], of_places.poses[v] - of_both.poses[v]);
  for (std::size_t s = 0; s < result.scale_variances.size(); ++s)
    result.scale_variances[s] +=
        std::max(0.0, of_places.scale_variances[s] - of_both.scale_variances[s]);
  return result;
}

}  // namespace roadbook
