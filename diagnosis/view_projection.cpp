#include "base/index.hpp"
#include "base/random.hpp"
#include "diagnosis/view_system.hpp"

namespace roadbook {
namespace {

// Writes residual and columns of `strip` (which begins at elementary column `first`) to rows.
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

void raw_draws(std::size_t first, const ViewSides& sides, ViewPanel& values) {
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const ViewDraw& draw = sides.draws[first + static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < sides.probes; ++k)
      values(i, 1 + index(k)) = (draw.signs >> k & 1U) != 0 ? draw.size : -draw.size;
  }
}

void raw_probes(std::size_t pose, const ViewSides& sides, ViewPanel& values) {
  Random random(1, "view probes", pose);
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (std::size_t k = 0; k < sides.probes; ++k)
      values(i, 1 + sides.sums.cols() + index(k)) = (random() >> 63U) != 0 ? 1.0 : -1.0;
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
    const Eigen::Map<const Eigen::RowVectorXd> columns(
        strip, index(basis_.hinges.size() + kGroundColumns.size()));
    fill(term.e.r.head<1>(), columns, basis_.hinge(), sides, values, row);
  }
}

void ViewSystem::raw_motion(std::size_t m,
                            const ViewSides& sides,
                            ViewPanel& values,
                            Eigen::Index row) const {
  fill(motions_[m].r, motions_[m].strip, basis_.wheels(), sides, values, row);
}

void ViewSystem::raw(std::size_t pose, const ViewSides& sides, ViewPanel& values) const {
  values.resize(index(rows_of_pose_[pose].size()), sides.count);
  Eigen::Index row = 0;
  for (const std::size_t t : terms_of_pose_[pose]) {
    raw_term(t, sides, values, row);
    row += observation_of_term_[t] >= 0 ? 2 : 1;
  }
  for (const std::size_t m : motions_of_pose_[pose]) {
    raw_motion(m, sides, values, row);
    row += 6;
  }
  if (!sides.draws.empty())
    raw_draws(first_row_[pose], sides, values);
  else if (sides.probes > 0)
    raw_probes(pose, sides, values);
}

void ViewSystem::project(ViewSides& sides) const {
  sides.poses = ViewPanel::Zero(6 * index(layout_.pose_of.size()), sides.count);
  sides.points = ViewPanel::Zero(3 * index(problem_.points.size()), sides.count);
  const auto add = [&](int pose, const auto& J, const auto& values) {
    const int v = layout_.variable[at(pose)];
    if (v >= 0) sides.poses.middleRows<6>(6 * v) += J.transpose().lazyProduct(values);
  };
  ViewPanel values;
  for (std::size_t k = 0; k < rows_of_pose_.size(); ++k) {
    raw(k, sides, values);
    Eigen::Index row = 0;
    for (const std::size_t t : terms_of_pose_[k]) {
      const TermResidual& e = terms_[t].e;
      const Eigen::Index n = observation_of_term_[t] >= 0 ? 2 : 1;
      add(static_cast<int>(k), e.J_pose.topRows(n), values.middleRows(row, n));
      sides.points.middleRows<3>(3 * terms_[t].point) +=
          e.J_point.topRows(n).transpose().lazyProduct(values.middleRows(row, n));
      row += n;
    }
    for (const std::size_t m : motions_of_pose_[k]) {
      add(problem_.motions[m].from, motions_[m].J_from, values.middleRows<6>(row));
      add(problem_.motions[m].to, motions_[m].J_to, values.middleRows<6>(row));
      row += 6;
    }
  }
  system_->solve_columns(sides.poses, sides.points);
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
    const Eigen::Index n = observation_of_term_[t] >= 0 ? 2 : 1;
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

}  // namespace roadbook
