#include "diagnosis/views/hinge_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "diagnosis/views/hinge_lines.hpp"
#include "diagnosis/views/view_system.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kLineAngles = 45;    // 4 degrees between neighbours
constexpr std::size_t kLineOffsets = 100;  // spread over the driven area
static_assert(kLineAngles * kLineOffsets == kHingeLines);

constexpr std::size_t kStarts = 24;     // lines of the grid that are refined
constexpr std::size_t kTriedLines = 4;  // lines scored against all rows
constexpr std::size_t kKeptLines = 3;
// Lines whose columns have a larger cosine count as the same line (in the grid) and as the same
// hinge (after refinement).
constexpr double kOneLine = 0.8;
constexpr double kOneBend = 0.5;
constexpr double kWorthALine = 16.0;  // below this chi-squared a line is random

// The fit whose residuals the search explains.
struct HingeSearch {
  const ViewData& data;
  const ViewNoise& noise;
  const ViewPoint& point;
};

// Whitened height, roll and pitch of all motions, one after another: residuals, or the change by a
// hinge of 1 rad.
using Shape = Eigen::VectorXd;

Shape residual_shape(const ViewChannels& channels, const ViewSystem& flat, std::size_t columns) {
  std::vector<double> left;
  flat.each_pose(
      flat.sides(Eigen::MatrixXd(index(columns), 0)), [&](std::size_t k, const ViewPanel& values) {
        const auto& info = flat.row_info(k);
        for (std::size_t i = 0; i < info.size(); ++i)
          if (info[i].channel >= channels.motion(2) && info[i].channel <= channels.motion(4))
            left.push_back(values(index(i), 0));
      });
  return Eigen::Map<const Shape>(left.data(), index(left.size()));
}

// A hinge changes a motion only while the car stands on the line.
bool is_near(const HingeSearch& fit, const HingeLine& line, const MotionConstraint& motion) {
  const auto& p = fit.point.state.poses[at(motion.from)].translation();
  return std::abs(line.distance(p.head<2>())) <=
         fit.data.wheels.wheelbase_m + fit.data.wheels.track_width_m;
}

Shape line_shape(const HingeSearch& fit, const HingeLine& line) {
  const auto& motions = fit.data.bundle.motions;
  const auto& poses = fit.point.state.poses;
  Shape shape = Shape::Zero(3 * index(motions.size()));
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const auto& motion = motions[m];
    if (!is_near(fit, line, motion)) continue;
    const auto stand = [&](int pose) {
      return pose_on_hinge(line, poses[at(pose)], fit.data.wheels).perturbation();
    };
    const Vector6d change =
        se3_adjoint(motion.T_from_to.inverse()) * stand(motion.from) - stand(motion.to);
    for (Eigen::Index axis = 2; axis < 5; ++axis)
      shape[3 * index(m) + axis - 2] = change[axis] * std::sqrt(motion.information(axis, axis)) /
                                       fit.noise.motion[at(static_cast<int>(axis))];
  }
  return shape;
}

double chi2_of(const Shape& shape, const Shape& left) {
  const double squares = shape.squaredNorm();
  const double u = shape.dot(left);
  return squares > 0.0 ? u * u / squares : 0.0;
}

// Places where the car crosses or touches the line: for each visit the position nearest to the
// line.
std::vector<Eigen::Vector2d> crossings(const HingeSearch& fit, const HingeLine& line) {
  std::vector<Eigen::Vector2d> places;
  bool near = false;
  for (const MotionConstraint& motion : fit.data.bundle.motions) {
    const Eigen::Vector2d p = fit.point.state.poses[at(motion.from)].translation().head<2>();
    const bool was_near = std::exchange(near, is_near(fit, line, motion));
    if (near && !was_near)
      places.push_back(p);
    else if (near && std::abs(line.distance(p)) < std::abs(line.distance(places.back())))
      places.back() = p;
  }
  return places;
}

// The mean of the crossings, projected onto the line.
Eigen::Vector2d pivot_of(const HingeSearch& fit, const HingeLine& line) {
  const std::vector<Eigen::Vector2d> places = crossings(fit, line);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : places) mean += p / static_cast<double>(places.size());
  return mean - line.distance(mean) * line.normal;
}

// Pattern search over turns and shifts with halved steps. Turns are tried about each crossing: a
// turn about another place would move the line away from where the car crosses it.
HingeLine refined(const HingeSearch& fit, const Shape& left, HingeLine line) {
  constexpr int kRounds = 7;
  constexpr int kMost = 8;  // steps of one size
  double best = chi2_of(line_shape(fit, line), left);
  double turn = std::numbers::pi / kLineAngles;
  double shift = 1.0;  // [m]
  for (int round = 0; round < kRounds; ++round, turn *= 0.5, shift *= 0.5)
    for (int i = 0, better = 1; better > 0 && i < kMost; ++i) {
      better = 0;
      std::vector<HingeLine> others{line.moved(0.0, shift, {0.0, 0.0}),
                                    line.moved(0.0, -shift, {0.0, 0.0})};
      for (const Eigen::Vector2d& place : crossings(fit, line))
        for (const double angle : {turn, -turn}) others.push_back(line.moved(angle, 0.0, place));
      for (const HingeLine& other : others) {
        const double chi2 = chi2_of(line_shape(fit, other), left);
        if (chi2 <= best) continue;
        best = chi2;
        line = other;
        ++better;
      }
    }
  return line;
}

std::vector<HingeLine> all_lines(const HingeSearch& fit) {
  Eigen::Vector2d low(1e300, 1e300);
  Eigen::Vector2d high = -low;
  for (const auto& T : fit.point.state.poses) {
    low = low.cwiseMin(T.translation().head<2>());
    high = high.cwiseMax(T.translation().head<2>());
  }
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const double reach = 0.5 * (high - low).norm() + 1.0;
  std::vector<HingeLine> lines;
  for (std::size_t a = 0; a < kLineAngles; ++a) {
    const double angle = std::numbers::pi * static_cast<double>(a) / kLineAngles;
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    for (std::size_t o = 0; o < kLineOffsets; ++o)
      lines.push_back(
          {normal, normal.dot(middle) +
                       reach * (2.0 * (static_cast<double>(o) + 0.5) / kLineOffsets - 1.0)});
  }
  return lines;
}

struct ScoredLine {
  double chi2;
  HingeLine line;
};

void best_first(std::vector<ScoredLine>& lines) {
  std::stable_sort(lines.begin(), lines.end(),
                   [](const ScoredLine& a, const ScoredLine& b) { return a.chi2 > b.chi2; });
}

// The first `most` lines such that no two have columns with a cosine above `alike`.
std::vector<HingeLine> distinct(const HingeSearch& fit,
                                const std::vector<ScoredLine>& scored,
                                std::size_t most,
                                double alike) {
  std::vector<HingeLine> kept;
  std::vector<Shape> shapes;
  for (const ScoredLine& s : scored) {
    if (kept.size() == most) break;
    const Shape shape = line_shape(fit, s.line).normalized();
    const bool known = std::any_of(shapes.begin(), shapes.end(), [&](const Shape& other) {
      return std::abs(other.dot(shape)) > alike;
    });
    if (known) continue;
    kept.push_back(s.line);
    shapes.push_back(shape);
  }
  return kept;
}

// Scores lines by height, roll and pitch of the motions alone, as if no other unknown could absorb
// them. The peak of the score is narrower than the grid, so many lines are refined before the best
// are chosen.
std::vector<HingeLine> likely_lines(const HingeSearch& fit, const Shape& left, int num_threads) {
  const auto scored = [&](const std::vector<HingeLine>& lines, const auto& better) {
    std::vector<ScoredLine> all(lines.size());
    parallel_for_small(lines.size(), num_threads, [&](std::size_t l) {
      const HingeLine line = better(lines[l]);
      all[l] = {chi2_of(line_shape(fit, line), left), line};
    });
    std::erase_if(all, [](const ScoredLine& s) { return s.chi2 <= kWorthALine; });
    best_first(all);
    return all;
  };
  const auto of_grid = scored(all_lines(fit), [](const HingeLine& line) { return line; });
  const auto of_starts = scored(distinct(fit, of_grid, kStarts, kOneLine),
                                [&](const HingeLine& line) { return refined(fit, left, line); });
  std::vector<HingeLine> likely = distinct(fit, of_starts, kTriedLines, kOneBend);
  for (HingeLine& line : likely) line.pivot = pivot_of(fit, line);
  return likely;
}

// Inner products of the residual and all hinge columns, with poses and landmarks projected out.
Eigen::MatrixXd hinge_products(const HingeSearch& fit, ViewSystem& system, const ViewBasis& basis) {
  const Eigen::Index columns = index(basis.hinges * kHingeColumns);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(index(basis.size()), columns);
  sums.middleRows(index(basis.hinge()), columns).setIdentity();
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(1 + columns, 1 + columns);
  if (!system.linearise(fit.point, fit.noise, &sums)) return G;
  system.each_pose(system.sides(sums), [&](std::size_t, const ViewPanel& values) {
    G.noalias() += values.transpose() * values;
  });
  return G;
}

// Gauss-Newton step for size and line of hinge h. Returns the moved line and the chi-squared that
// the step explains.
ScoredLine stepped(const HingeSearch& fit, const Eigen::MatrixXd& G, std::size_t h) {
  const HingeLine& line = fit.point.hinges[h];
  const Eigen::Index first = 1 + index(h * kHingeColumns);
  const Eigen::Vector3d u = G.block<3, 1>(first, 0);
  Eigen::Matrix3d F = G.block<3, 3>(first, first);
  if (!(F(0, 0) > 0.0) || u[0] == 0.0) return {0.0, line};
  const double size = u[0] / F(0, 0);
  F.diagonal().tail<2>() += line_precision(2) / (size * size);
  const Eigen::Vector3d step = F.ldlt().solve(u);
  if (step[0] == 0.0) return {0.0, line};
  return {u.dot(step), line_moved(line, step.tail<2>() / step[0])};
}

}  // namespace

void find_hinge_lines(const ViewData& data,
                      const ViewNoise& noise,
                      int num_threads,
                      ViewBasis& basis,
                      ViewPoint& point) {
  const HingeSearch fit{data, noise, point};
  const auto become = [&](std::vector<HingeLine> lines) {
    point.hinges = std::move(lines);
    basis.hinges = point.hinges.size();
    point.linear = Eigen::VectorXd::Zero(index(basis.size()));
  };
  become({});
  ViewSystem system(data, basis, num_threads);
  const Eigen::MatrixXd none(index(basis.size()), 0);
  if (!system.linearise(point, noise, &none)) return;
  const ViewChannels channels{data.bundle.cameras.size()};
  become(likely_lines(fit, residual_shape(channels, system, basis.size()), num_threads));
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds && basis.hinges > 0; ++round) {
    const Eigen::MatrixXd G = hinge_products(fit, system, basis);
    std::vector<ScoredLine> scored;
    for (std::size_t h = 0; h < basis.hinges; ++h) scored.push_back(stepped(fit, G, h));
    best_first(scored);
    become(distinct(fit, scored, kKeptLines, kOneBend));
  }
}

std::string hinge_note(const HingeLine& line) {
  const Eigen::Vector2d foot = line.offset_m * line.normal;
  const double angle = std::atan2(line.normal.x(), -line.normal.y()) * 180.0 / std::numbers::pi;
  char text[160];
  std::snprintf(text, sizeof text,
                "the slope of the ground changes along the line through x = %.1f m, y = %.1f m at "
                "%.0f degrees",
                foot.x(), foot.y(), angle);
  return text;
}

}  // namespace roadbook
