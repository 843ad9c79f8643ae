#include "diagnosis/streams/course_by_motion.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "diagnosis/streams/dead_reckoning.hpp"

namespace roadbook {
namespace {

using Point = std::complex<double>;  // x + i y

constexpr double kTurnWanted = 0.02;    // [rad]
constexpr double kLongest_s = 30.0;     // to either side
constexpr double kShareReckoned = 0.9;  // of the knots must have a speed and a turn rate

struct Way {
  std::vector<Point> at;  // at the knots
  std::vector<double> heading, speed, yaw_rate;
};

// Where a stream has a gap or has not begun, the last rates hold.
bool reckon(const Observations& obs, const Trajectory& trajectory, Way& way) {
  std::size_t reckoned = 0;
  double speed = 0.0;
  double yaw_rate = 0.0;
  Point here = 0.0;
  double heading = 0.0;
  for (std::size_t j = 0; j < trajectory.knots(); ++j) {
    const auto v = reckoned_speed(obs, trajectory.knot_s(j));
    const auto w = reckoned_yaw_rate(obs, trajectory.knot_s(j));
    if (v && w) ++reckoned;
    speed = v.value_or(speed);
    yaw_rate = w.value_or(yaw_rate);
    way.at.push_back(here);
    way.heading.push_back(heading);
    way.speed.push_back(speed);
    way.yaw_rate.push_back(yaw_rate);
    const double step = trajectory.step_s();
    here += std::polar(step * speed, heading + 0.5 * step * yaw_rate);
    heading += step * yaw_rate;
  }
  return static_cast<double>(reckoned) >= kShareReckoned * static_cast<double>(trajectory.knots());
}

Point way_at(const Way& way, const Trajectory& trajectory, double t_s) {
  const double k = std::clamp((t_s - trajectory.start_s()) / trajectory.step_s(), 0.0,
                              static_cast<double>(way.at.size() - 1));
  const auto j = std::min(static_cast<std::size_t>(k), way.at.size() - 2);
  const double share = k - static_cast<double>(j);
  return (1.0 - share) * way.at[j] + share * way.at[j + 1];
}

// The turn and shift that lay reckoned points onto positions.
struct Laid {
  double turn = 0.0;
  Point of_way = 0.0;        // mean of the reckoned points
  Point of_positions = 0.0;  // mean of the positions
  double spread = 0.0;  // sum of squared distances of the reckoned points from their mean [m^2]
};

Laid lay(const std::vector<Point>& reckoned,
         const std::vector<PoseSample>& poses,
         std::size_t begin,
         std::size_t end) {
  Laid laid;
  for (std::size_t i = begin; i < end; ++i) {
    laid.of_way += reckoned[i];
    laid.of_positions += Point(poses[i].x, poses[i].y);
  }
  const auto n = static_cast<double>(end - begin);
  laid.of_way /= n;
  laid.of_positions /= n;
  Point turned = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const Point a = reckoned[i] - laid.of_way;
    turned += std::conj(a) * (Point(poses[i].x, poses[i].y) - laid.of_positions);
    laid.spread += std::norm(a);
  }
  laid.turn = std::arg(turned);
  return laid;
}

}  // namespace

bool lay_way_on_positions(const Observations& obs, double scatter_m, Trajectory& trajectory) {
  const auto& poses = obs.poses;
  Way way;
  // A single wheel rolls another way than the car's middle.
  const bool of_middle =
      obs.wheels_read == WheelsRead::kBoth || obs.wheels_read == WheelsRead::kMiddle;
  if (poses.size() < 3 || !of_middle || !reckon(obs, trajectory, way)) return false;
  std::vector<Point> reckoned;
  for (const PoseSample& pose : poses) reckoned.push_back(way_at(way, trajectory, pose.t_s));
  const double wanted = std::pow(scatter_m / kTurnWanted, 2);
  const Laid whole = lay(reckoned, poses, 0, poses.size());
  if (whole.spread < std::pow(scatter_m, 2)) return false;
  const auto pose_at = [&](double t) {
    return static_cast<std::size_t>(
        std::lower_bound(poses.begin(), poses.end(), t,
                         [](const PoseSample& p, double value) { return p.t_s < value; }) -
        poses.begin());
  };
  double last = 0.0;  // turn at the knot before, unwrapped
  for (std::size_t j = 0; j < trajectory.knots(); ++j) {
    const double t = std::clamp(trajectory.knot_s(j), poses.front().t_s, poses.back().t_s);
    Laid laid;
    for (double half = 1.0;; half *= 1.5) {
      const std::size_t begin = pose_at(t - half);
      const std::size_t end = std::max(pose_at(t + half), begin + 1);
      laid = lay(reckoned, poses, begin, std::min(end, poses.size()));
      if (end - begin >= 3 && (laid.spread >= wanted || half >= kLongest_s)) break;
      if (begin == 0 && end >= poses.size()) break;
    }
    // At rest the heading does not change.
    const double turn = laid.spread < 0.01 * wanted
                            ? last
                            : last + std::remainder(laid.turn - last, 2.0 * std::numbers::pi);
    if (j == 0 && laid.spread < 0.01 * wanted) laid.turn = whole.turn;
    last = j == 0 ? laid.turn : turn;
    const Point at = laid.of_positions + std::polar(1.0, last) * (way.at[j] - laid.of_way);
    trajectory.x[j] = at.real();
    trajectory.y[j] = at.imag();
    trajectory.heading[j] = way.heading[j] + last;
    trajectory.speed[j] = way.speed[j];
    trajectory.yaw_rate[j] = way.yaw_rate[j];
  }
  return true;
}

}  // namespace roadbook
