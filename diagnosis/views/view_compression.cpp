#include "diagnosis/views/view_compression.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

// Upper triangular R with R^T R = G for positive semi-definite G; null directions get a tiny value.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& G) {
  const Eigen::VectorXd scale = G.diagonal().cwiseMax(1e-200).cwiseSqrt();
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  Eigen::MatrixXd unit = inverse.asDiagonal() * G * inverse.asDiagonal();
  unit.diagonal().array() += 1e-11;
  const Eigen::LLT<Eigen::MatrixXd> llt(unit);
  Eigen::MatrixXd R = llt.matrixU();
  return R * scale.asDiagonal();
}

// The residual and the sums of elementary columns. Only a few weights differ from 0.
Eigen::MatrixXd summed(const Eigen::MatrixXd& elementary, const Eigen::MatrixXd& sums) {
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(elementary.rows(), 1 + sums.cols());
  sides.col(0) = elementary.col(0);
  for (Eigen::Index s = 0; s < sums.cols(); ++s)
    for (Eigen::Index k = 0; k < sums.rows(); ++k)
      if (sums(k, s) != 0.0) sides.col(1 + s) += sums(k, s) * elementary.col(1 + k);
  return sides;
}

// Range of poses with rows in one stretch of driving.
struct Stretch {
  std::size_t begin = 0, end = 0;
  double t_s = 0.0;  ///< middle of the stretch
};

std::vector<Stretch> stretches_of(const ViewSystem& system, const ViewData& data) {
  std::vector<Stretch> all;
  for (std::size_t begin = 0, end = 0; begin < system.poses(); begin = end) {
    const auto number_of = [&](std::size_t k) {
      return std::floor(data.moments[k].t_s / kCompressedSeconds);
    };
    bool rows = false;
    for (; end < system.poses() && number_of(end) == number_of(begin); ++end)
      rows = rows || !system.row_info(end).empty();
    if (rows) all.push_back({begin, end, kCompressedSeconds * (number_of(begin) + 0.5)});
  }
  return all;
}

Eigen::MatrixXd compressed(const ViewSystem& system, const ViewSides& sides, const Stretch& s) {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(sides.count, sides.count);
  ViewPanel values;
  for (std::size_t k = s.begin; k < s.end; ++k) {
    system.rows(k, sides, values);
    if (values.rows() == 0) continue;  // Eigen would divide by the number of rows
    G.selfadjointView<Eigen::Lower>().rankUpdate(values.transpose());
  }
  return root_of(Eigen::MatrixXd(G.selfadjointView<Eigen::Lower>()));
}

// For each landmark its first observation by the camera that has the fewest rows so far. Otherwise
// a front camera, which sees every landmark first, would have nearly all.
std::vector<int> one_a_landmark(const BundleProblem& bundle) {
  std::vector<int> chosen(bundle.points.size(), -1);
  std::vector<std::size_t> of_camera(bundle.cameras.size(), 0);
  const auto& seen = bundle.observations;
  for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
    std::size_t best = begin;
    for (end = begin; end < seen.size() && seen[end].point == seen[begin].point; ++end)
      if (of_camera[at(seen[end].camera)] < of_camera[at(seen[best].camera)]) best = end;
    ++of_camera[at(seen[best].camera)];
    chosen[at(seen[best].point)] = static_cast<int>(best);
  }
  return chosen;
}

}  // namespace

Innovations compressed_innovations(const ViewSystem& system,
                                   const ViewData& data,
                                   const Eigen::MatrixXd& sums) {
  // Few sums cost less than all elementary columns.
  const bool few = 4 * sums.cols() < sums.rows();
  const ViewSides all = few ? system.sides(sums) : system.all_sides();
  const std::vector<Stretch> stretches = stretches_of(system, data);
  const auto rows = static_cast<std::size_t>(all.count);
  Innovations innovations;
  innovations.sides = static_cast<std::size_t>(1 + sums.cols());
  for (std::size_t i = 0; i < rows * stretches.size(); ++i)
    innovations.of.push_back({i, 0, stretches[i / rows].t_s, 1.0});
  innovations.values.resize(innovations.of.size() * innovations.sides);
  parallel_for(stretches.size(), system.num_threads(), [&](std::size_t s) {
    const Eigen::MatrixXd R = compressed(system, all, stretches[s]);
    Eigen::Map<ViewPanel>(innovations.values.data() + s * rows * innovations.sides, all.count,
                          1 + sums.cols()) = few ? R : summed(R, sums);
  });
  return innovations;
}

Innovations landmark_innovations(const ViewSystem& system,
                                 const ViewData& data,
                                 const Eigen::MatrixXd& sums) {
  const ViewChannels channels{data.bundle.cameras.size()};
  const ViewSides sides = system.sides(sums);
  Innovations innovations;
  innovations.sides = static_cast<std::size_t>(sides.count);
  const std::vector<int> chosen = one_a_landmark(data.bundle);
  system.each_pose(sides, [&](std::size_t k, const ViewPanel& values) {
    const auto& info = system.row_info(k);
    for (std::size_t i = 0; i < info.size(); ++i) {
      if (info[i].observation >= 0) {
        const auto point = at(data.bundle.observations[at(info[i].observation)].point);
        // Of the two rows of a view: x for points with an even index, y for odd ones.
        const bool second = i > 0 && info[i - 1].observation == info[i].observation;
        if (info[i].observation != chosen[point] || second != (point % 2 == 1)) continue;
      } else if (info[i].channel != channels.ground()) {
        continue;
      }
      innovations.of.push_back({i, info[i].channel, data.moments[k].t_s, 1.0});
      for (Eigen::Index s = 0; s < sides.count; ++s)
        innovations.values.push_back(values(static_cast<Eigen::Index>(i), s));
    }
  });
  return innovations;
}

}  // namespace roadbook
