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

// What the residuals say of each error once poses and points have moved to fit it.
struct Sizes {
  Eigen::VectorXd squares;    // e~^T e~
  Eigen::VectorXd products;   // e~^T r
  Eigen::VectorXd variances;  // of the products

  explicit Sizes(Eigen::Index count)
      : squares(Eigen::VectorXd::Zero(count)), products(squares), variances(squares) {}
};

Sizes sizes_of(const ClusterData& data,
               const std::vector<CommonError>& errors,
               const Panel& moves) {
  Sizes sizes(static_cast<Eigen::Index>(errors.size()));
  for (std::size_t p = 0; p < data.problem.points.size(); ++p) {
    const PointTerms point = point_terms(data.problem, data.layout, data.options, data.state, p);
    if (point.terms.empty()) continue;
    Panel left = shifts_of(point, errors);
    for (std::size_t t = 0; t < point.terms.size(); ++t)
      if (const int v = point.terms[t].variable; v >= 0)
        left.middleRows<2>(static_cast<Eigen::Index>(2 * t)) -=
            point.terms[t].J_pose.lazyProduct(moves.middleRows<6>(row_of(at(v))));
    left = after_landmark(point, left);
    Eigen::VectorXd products = Eigen::VectorXd::Zero(sizes.products.size());
    for (std::size_t t = 0; t < point.terms.size(); ++t)
      products +=
          left.middleRows<2>(static_cast<Eigen::Index>(2 * t)).transpose() * point.terms[t].r;
    sizes.squares += left.colwise().squaredNorm().transpose();
    sizes.products += products;
    sizes.variances += products.cwiseAbs2();
  }
  return sizes;
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
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(count);  // e^T e with the points projected out
  for (std::size_t p = 0; p < data.problem.points.size(); ++p) {
    const PointTerms point = point_terms(data.problem, data.layout, data.options, data.state, p);
    if (point.terms.empty()) continue;
    const Panel shifts = after_landmark(point, shifts_of(point, errors));
    squares += shifts.colwise().squaredNorm().transpose();
    add_scores(point, shifts, scores);
  }
  Panel moves = scores;
  system.solve_reduced(moves, scales);
  const Sizes sizes = sizes_of(data, errors, moves);
  std::vector<CommonMove> result;
  for (Eigen::Index e = 0; e < count; ++e) {
    constexpr double kSigmas = 6.0;  // one of three drives with right lenses had 4
    const bool shows = sizes.squares[e] > 1e-9 * squares[e];  // the poses do not hide all of it
    const double size = shows ? std::abs(sizes.products[e]) / sizes.squares[e] : 0.0;
    const bool sure = std::abs(sizes.products[e]) > kSigmas * std::sqrt(sizes.variances[e]);
    CommonMove move;
    switch (errors[static_cast<std::size_t>(e)].size) {
      case CommonErrorSize::kAtLeast:
        move.size = std::max(1.0, size);
        break;
      case CommonErrorSize::kIfShown:
        move.size = sure ? size : 0.0;
        break;
      case CommonErrorSize::kKnown:
        move.size = 1.0;
        break;
    }
    move.poses = move.size * moves.col(e);
    move.scales = move.size * scales.col(e);
    result.push_back(std::move(move));
  }
  return result;
}

}  // namespace roadbook
