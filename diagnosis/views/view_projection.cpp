#include <algorithm>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "diagnosis/views/view_system.hpp"

namespace roadbook {
namespace {

// Writes the residual and the columns of `strip` to rows. `first`: elementary column of the strip's
// first column.
template <typename Residual, typename Strip>
void fill(const Residual& r,
          const Strip& strip,
          std::size_t first,
          const ViewSides& sides,
          ViewPanel& values,
          Eigen::Index row) {
  auto out = values.middleRows(row, r.rows());
  out.setZero();
  out.col(0) = r;
  if (sides.sums.size() == 0 && sides.count > 1 && sides.probes == 0)
    out.middleCols(1 + index(first), strip.cols()) = strip;
  else if (!sides.used.empty())
    for (Eigen::Index k = 0; k < strip.cols(); ++k)
      for (const auto& [s, weight] : sides.used[first + static_cast<std::size_t>(k)])
        for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, 1 + s) += weight * strip(i, k);
}

// Writes the draws of `count` rows into the last sides. `first`: index of the first row among all
// rows.
void fill_draws(std::size_t first,
                Eigen::Index count,
                const ViewSides& sides,
                ViewPanel& values,
                Eigen::Index row) {
  for (Eigen::Index i = 0; i < count && sides.probes > 0; ++i) {
    const ViewDraw& draw = sides.draws[first + static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < sides.probes; ++k)
      values(row + i, 1 + sides.sums.cols() + index(k)) =
          (draw.signs >> k & 1U) != 0 ? draw.size : -draw.size;
  }
}

std::vector<ViewDraw> random_signs(const ViewSystem& system, std::size_t probes) {
  std::vector<ViewDraw> draws;
  draws.reserve(system.row_count());
  for (std::size_t pose = 0; pose < system.poses(); ++pose) {
    Random random(1, "view probes", pose);
    for (std::size_t i = 0; i < system.row_info(pose).size(); ++i) {
      ViewDraw draw{1.0, 0};
      for (std::size_t k = 0; k < probes; ++k) draw.signs |= (random() >> 63U) << k;
      draws.push_back(draw);
    }
  }
  return draws;
}

}  // namespace

ViewSides ViewSystem::all_sides() const {
  ViewSides sides;
  sides.count = 1 + index(basis_.size());
  project(sides);
  return sides;
}

ViewSides ViewSystem::sides(const Eigen::MatrixXd& sums, std::size_t probes) const {
  ViewSides sides;
  sides.sums = sums;
  sides.used.resize(static_cast<std::size_t>(sums.rows()));
  for (Eigen::Index k = 0; k < sums.rows(); ++k)
    for (Eigen::Index s = 0; s < sums.cols(); ++s)
      if (sums(k, s) != 0.0) sides.used[static_cast<std::size_t>(k)].emplace_back(s, sums(k, s));
  sides.probes = probes;
  if (probes > 0) sides.draws = random_signs(*this, probes);
  sides.count = 1 + sums.cols() + index(probes);
  project(sides);
  return sides;
}

ViewSides ViewSystem::drawn_sides(std::vector<ViewDraw> draws, int count) const {
  ViewSides sides;
  sides.draws = std::move(draws);
  sides.probes = at(count);
  sides.count = 1 + count;
  project(sides);
  return sides;
}

void ViewSystem::raw_term(std::size_t t,
                          const ViewSides& sides,
                          ViewPanel& values,
                          Eigen::Index row) const {
  const Term& term = terms_[t];
  const double* strip = strips_.data() + term.strip;
  if (observation_of_term_[t] >= 0) {
    const Eigen::Map<const ViewPrediction::Strip> columns(strip, 2, index(basis_.per_camera()));
    fill(term.e.r, columns, basis_.camera(at(layout_.terms[t].camera)), sides, values, row);
  } else {
    const Eigen::Map<const Eigen::RowVectorXd> columns(strip,
                                                       index(basis_.size() - basis_.hinge()));
    fill(term.e.r.head<1>(), columns, basis_.hinge(), sides, values, row);
  }
  fill_draws(row_of_term_[t], rows_of_term(t), sides, values, row);
}

void ViewSystem::raw_motion(std::size_t m,
                            const ViewSides& sides,
                            ViewPanel& values,
                            Eigen::Index row) const {
  fill(motions_[m].r, motions_[m].strip, basis_.wheels(), sides, values, row);
  fill_draws(row_of_motion_[m], 6, sides, values, row);
}

void ViewSystem::raw(std::size_t pose, const ViewSides& sides, ViewPanel& values) const {
  values.resize(index(rows_of_pose_[pose].size()), sides.count);
  Eigen::Index row = 0;
  for (const std::size_t t : terms_of_pose_[pose]) {
    raw_term(t, sides, values, row);
    row += rows_of_term(t);
  }
  for (const std::size_t m : motions_of_pose_[pose]) {
    raw_motion(m, sides, values, row);
    row += 6;
  }
}

// Computes J^T s by summing the rows of every pose and every landmark.
void ViewSystem::project(ViewSides& sides) const {
  sum_to_poses(sides);
  sum_to_points(sides);
  system_->solve_columns(sides.poses, sides.points);
}

void ViewSystem::sum_to_poses(ViewSides& sides) const {
  sides.poses = ViewPanel::Zero(6 * index(layout_.pose_of.size()), sides.count);
  const auto add = [&](int pose, const auto& J, const auto& values) {
    const int v = layout_.variable[at(pose)];
    if (v >= 0) sides.poses.middleRows<6>(6 * v) += J.transpose().lazyProduct(values);
  };
  parallel_for(terms_of_pose_.size(), options_.num_threads, [&](std::size_t k) {
    ViewPanel values(2, sides.count);
    for (const std::size_t t : terms_of_pose_[k]) {
      raw_term(t, sides, values, 0);
      const Eigen::Index n = rows_of_term(t);
      add(static_cast<int>(k), terms_[t].e.J_pose.topRows(n), values.topRows(n));
    }
  });
  ViewPanel values(6, sides.count);
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    raw_motion(m, sides, values, 0);
    add(problem_.motions[m].from, motions_[m].J_from, values);
    add(problem_.motions[m].to, motions_[m].J_to, values);
  }
}

void ViewSystem::sum_to_points(ViewSides& sides) const {
  sides.points = ViewPanel::Zero(3 * index(problem_.points.size()), sides.count);
  parallel_for_small(problem_.points.size(), options_.num_threads, [&](std::size_t p) {
    ViewPanel values(2, sides.count);
    for (std::size_t t = layout_.term_begin[p]; t < layout_.term_begin[p + 1]; ++t) {
      raw_term(t, sides, values, 0);
      const Eigen::Index n = rows_of_term(t);
      sides.points.middleRows<3>(index(3 * p)) +=
          terms_[t].e.J_point.topRows(n).transpose().lazyProduct(values.topRows(n));
    }
  });
}

void ViewSystem::rows(std::size_t pose,
                      const ViewSides& sides,
                      ViewPanel& values,
                      bool raw_only) const {
  raw(pose, sides, values);
  if (raw_only) return;
  const auto take = [&](int of, const auto& J, auto&& rows) {
    const int v = layout_.variable[at(of)];
    if (v >= 0) rows -= J.lazyProduct(sides.poses.middleRows<6>(6 * v));
  };
  Eigen::Index row = 0;
  for (const std::size_t t : terms_of_pose_[pose]) {
    const TermResidual& e = terms_[t].e;
    const Eigen::Index n = rows_of_term(t);
    take(static_cast<int>(pose), e.J_pose.topRows(n), values.middleRows(row, n));
    values.middleRows(row, n) -=
        e.J_point.topRows(n).lazyProduct(sides.points.middleRows<3>(3 * terms_[t].point));
    row += n;
  }
  for (const std::size_t m : motions_of_pose_[pose]) {
    take(problem_.motions[m].from, motions_[m].J_from, values.middleRows<6>(row));
    take(problem_.motions[m].to, motions_[m].J_to, values.middleRows<6>(row));
    row += 6;
  }
}

void ViewSystem::each_pose(
    const ViewSides& sides,
    const std::function<void(std::size_t pose, const ViewPanel& values)>& body) const {
  const std::size_t at_once = num_threads() == 1 ? 1 : 32;
  std::vector<ViewPanel> values(at_once);
  for (std::size_t first = 0; first < poses(); first += at_once) {
    const std::size_t count = std::min(at_once, poses() - first);
    parallel_for(count, num_threads(), [&](std::size_t i) { rows(first + i, sides, values[i]); });
    for (std::size_t i = 0; i < count; ++i) body(first + i, values[i]);
  }
}

}  // namespace roadbook
