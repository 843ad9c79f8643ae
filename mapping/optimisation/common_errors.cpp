#include "mapping/optimisation/common_errors.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/optimisation/cluster_scores.hpp"

namespace roadbook {
namespace {

using Panel = BlockCholesky::Panel;

// The shifts of a landmark's residuals: two rows for each term, one column for each error.
Panel shifts_of(const PointTerms& point, const std::vector<CommonError>& errors) {
  Panel shifts = Panel::Zero(2 * static_cast<Eigen::Index>(point.terms.size()),
                             static_cast<Eigen::Index>(errors.size()));
  for (std::size_t t = 0; t < point.terms.size(); ++t) {
    const PointTerms::Term& term = point.terms[t];
    if (term.observation < 0) continue;  // a ground height
    for (std::size_t e = 0; e < errors.size(); ++e)
      shifts.block<2, 1>(static_cast<Eigen::Index>(2 * t), static_cast<Eigen::Index>(e)) =
          term.root_per_px * errors[e].pixels[at(term.observation)];
  }
  return shifts;
}

}  // namespace

std::vector<CommonMove> moves_of(const ClusterData& data,
                                 const BundleSystem& system,
                                 const std::vector<CommonError>& errors) {
  if (errors.empty()) return {};
  const auto count = static_cast<Eigen::Index>(errors.size());
  Panel scores = Panel::Zero(row_of(data.layout.pose_of.size()), count);
  const std::vector<int> rows = free_scales(data.problem);
  Panel scales =
      Panel::Zero(std::count_if(rows.begin(), rows.end(), [](int r) { return r >= 0; }), count);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(count);   // e^T e with the points projected out
  Eigen::VectorXd products = Eigen::VectorXd::Zero(count);  // e^T r
  for (std::size_t p = 0; p < data.problem.points.size(); ++p) {
    const PointTerms point = point_terms(data.problem, data.layout, data.options, data.state, p);
    if (point.terms.empty()) continue;
    const Panel shifts = after_landmark(point, shifts_of(point, errors));
    squares += shifts.colwise().squaredNorm().transpose();
    for (std::size_t t = 0; t < point.terms.size(); ++t) {
      const auto of_term = shifts.middleRows<2>(static_cast<Eigen::Index>(2 * t));
      products += of_term.transpose() * point.terms[t].r;
    }
    add_scores(point, shifts, scores);
  }
  Panel moves = scores;
  system.solve_reduced(moves, scales);
  std::vector<CommonMove> result;
  for (Eigen::Index e = 0; e < count; ++e) {
    const double left = squares[e] - scores.col(e).dot(moves.col(e));
    // The poses are at their optimum: J^T r is zero.
    const double size = left > 1e-9 * squares[e] ? std::abs(products[e]) / left : 1.0;
    CommonMove move;
    move.size = std::max(1.0, size);
    move.poses = move.size * moves.col(e);
    move.scales = move.size * scales.col(e);
    result.push_back(std::move(move));
  }
  return result;
}

}  // namespace roadbook
