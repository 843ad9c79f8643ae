#include "mapping/bundle_adjustment_system.hpp"

namespace roadbook {

void BundleSystem::solve_columns(BlockCholesky::Panel& poses, BlockCholesky::Panel& points) const {
  const auto point_rows = [&](std::size_t p) {
    return points.middleRows<3>(static_cast<Eigen::Index>(3 * p));
  };
  const auto pose_rows = [&](std::size_t l) {
    return poses.middleRows<6>(6 * static_cast<Eigen::Index>(layout_.link_variable[l]));
  };
  for (std::size_t p = 0; p < problem_.points.size(); ++p) {
    auto b = point_rows(p);
    b = L_inv_[p].lazyProduct(b).eval();
    for (std::size_t l = layout_.link_begin[p]; l < layout_.link_begin[p + 1]; ++l)
      pose_rows(l) -= Y_[l].lazyProduct(b);
  }
  S_.solve(poses);
  for (std::size_t p = 0; p < problem_.points.size(); ++p) {
    auto b = point_rows(p);
    for (std::size_t l = layout_.link_begin[p]; l < layout_.link_begin[p + 1]; ++l)
      b -= Y_[l].transpose().lazyProduct(pose_rows(l));
    b = L_inv_[p].transpose().lazyProduct(b).eval();
  }
}

}  // namespace roadbook
