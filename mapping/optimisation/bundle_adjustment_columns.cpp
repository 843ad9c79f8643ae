#include "base/parallel.hpp"
#include "mapping/optimisation/bundle_adjustment_system.hpp"

namespace roadbook {

void BundleSystem::solve_columns(BlockCholesky::Panel& poses, BlockCholesky::Panel& points) const {
  const auto point_rows = [&](std::size_t p) {
    return points.middleRows<3>(static_cast<Eigen::Index>(3 * p));
  };
  const auto pose_rows = [&](std::size_t v) { return poses.middleRows<6>(row_of(v)); };
  // In two steps: the inverse of V itself would lose twice as many digits.
  const auto solved_for_point = [&](std::size_t p,
                                    const BlockCholesky::Panel& b) -> BlockCholesky::Panel {
    const BlockCholesky::Panel half = L_inv_[p].lazyProduct(b);
    return L_inv_[p].transpose().lazyProduct(half);
  };
  parallel_for_small(problem_.points.size(), options_.num_threads,
                     [&](std::size_t p) { point_rows(p) = solved_for_point(p, point_rows(p)); });
  parallel_for(U_.size(), options_.num_threads, [&](std::size_t v) {
    auto b = pose_rows(v);
    for (std::size_t k = layout_.pose_link_begin[v]; k < layout_.pose_link_begin[v + 1]; ++k) {
      const std::size_t link = layout_.pose_links[k];
      b -= W_[link].lazyProduct(point_rows(at(layout_.link_point[link])));
    }
  });
  S_.solve(poses, options_.num_threads);
  parallel_for_small(problem_.points.size(), options_.num_threads, [&](std::size_t p) {
    BlockCholesky::Panel moved = BlockCholesky::Panel::Zero(3, points.cols());
    for (std::size_t l = layout_.link_begin[p]; l < layout_.link_begin[p + 1]; ++l)
      moved += W_[l].transpose().lazyProduct(pose_rows(at(layout_.link_variable[l])));
    point_rows(p) -= solved_for_point(p, moved);
  });
}

void BundleSystem::solve_reduced(BlockCholesky::Panel& poses, BlockCholesky::Panel& scales) const {
  S_.solve(poses, options_.num_threads);
  if (scale_count_ == 0) return;
  scales = scale_inverse_ * (scales - border_.transpose() * poses);
  poses -= X_ * scales;
}

Matrix6d BundleSystem::shared_covariance(int a, int b) {
  bool transposed = false;
  const Matrix6d& stored = S_.block(a, b, transposed);
  Matrix6d shared = transposed ? Matrix6d(stored.transpose()) : stored;
  if (scale_count_ > 0)
    shared += X_.middleRows<6>(row_of(at(a))) * scale_inverse_ *
              X_.middleRows<6>(row_of(at(b))).transpose();
  return shared;
}

}  // namespace roadbook
