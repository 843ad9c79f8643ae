#include "diagnosis/view_compression.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "base/index.hpp"

namespace roadbook {
namespace {

// Upper triangular R with R^T R = G for G >= 0; directions without length get next to none.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& G) {
  const Eigen::VectorXd scale = G.diagonal().cwiseMax(1e-200).cwiseSqrt();
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  Eigen::MatrixXd unit = inverse.asDiagonal() * G * inverse.asDiagonal();
  unit.diagonal().array() += 1e-11;
  const Eigen::LLT<Eigen::MatrixXd> llt(unit);
  Eigen::MatrixXd R = llt.matrixU();
  return R * scale.asDiagonal();
}

// Sides by sums of elementary columns; few weights differ from 0.
Eigen::MatrixXd summed(const Eigen::MatrixXd& elementary, const Eigen::MatrixXd& sums) {
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(elementary.rows(), 1 + sums.cols());
  sides.col(0) = elementary.col(0);
  for (Eigen::Index s = 0; s < sums.cols(); ++s)
    for (Eigen::Index k = 0; k < sums.rows(); ++k)
      if (sums(k, s) != 0.0) sides.col(1 + s) += sums(k, s) * elementary.col(1 + k);
  return sides;
}

void append_rows(const Eigen::MatrixXd& sides, double t_s, Innovations& innovations) {
  for (Eigen::Index i = 0; i < sides.rows(); ++i) {
    innovations.of.push_back({innovations.of.size(), 0, t_s, 1.0});
    for (Eigen::Index k = 0; k < sides.cols(); ++k) innovations.values.push_back(sides(i, k));
  }
}

// Of each landmark its first observation by the camera that has the fewest so far: a camera at the
// rear sees all after one at the front, and one that looks ahead has few views.
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
  // Few sums cost less than all that they might be made of.
  const bool few = 4 * sums.cols() < sums.rows();
  const ViewSides all = few ? system.sides(sums) : system.all_sides();
  Innovations innovations;
  innovations.sides = static_cast<std::size_t>(1 + sums.cols());
  ViewPanel values;
  for (std::size_t begin = 0, end = 0; begin < system.poses(); begin = end) {
    const auto stretch_of = [&](std::size_t k) {
      return std::floor(data.moments[k].t_s / kCompressedSeconds);
    };
    const double stretch = stretch_of(begin);
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(all.count, all.count);
    std::size_t rows = 0;
    for (end = begin; end < system.poses() && stretch_of(end) == stretch; ++end) {
      system.rows(end, all, values);
      rows += static_cast<std::size_t>(values.rows());
      G.selfadjointView<Eigen::Lower>().rankUpdate(values.transpose());
    }
    if (rows == 0) continue;
    G = Eigen::MatrixXd(G.selfadjointView<Eigen::Lower>());
    append_rows(few ? root_of(G) : summed(root_of(G), sums), kCompressedSeconds * (stretch + 0.5),
                innovations);
  }
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
  ViewPanel values;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, values);
    const auto& info = system.row_info(k);
    for (std::size_t i = 0; i < info.size(); ++i) {
      if (info[i].observation >= 0) {
        const auto point = at(data.bundle.observations[at(info[i].observation)].point);
        // Of a view's two rows x for even landmarks, y for odd ones.
        const bool second = i > 0 && info[i - 1].observation == info[i].observation;
        if (info[i].observation != chosen[point] || second != (point % 2 == 1)) continue;
      } else if (info[i].channel != channels.ground()) {
        continue;
      }
      innovations.of.push_back({i, info[i].channel, data.moments[k].t_s, 1.0});
      for (Eigen::Index s = 0; s < sides.count; ++s)
        innovations.values.push_back(values(static_cast<Eigen::Index>(i), s));
    }
  }
  return innovations;
}

}  // namespace roadbook
