#include "mapping/optimisation/effective_clusters.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>

#include "base/median.hpp"
#include "mapping/optimisation/cluster_scores.hpp"

namespace roadbook {
namespace {

using Panel = BlockCholesky::Panel;
using Row = Eigen::RowVectorXd;

// Rows of H^-1 of the sampled poses, whitened by their covariances: six columns for each.
class Sample {
 public:
  Sample(const ClusterData& data,
         const BundleSystem& system,
         const std::vector<Matrix6d>& covariances) {
    const std::size_t variables = data.layout.pose_of.size();
    const std::size_t count = std::min(variables, at(data.clusters.sampled_poses));
    poses = Panel::Zero(row_of(variables), row_of(count));
    const std::vector<int> rows = free_scales(data.problem);
    scales = Panel::Zero(std::count_if(rows.begin(), rows.end(), [](int r) { return r >= 0; }),
                         row_of(count));
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t v = (2 * i + 1) * variables / (2 * count);
      const Eigen::LLT<Matrix6d> llt(covariances[v]);
      if (llt.info() != Eigen::Success) continue;  // its columns stay zero
      poses.block<6, 6>(row_of(v), row_of(i)) =
          llt.matrixL().solve(Matrix6d::Identity()).transpose();
    }
    system.solve_reduced(poses, scales);
  }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(poses.cols() / 6); }

  Panel poses;
  Panel scales;
};

// The sum of q^2 over clusters, for each sampled pose.
class Shares {
 public:
  explicit Shares(std::size_t count) : squares_(count, 0.0) {}
  void add(const Row& a) {
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      const double q = a.segment<6>(row_of(i)).squaredNorm();
      squares_[i] += q * q;
    }
  }
  // The sum of q is 6 over all that makes up the covariance, noise without clusters included.
  [[nodiscard]] double median_clusters() const {
    std::vector<double> clusters;
    for (const double s : squares_)
      if (s > 0.0) clusters.push_back(36.0 / s);
    return clusters.empty() ? 0.0 : median(clusters);
  }

 private:
  std::vector<double> squares_;
};

}  // namespace

double effective_clusters(const ClusterData& data,
                          const BundleSystem& system,
                          const std::vector<Matrix6d>& covariances) {
  const Sample sample(data, system, covariances);
  Shares shares(sample.count());
  std::map<std::uint64_t, Row> places;
  const auto place = [&](int pose, int camera) -> Row& {
    return places.try_emplace(place_of(data, pose, camera), Row::Zero(sample.poses.cols()))
        .first->second;
  };
  Row of_corner = Row::Zero(sample.poses.cols());  // whose points follow each other
  for (std::size_t p = 0; p < data.problem.points.size(); ++p) {
    const PointTerms point = point_terms(data.problem, data.layout, data.options, data.state, p);
    Row landmark = Row::Zero(sample.poses.cols());
    Eigen::Matrix<double, 3, Eigen::Dynamic> moved =
        Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, sample.poses.cols());
    for (const PointTerms::Term& t : point.terms)
      if (t.variable >= 0)
        moved +=
            t.J_point.transpose() * (t.J_pose * sample.poses.middleRows<6>(row_of(at(t.variable))));
    moved = (point.V_inverse * moved).eval();
    for (const PointTerms::Term& t : point.terms) {
      Row a = -t.r.transpose() * (t.J_point * moved);
      if (t.variable >= 0)
        a += (t.J_pose.transpose() * t.r).transpose() *
             sample.poses.middleRows<6>(row_of(at(t.variable)));
      place(t.pose, t.camera) += a;
      landmark += a;
    }
    of_corner += landmark / std::max(0.1, 1.0 - data.leverage[p]);
    const int corner = data.problem.points[p].corner;
    if (corner >= 0 && p + 1 < data.problem.points.size() &&
        data.problem.points[p + 1].corner == corner)
      continue;
    shares.add(of_corner);
    of_corner.setZero();
  }
  for (const MotionConstraint& motion : data.problem.motions) {
    const MotionScore s = motion_score(data, motion);
    Row& a = place(motion.to, kWheels);
    if (s.from >= 0)
      a += s.score.head<6>().transpose() * sample.poses.middleRows<6>(row_of(at(s.from)));
    if (s.to >= 0)
      a += s.score.segment<6>(6).transpose() * sample.poses.middleRows<6>(row_of(at(s.to)));
    if (s.scale >= 0) a += s.score(12) * sample.scales.row(s.scale);
  }
  for (const auto& [key, a] : places) shares.add(a);
  return shares.median_clusters();
}

}  // namespace roadbook
