#include "diagnosis/views/hinge_lines.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace roadbook {
namespace {

// Prior standard deviations of a line found by the search, and the largest share of one that a
// single step may use.
constexpr double kLineTurn = 0.3;   // [rad]
constexpr double kLineShift = 3.0;  // [m]
constexpr double kAtOnce = 0.4;

bool has_line(const Accepted& cause, const ViewBasis& basis, const ViewPoint& point) {
  return cause.candidate.kind == CandidateKind::kPlace &&
         point.linear[index(basis.hinge(cause.candidate.effect))] != 0.0;
}

double part_at_once(const Eigen::Vector2d& step) {
  const double far = std::max(std::abs(step[0]) / kLineTurn, std::abs(step[1]) / kLineShift);
  return far > kAtOnce ? kAtOnce / far : 1.0;
}

}  // namespace

HingeLine line_of(const Candidate& hinge) {
  const Eigen::Vector2d normal(std::cos(hinge.place_heading), std::sin(hinge.place_heading));
  const Eigen::Vector2d pivot(hinge.place_x, hinge.place_y);
  return {normal, normal.dot(pivot), pivot};
}

void set_line(const HingeLine& line, Candidate& hinge) {
  hinge.place_heading = std::atan2(line.normal.y(), line.normal.x());
  hinge.place_x = line.pivot.x();
  hinge.place_y = line.pivot.y();
}

bool has_hinge(const CauseModel& model) {
  return std::any_of(model.accepted.begin(), model.accepted.end(),
                     [](const Accepted& a) { return a.candidate.kind == CandidateKind::kPlace; });
}

Eigen::MatrixXd line_columns(const ViewBasis& basis,
                             const CauseModel& model,
                             const ViewPoint& point) {
  Eigen::MatrixXd sums(index(basis.size()), 0);
  for (const Accepted& a : model.accepted) {
    if (!has_line(a, basis, point)) continue;
    const Eigen::Index first = index(basis.hinge(a.candidate.effect));
    sums.conservativeResize(Eigen::NoChange, sums.cols() + 2);
    sums.rightCols<2>().setZero();
    sums.block<2, 2>(first + 1, sums.cols() - 2).diagonal().setConstant(point.linear[first]);
  }
  return sums;
}

HingeLine line_moved(const HingeLine& line, const Eigen::Vector2d& step) {
  const double part = part_at_once(step);
  return line.moved(part * step[0], part * step[1]);
}

bool move_lines(const Eigen::VectorXd& steps,
                const ViewBasis& basis,
                const ViewPoint& point,
                CauseModel& model) {
  Eigen::Index next = 0;
  bool whole = true;
  for (Accepted& a : model.accepted) {
    if (!has_line(a, basis, point)) continue;
    const Eigen::Vector2d step = steps.segment<2>(next);
    next += 2;
    whole = whole && part_at_once(step) == 1.0;
    set_line(line_moved(line_of(a.candidate), step), a.candidate);
  }
  return whole;
}

Eigen::VectorXd line_precision(Eigen::Index lines) {
  Eigen::VectorXd precision(lines);
  for (Eigen::Index i = 0; i < lines; ++i)
    precision[i] = i % 2 == 0 ? 1.0 / (kLineTurn * kLineTurn) : 1.0 / (kLineShift * kLineShift);
  return precision;
}

ViewPrior prior_with_lines(const SizePrior& others, const CauseModel& model, Eigen::Index lines) {
  if (others.empty() && lines == 0) return {};
  const Eigen::VectorXd sizes = sizes_of(model);
  const Eigen::Index n = sizes.size();
  ViewPrior pull{Eigen::MatrixXd::Zero(n + lines, n + lines), Eigen::VectorXd::Zero(n + lines)};
  pull.information.diagonal().tail(lines) = line_precision(lines);
  if (others.empty()) return pull;
  pull.information.topLeftCorner(n, n) = others.information;
  pull.score.head(n) = others.score(sizes);
  return pull;
}

Eigen::MatrixXd marginal_information(const Eigen::MatrixXd& information, Eigen::Index sizes) {
  const Eigen::Index lines = information.rows() - sizes;
  if (lines == 0) return information;
  Eigen::MatrixXd of_lines = information.bottomRightCorner(lines, lines);
  of_lines.diagonal() += line_precision(lines);
  return information.topLeftCorner(sizes, sizes) -
         information.topRightCorner(sizes, lines) *
             of_lines.ldlt().solve(information.bottomLeftCorner(lines, sizes).eval());
}

void project_out_lines(Innovations& innovations, Eigen::Index lines) {
  if (lines == 0) return;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index sides = index(innovations.sides) - lines;
  const Eigen::Map<const Rows> all(innovations.values.data(), index(innovations.of.size()),
                                   index(innovations.sides));
  const Eigen::MatrixXd L = all.rightCols(lines);
  Eigen::MatrixXd held = L.transpose() * L;
  held.diagonal() += line_precision(lines);
  Rows left = all.leftCols(sides);
  left -= L * held.ldlt().solve(L.transpose() * left);
  innovations.sides = static_cast<std::size_t>(sides);
  innovations.values.assign(left.data(), left.data() + left.size());
}

}  // namespace roadbook
