#include "diagnosis/hinge_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kKeptLines = 3;
constexpr double kOneBend = 0.5;      // cosine of columns that show one bend, the line a little off
constexpr double kWorthALine = 16.0;  // chi-squared below which a line is chance among so many

// Height, roll and pitch of each motion, whitened: what is left, or what a line does to them.
using Shape = Eigen::VectorXd;

Shape residual_shape(const HingeSearch& fit, const ViewSystem& flat) {
  const ViewChannels channels{fit.data.bundle.cameras.size()};
  const ViewSides sides = flat.sides(
      Eigen::MatrixXd(static_cast<Eigen::Index>(ViewBasis{channels.cameras, {}}.size()), 0));
  std::vector<double> left;
  flat.each_pose(sides, [&](std::size_t k, const ViewPanel& values) {
    const auto& info = flat.row_info(k);
    for (std::size_t i = 0; i < info.size(); ++i)
      if (info[i].channel >= channels.motion(2) && info[i].channel <= channels.motion(4))
        left.push_back(values(static_cast<Eigen::Index>(i), 0));
  });
  return Eigen::Map<const Shape>(left.data(), static_cast<Eigen::Index>(left.size()));
}

Shape line_shape(const HingeSearch& fit, const HingeLine& line) {
  const auto& motions = fit.data.bundle.motions;
  const auto& poses = fit.point.state.poses;
  // A car that stands on one side alone moves as on flat ground.
  const double near_m = fit.data.wheels.wheelbase_m + fit.data.wheels.track_width_m;
  Shape shape = Shape::Zero(3 * static_cast<Eigen::Index>(motions.size()));
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const auto& motion = motions[m];
    const auto& T_from = poses[at(motion.from)];
    if (std::abs(line.normal.dot(T_from.translation().head<2>()) - line.offset_m) > near_m)
      continue;
    const auto stand = [&](const Eigen::Isometry3d& T) {
      return stand_on_hinge(line, T, fit.data.wheels).perturbation();
    };
    const Vector6d change =
        se3_adjoint(motion.T_from_to.inverse()) * stand(T_from) - stand(poses[at(motion.to)]);
    for (Eigen::Index axis = 2; axis < 5; ++axis)
      shape[3 * static_cast<Eigen::Index>(m) + axis - 2] =
          change[axis] * std::sqrt(motion.information(axis, axis)) /
          fit.noise.motion[static_cast<std::size_t>(axis)];
  }
  return shape;
}

double chi2_of(const Shape& shape, const Shape& left) {
  const double squares = shape.squaredNorm();
  const double u = shape.dot(left);
  return squares > 0.0 ? u * u / squares : 0.0;
}

// Turns and shifts the line by ever smaller steps for as long as that explains more.
HingeLine refined(const HingeSearch& fit, const Shape& left, HingeLine line) {
  double best = chi2_of(line_shape(fit, line), left);
  // About the driven place's middle, so that a turn does not shift the line away.
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& T : fit.point.state.poses)
    middle += T.translation().head<2>() / static_cast<double>(fit.point.state.poses.size());
  double turn = 0.5 * std::numbers::pi / kHingeAngles;
  double shift = 0.5;
  for (int round = 0; round < 6; ++round, turn *= 0.5, shift *= 0.5)
    for (const auto& [angle, move] :
         {std::pair(turn, 0.0), {-turn, 0.0}, {0.0, shift}, {0.0, -shift}}) {
      HingeLine other = line;
      other.normal = Eigen::Rotation2Dd(angle) * line.normal;
      other.offset_m = line.offset_m + (other.normal - line.normal).dot(middle) + move;
      const double chi2 = chi2_of(line_shape(fit, other), left);
      if (chi2 <= best) continue;
      best = chi2;
      line = other;
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
  for (std::size_t a = 0; a < kHingeAngles; ++a) {
    const double angle = std::numbers::pi * static_cast<double>(a) / kHingeAngles;
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    for (std::size_t o = 0; o < kHingeOffsets; ++o)
      lines.push_back(
          {normal, normal.dot(middle) +
                       reach * (2.0 * (static_cast<double>(o) + 0.5) / kHingeOffsets - 1.0)});
  }
  return lines;
}

}  // namespace

std::vector<HingeLine> likely_hinges(const HingeSearch& fit, const ViewSystem& flat) {
  const Shape left = residual_shape(fit, flat);
  struct Scored {
    double chi2;
    std::size_t line;
  };
  const std::vector<HingeLine> lines = all_lines(fit);
  std::vector<double> chi2(lines.size());
  parallel_for_small(lines.size(), flat.num_threads(),
                     [&](std::size_t l) { chi2[l] = chi2_of(line_shape(fit, lines[l]), left); });
  std::vector<Scored> scored;
  for (std::size_t l = 0; l < lines.size(); ++l)
    if (chi2[l] > kWorthALine) scored.push_back({chi2[l], l});
  std::stable_sort(scored.begin(), scored.end(),
                   [](const Scored& a, const Scored& b) { return a.chi2 > b.chi2; });
  std::vector<HingeLine> kept;
  std::vector<Shape> shapes;
  for (const Scored& s : scored) {
    if (kept.size() == kKeptLines) break;
    const HingeLine line = refined(fit, left, lines[s.line]);
    Shape shape = line_shape(fit, line).normalized();
    const bool known = std::any_of(shapes.begin(), shapes.end(), [&](const Shape& other) {
      return std::abs(other.dot(shape)) > kOneBend;
    });
    if (known) continue;
    kept.push_back(line);
    shapes.push_back(std::move(shape));
  }
  return kept;
}

std::string hinge_note(const HingeLine& line) {
  const Eigen::Vector2d foot = line.offset_m * line.normal;
  const double angle = std::atan2(line.normal.x(), -line.normal.y()) * 180.0 / std::numbers::pi;
  char text[120];
  std::snprintf(text, sizeof text,
                "the ground bends in the line through x = %.1f m, y = %.1f m at %.0f degrees",
                foot.x(), foot.y(), angle);
  return text;
}

}  // namespace roadbook
