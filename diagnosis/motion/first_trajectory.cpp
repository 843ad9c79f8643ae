#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/median.hpp"
#include "diagnosis/motion/motion_fit.hpp"
#include "diagnosis/numerics/white_scatter.hpp"
#include "diagnosis/streams/course_by_motion.hpp"
#include "diagnosis/streams/dead_reckoning.hpp"

namespace roadbook {
namespace {

// Value and slope at t of the line through the poses within half a window, least squares.
struct Local {
  double value = 0.0;
  double slope = 0.0;
};

template <typename Value>
Local local_line(const std::vector<PoseSample>& poses,
                 std::size_t begin,
                 std::size_t end,
                 double t,
                 const Value& value_of) {
  double n = 0.0, st = 0.0, stt = 0.0, sy = 0.0, sty = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const double dt = poses[i].t_s - t;
    const double y = value_of(poses[i]);
    n += 1.0;
    st += dt;
    stt += dt * dt;
    sy += y;
    sty += dt * y;
  }
  const double det = n * stt - st * st;
  if (n < 2.0 || det <= 0.0) return {n > 0.0 ? sy / n : 0.0, 0.0};
  return {(stt * sy - st * sty) / det, (n * sty - st * sy) / det};
}

// Poses without a gap between them: [begin, end).
struct PoseRun {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::vector<PoseRun> runs_of(const std::vector<PoseSample>& poses) {
  const double gap = pose_gap_s(poses);
  std::vector<PoseRun> runs{{0, 1}};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].t_s - poses[i - 1].t_s > gap) runs.push_back({i, i});
    runs.back().end = i + 1;
  }
  return runs;
}

// The motion at a moment, from lines through the poses about it.
struct PoseMoment {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
  double speed = 0.0;
  double yaw_rate = 0.0;
  double sideways = 0.0;  // speed [m/s]
};

// Lines through the poses of one run, at moments that ascend; three poses at least where the run
// has them.
class RunLines {
 public:
  RunLines(const Observations& obs, const PoseRun& run, double window_s)
      : obs_(obs), run_(run), half_(0.5 * window_s), begin_(run.begin), end_(run.begin) {}

  PoseMoment at(double t) {
    const auto& poses = obs_.poses;
    const double inside = std::clamp(t, poses[run_.begin].t_s, poses[run_.end - 1].t_s);
    while (end_ < run_.end && (poses[end_].t_s <= inside + half_ || end_ < run_.begin + 3)) ++end_;
    while (begin_ + 3 < end_ && poses[begin_].t_s < inside - half_) ++begin_;
    const auto line = [&](const auto& value) { return local_line(poses, begin_, end_, t, value); };
    const Local x = line([](const PoseSample& p) { return p.x; });
    const Local y = line([](const PoseSample& p) { return p.y; });
    const Local psi = line([](const PoseSample& p) { return p.heading; });
    PoseMoment m{x.value,   y.value,
                 psi.value, x.slope * std::cos(psi.value) + y.slope * std::sin(psi.value),
                 psi.slope, y.slope * std::cos(psi.value) - x.slope * std::sin(psi.value)};
    // One or two poses alone in a gap have no slopes worth the name.
    if (is_short()) {
      m.speed = reckoned_speed(obs_, t).value_or(m.speed);
      m.yaw_rate = reckoned_yaw_rate(obs_, t).value_or(m.yaw_rate);
    }
    return m;
  }
  [[nodiscard]] bool is_short() const { return run_.end - run_.begin < 3; }

 private:
  const Observations& obs_;
  PoseRun run_;
  double half_;
  std::size_t begin_, end_;
};

void set_knot(Trajectory& trajectory, std::size_t j, const PoseMoment& m) {
  trajectory.x[j] = m.x;
  trajectory.y[j] = m.y;
  trajectory.heading[j] = m.heading;
  trajectory.speed[j] = m.speed;
  trajectory.yaw_rate[j] = m.yaw_rate;
}

// Between two poses the path follows the other streams; their error is spread evenly. A line
// through a few poses on one side would leave the road within seconds, and Gauss-Newton would not
// come back.
class Bridge {
 public:
  Bridge(const Observations& obs,
         double from_s,
         const PoseMoment& from,
         double to_s,
         const PoseMoment& to)
      : obs_(obs), from_s_(from_s), to_s_(to_s), from_(from), to_(to) {}

  // Fills knots [first, last). `heading_known`: of the far side.
  // Returns the heading with which the far side is reached.
  double fill(Trajectory& trajectory, std::size_t first, std::size_t last, bool heading_known) {
    std::vector<double> times{from_s_};
    for (std::size_t j = first; j < last; ++j) times.push_back(trajectory.knot_s(j));
    times.push_back(to_s_);
    std::vector<double> heading{from_.heading};
    for (std::size_t i = 1; i < times.size(); ++i)
      heading.push_back(heading.back() +
                        (times[i] - times[i - 1]) * yaw_rate(0.5 * (times[i] + times[i - 1])));
    const double turn_missed = heading_known ? to_.heading - heading.back() : 0.0;
    for (std::size_t i = 1; i < times.size(); ++i) heading[i] += share(times[i]) * turn_missed;
    std::vector<double> x{from_.x}, y{from_.y};
    for (std::size_t i = 1; i < times.size(); ++i) {
      const double rolled = (times[i] - times[i - 1]) * speed(0.5 * (times[i] + times[i - 1]));
      const double psi = 0.5 * (heading[i] + heading[i - 1]);
      x.push_back(x.back() + rolled * std::cos(psi));
      y.push_back(y.back() + rolled * std::sin(psi));
    }
    const double x_missed = to_.x - x.back();
    const double y_missed = to_.y - y.back();
    for (std::size_t i = 1; i + 1 < times.size(); ++i) {
      const double t = times[i];
      set_knot(trajectory, first + i - 1,
               {x[i] + share(t) * x_missed, y[i] + share(t) * y_missed, heading[i], speed(t),
                yaw_rate(t) + turn_missed / (to_s_ - from_s_)});
    }
    return heading.back();
  }

 private:
  [[nodiscard]] double share(double t) const { return (t - from_s_) / (to_s_ - from_s_); }
  // Without another stream, evenly from side to side.
  [[nodiscard]] double speed(double t) const {
    return reckoned_speed(obs_, t).value_or(from_.speed + share(t) * (to_.speed - from_.speed));
  }
  [[nodiscard]] double yaw_rate(double t) const {
    return reckoned_yaw_rate(obs_, t).value_or(from_.yaw_rate +
                                               share(t) * (to_.yaw_rate - from_.yaw_rate));
  }

  const Observations& obs_;
  double from_s_, to_s_;
  PoseMoment from_, to_;
};

template <typename Value>
double pose_scatter(const std::vector<PoseSample>& poses, const Value& value_of) {
  std::vector<double> values;
  for (const PoseSample& pose : poses) values.push_back(value_of(pose));
  return white_scatter(values);
}

// Lines through the poses, from which speed and turn rate are taken.
struct PoseLines {
  double window_s = 0.6;   // length of the lines
  double scatter_m = 0.0;  // of a position
  bool too_rough = false;  // longer lines than a car drives straight would be needed
};

// Where poses scatter by decimetres, lines over 0.6 s give no speed and no turn rate. The fit of a
// slow car does not converge from such a start.
PoseLines lines_of(const std::vector<PoseSample>& poses) {
  constexpr double kSpeedWanted = 0.05;  // [m/s]
  constexpr double kTurnWanted = 0.02;   // [rad/s]
  constexpr double kShort = 0.6;         // [s]
  constexpr double kLong = 1.5;          // [s]; within it a car begins and ends to turn
  if (poses.size() < 2) return {};
  std::vector<double> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) steps.push_back(poses[i].t_s - poses[i - 1].t_s);
  const double step = median(std::move(steps));
  const double x = pose_scatter(poses, [](const PoseSample& p) { return p.x; });
  const double y = pose_scatter(poses, [](const PoseSample& p) { return p.y; });
  const double psi = pose_scatter(poses, [](const PoseSample& p) { return p.heading; });
  // Variance of a line's slope: 12 step / window^3 times that of a value.
  const double share = std::max({x / kSpeedWanted, y / kSpeedWanted, psi / kTurnWanted});
  const double wanted = std::cbrt(12.0 * step * share * share);
  const double of_positions = std::max(x, y) / kSpeedWanted;
  return {std::clamp(wanted, kShort, kLong), std::max(x, y),
          std::cbrt(12.0 * step * of_positions * of_positions) > kLong};
}

// Scatter of the speed at which the lines slide sideways [m/s]. Wheels roll forwards: but for what
// grows with speed and turn rate (a turned or shifted reference point), this is error of the poses,
// also of errors that last and so hide in the scatter from pose to pose.
double sideways_scatter(const Observations& obs,
                        const std::vector<PoseRun>& runs,
                        double window_s) {
  std::vector<Eigen::Vector3d> rows;  // speed, turn rate, sideways speed
  for (const PoseRun& run : runs) {
    RunLines lines(obs, run, window_s);
    if (lines.is_short()) continue;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const double t = obs.poses[i].t_s;
      if (t < obs.poses[run.begin].t_s + 0.5 * window_s ||
          t > obs.poses[run.end - 1].t_s - 0.5 * window_s)
        continue;
      const PoseMoment m = lines.at(t);
      rows.emplace_back(m.speed, m.yaw_rate, m.sideways);
    }
  }
  if (rows.size() < 20) return 0.0;
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& row : rows) products += row * row.transpose();
  const Eigen::Matrix2d A = products.topLeftCorner<2, 2>() + 1e-9 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d b = products.topRightCorner<2, 1>();
  const double left = products(2, 2) - b.dot(A.ldlt().solve(b));
  return std::sqrt(std::max(left, 0.0) / static_cast<double>(rows.size()));
}

// Knots over the stamps of the poses; delayed streams begin and end earlier.
Trajectory around_poses(const Observations& obs, double late_s) {
  const double from = obs.poses.front().t_s + std::min(0.0, late_s) - 2.0 * obs.step_s;
  const double to = obs.poses.back().t_s + std::max(0.0, late_s) + 2.0 * obs.step_s;
  const auto knots = static_cast<std::size_t>(std::ceil((to - from) / obs.step_s)) + 1;
  return {from, obs.step_s, std::max<std::size_t>(knots, 3)};
}

}  // namespace

Trajectory trajectory_of_poses(const Observations& obs, double late_s) {
  const PoseLines pose_lines = lines_of(obs.poses);
  // Without measured headings, the scatter of such poses hides the course.
  double rough_m = !obs.poses_have_heading && pose_lines.too_rough ? pose_lines.scatter_m : 0.0;
  if (obs.poses_have_heading) {
    constexpr double kMostSideways = 0.1;  // [m/s]
    const double sideways = sideways_scatter(obs, runs_of(obs.poses), pose_lines.window_s);
    if (sideways > kMostSideways) rough_m = 3.0 * sideways * pose_lines.window_s;
  }
  if (rough_m <= 0.0) return trajectory_of_lines(obs, late_s);
  Trajectory trajectory = around_poses(obs, late_s);
  if (!lay_way_on_positions(obs, rough_m, trajectory)) return trajectory_of_lines(obs, late_s);
  trajectory.integrate();
  trajectory.begin_at(trajectory.knot_s(0) - late_s);
  return trajectory;
}

Trajectory trajectory_of_lines(const Observations& obs, double late_s) {
  const double window_s = lines_of(obs.poses).window_s;
  Trajectory trajectory = around_poses(obs, late_s);
  const std::vector<PoseRun> runs = runs_of(obs.poses);
  std::size_t j = 0;
  double left_s = 0.0;
  PoseMoment left;  // the last of the run before
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double begin_s = obs.poses[runs[r].begin].t_s;
    const double end_s = obs.poses[runs[r].end - 1].t_s;
    RunLines lines(obs, runs[r], window_s);
    double turned_more = 0.0;
    if (r > 0) {
      const PoseMoment reached = lines.at(begin_s);
      const bool known = obs.poses_have_heading || !lines.is_short();
      std::size_t last = j;
      while (last < trajectory.knots() && trajectory.knot_s(last) < begin_s) ++last;
      const double heading =
          Bridge(obs, left_s, left, begin_s, reached).fill(trajectory, j, last, known);
      if (!known) turned_more = heading - reached.heading;
      j = last;
    }
    const auto at = [&](double t) {
      PoseMoment m = lines.at(t);
      m.heading += turned_more;
      return m;
    };
    const bool is_last = r + 1 == runs.size();
    for (; j < trajectory.knots() && (is_last || trajectory.knot_s(j) <= end_s); ++j)
      set_knot(trajectory, j, at(trajectory.knot_s(j)));
    left_s = end_s;
    left = at(end_s);
  }
  trajectory.integrate();
  trajectory.begin_at(trajectory.knot_s(0) - late_s);
  return trajectory;
}

}  // namespace roadbook
