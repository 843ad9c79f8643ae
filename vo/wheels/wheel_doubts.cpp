#include "vo/wheels/wheel_doubts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/se3.hpp"
#include "vo/wheels/wheel_tolerance.hpp"

namespace roadbook {
namespace {

constexpr std::array<std::size_t, 3> kWindows{1, 4, 16};  // keyframes

// Motion over some keyframes: forwards [m] and turn [rad], by the cameras and by the wheels.
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
  double way = 0.0;
  double turn = 0.0;
  double wheel_way = 0.0;
  double wheel_turn = 0.0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the wheels
  double scale = 1.0;  // cameras' length over wheels' length hereabouts

  [[nodiscard]] double turn_gap() const {
    return std::remainder(wheel_turn - turn, 2.0 * std::numbers::pi);
  }
  [[nodiscard]] double way_gap() const { return wheel_way - way / scale; }
  [[nodiscard]] bool doubts_turn() const {
    const double usual = kOfTurn * turn;
    return std::abs(turn_gap()) >
           kWheelSigmas *
               std::sqrt(covariance(2, 2) + kLeastTurn_rad * kLeastTurn_rad + usual * usual);
  }
  [[nodiscard]] bool doubts_way() const {
    const double usual = kOfWay * way / scale;
    return std::abs(way_gap()) >
           kWheelSigmas * std::sqrt(covariance.topLeftCorner<2, 2>().trace() +
                                    kLeastWay_m * kLeastWay_m + usual * usual);
  }
  // Far more or less than any scale of the cameras explains, or the other way.
  [[nodiscard]] bool doubts_way_at_any_scale() const {
    constexpr double kMost = 3.0;
    const double usual = kWheelSigmas * kLeastWay_m;
    return doubts_way() &&
           (way * wheel_way < 0.0 || std::abs(way) > kMost * std::abs(wheel_way) + usual ||
            std::abs(wheel_way) > kMost * std::abs(way) + usual);
  }
};

// Keyframes whose poses have the scale of the wheels: five motions or more since the last gap used
// them.
std::vector<std::uint8_t> scaled_by_wheels(const VoResult& odometry) {
  constexpr int kFewest = 5;
  std::vector<std::uint8_t> scaled;
  int motions = 0;
  for (const VoKeyframe& keyframe : odometry.keyframes) {
    if (keyframe.after_gap) motions = 0;
    motions += keyframe.wheels && keyframe.inliers >= kFewestInliers ? 1 : 0;
    scaled.push_back(motions >= kFewest ? 1 : 0);
  }
  return scaled;
}

double signed_length(double x, double y) { return std::copysign(std::hypot(x, y), x); }

// Of readings that are rounded to ticks (uniform: variance 1 / 12), at both ends of a window.
Eigen::Matrix3d tick_covariance(const WheelModel& model) {
  if (!(model.ticks_per_turn > 0.0)) return Eigen::Matrix3d::Zero();
  const double tick_m = 2.0 * std::numbers::pi / model.ticks_per_turn * model.radius_left_m;
  const double way = tick_m * tick_m / 12.0;  // mean of two wheels, two ends
  const double turn = tick_m * tick_m / 3.0 / (model.track_width_m * model.track_width_m);
  return Eigen::Vector3d(way, 0.0, turn).asDiagonal();
}

std::vector<Window> windows_of(const VoResult& odometry,
                               const WheelOdometry& wheels,
                               std::size_t length) {
  const auto& keyframes = odometry.keyframes;
  std::vector<Window> windows;
  std::size_t known_from = 0;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    if (keyframes[k].after_gap || keyframes[k].inliers < kFewestInliers) known_from = k;
    if (k < known_from + length) continue;
    const std::size_t first = k - length;
    const auto moved = wheels.between(keyframes[first].t_ns, keyframes[k].t_ns);
    if (!moved) continue;
    const Eigen::Isometry3d T =
        keyframes[first].T_odom_vehicle.inverse() * keyframes[k].T_odom_vehicle;
    Window w;
    w.first = first;
    w.last = k;
    w.way = signed_length(T.translation().x(), T.translation().y());
    w.turn = heading_of(T);
    w.wheel_way = signed_length(moved->motion.x(), moved->motion.y());
    w.wheel_turn = moved->motion.z();
    w.covariance = moved->covariance + tick_covariance(wheels.model());
    windows.push_back(w);
  }
  return windows;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Cameras' length over wheels' length where both move and turn equally, near each of `windows`.
// The cameras' scale drifts slowly. Far from good windows, and without any, all of them tell it.
void set_scales(const std::vector<Window>& typical, std::vector<Window>& windows) {
  constexpr std::size_t kReach = 30;  // keyframes
  constexpr std::size_t kFewest = 8;
  std::vector<Window> good;
  std::vector<double> all;
  for (const Window& w : typical) {
    if (std::abs(w.wheel_way) < 0.05 || w.doubts_turn()) continue;
    good.push_back(w);
    all.push_back(w.way / w.wheel_way);
  }
  if (all.empty())
    for (const Window& w : typical)
      if (std::abs(w.wheel_way) > 0.05) all.push_back(std::abs(w.way / w.wheel_way));
  if (all.empty()) return;
  const double overall = median(all);
  auto begin = good.begin();
  for (Window& w : windows) {
    while (begin != good.end() && begin->first + kReach < w.first) ++begin;
    std::vector<double> near;
    for (auto it = begin; it != good.end() && it->first <= w.first + kReach; ++it)
      near.push_back(it->way / it->wheel_way);
    const double scale = near.size() >= kFewest ? median(std::move(near)) : overall;
    w.scale = std::abs(scale) > 1e-3 ? scale : 1.0;
  }
}

// Doubted times of all windows. A long window that holds a doubted shorter one says nothing more.
std::vector<TimeSpan> doubted_spans(const VoResult& sight,
                                    const std::array<std::vector<Window>, kWindows.size()>& all) {
  std::vector<std::uint8_t> doubted(sight.keyframes.size(), 0);  // motion from the one before
  for (const auto& windows : all) {
    const std::vector<std::uint8_t> shorter = doubted;
    for (const Window& w : windows) {
      if (!w.doubts_turn() && !w.doubts_way()) continue;
      const auto from = static_cast<std::ptrdiff_t>(w.first) + 1;
      const auto to = static_cast<std::ptrdiff_t>(w.last) + 1;
      if (std::any_of(shorter.begin() + from, shorter.begin() + to, [](auto d) { return d != 0; }))
        continue;
      std::fill(doubted.begin() + from, doubted.begin() + to, std::uint8_t{1});
    }
  }
  std::vector<TimeSpan> spans;
  for (std::size_t k = 1; k < doubted.size(); ++k)
    if (doubted[k] != 0) add_span(spans, sight.keyframes[k - 1].t_ns, sight.keyframes[k].t_ns);
  return spans;
}

// Sizes of the doubts, and their share of the drive, by the shortest windows.
void measure(const VoResult& sight, const std::vector<Window>& windows, WheelComparison& result) {
  auto doubt = result.doubts.begin();
  for (const Window& w : windows) {
    const std::int64_t middle = (sight.keyframes[w.first].t_ns + sight.keyframes[w.last].t_ns) / 2;
    while (doubt != result.doubts.end() && doubt->span.second < middle) ++doubt;
    result.compared_m += std::abs(w.way / w.scale);
    result.compared_rad += std::abs(w.turn);
    if (doubt == result.doubts.end() || middle < doubt->span.first) continue;
    doubt->turn_rad += w.turn_gap();
    doubt->way_m += w.way_gap();
    result.doubted_m += std::abs(w.way / w.scale);
    result.doubted_rad += std::abs(w.turn);
  }
}

std::optional<double> median_turn_factor(const std::vector<Window>& windows) {
  constexpr double kTurns_rad = 0.05;
  constexpr std::size_t kFewest = 10;
  std::vector<double> factors;
  for (const Window& w : windows)
    if (std::abs(w.turn) > kTurns_rad) factors.push_back(w.wheel_turn / w.turn);
  if (factors.size() < kFewest) return std::nullopt;
  return median(std::move(factors));
}

std::optional<double> median_way_ratio(const std::vector<Window>& windows) {
  constexpr double kMoves_m = 0.1;
  constexpr std::size_t kFewest = 10;
  std::vector<double> factors;
  for (const Window& w : windows)
    if (std::abs(w.way) > kMoves_m) factors.push_back(w.wheel_way / w.way);
  if (factors.size() < kFewest) return std::nullopt;
  return median(std::move(factors));
}

}  // namespace

bool WheelComparison::doubts_all() const {
  constexpr double kWayShare = 0.25;
  constexpr double kTurnShare = 0.4;
  constexpr double kWrongScale = 0.18;  // as a logarithm
  if (way_factor && !(*way_factor > 0.0 && std::abs(std::log(*way_factor)) < kWrongScale))
    return true;
  return doubted_m > kWayShare * compared_m || doubted_rad > kTurnShare * compared_rad;
}

bool WheelComparison::rest_is_useful() const {
  constexpr double kWayShare = 0.3;
  constexpr double kTurnShare = 0.3;
  constexpr double kFewTurns_rad = 0.3;  // a drive so straight that turns say nothing
  return compared_m - doubted_m >= kWayShare * compared_m &&
         (compared_rad < kFewTurns_rad || compared_rad - doubted_rad >= kTurnShare * compared_rad);
}

double known_share(const VoResult& sight,
                   const WheelOdometry& wheels,
                   const std::vector<std::int64_t>& frames_ns) {
  constexpr double kRolls_m_s = 0.1;
  const auto& keyframes = sight.keyframes;
  std::size_t k = 0;  // first keyframe after the middle of the frames
  double moves_s = 0.0;
  double known_s = 0.0;
  for (std::size_t i = 1; i < frames_ns.size(); ++i) {
    const auto moved = wheels.between(frames_ns[i - 1], frames_ns[i]);
    const double dt = static_cast<double>(frames_ns[i] - frames_ns[i - 1]) * 1e-9;
    const std::int64_t middle = frames_ns[i - 1] + (frames_ns[i] - frames_ns[i - 1]) / 2;
    while (k < keyframes.size() && keyframes[k].t_ns < middle) ++k;
    const bool known = k > 0 && k < keyframes.size() && !keyframes[k].after_gap &&
                       keyframes[k].inliers >= kFewestInliers;
    const bool rolls = moved && moved->motion.head<2>().norm() >= kRolls_m_s * dt;
    if (known || rolls) moves_s += dt;
    if (known) known_s += dt;
  }
  return moves_s > 0.0 ? known_s / moves_s : 1.0;
}

WheelComparison compare_wheels(const VoResult& sight,
                               const WheelOdometry& wheels,
                               std::optional<double> ground) {
  std::array<std::vector<Window>, kWindows.size()> all;
  for (std::size_t i = 0; i < kWindows.size(); ++i) all[i] = windows_of(sight, wheels, kWindows[i]);
  const std::vector<Window> typical = all[1];
  for (auto& windows : all) set_scales(typical, windows);
  WheelComparison result;
  for (const TimeSpan& span : doubted_spans(sight, all)) result.doubts.push_back({span});
  measure(sight, all[0], result);
  result.turn_factor = median_turn_factor(all[1]);
  result.way_ratio = median_way_ratio(all[1]);
  if (result.way_ratio && ground) result.way_factor = *result.way_ratio / *ground;
  return result;
}

std::vector<SpanVerdict> judge_spans(const std::vector<TimeSpan>& spans,
                                     const VoResult& odometry,
                                     const WheelOdometry& recorded) {
  const auto& keyframes = odometry.keyframes;
  const auto overlap = [&](std::size_t first, std::size_t last, const TimeSpan& span) {
    return keyframes[first].t_ns < span.second && span.first < keyframes[last].t_ns;
  };
  std::vector<SpanVerdict> verdicts;
  for (const TimeSpan& span : spans) {
    std::int64_t known_ns = 0;
    std::int64_t all_ns = 0;
    for (std::size_t k = 1; k < keyframes.size(); ++k) {
      if (!overlap(k - 1, k, span)) continue;
      const std::int64_t ns = keyframes[k].t_ns - keyframes[k - 1].t_ns;
      all_ns += ns;
      if (!keyframes[k].after_gap && keyframes[k].inliers >= kFewestInliers) known_ns += ns;
    }
    const SpanVerdict verdict{span, 5 * known_ns >= 4 * all_ns, false};
    verdicts.push_back(verdict);
  }
  const auto has_scale = scaled_by_wheels(odometry);
  for (const std::size_t length : kWindows)
    for (const Window& w : windows_of(odometry, recorded, length)) {
      const bool doubts_way = has_scale[w.last] != 0 ? w.doubts_way() : w.doubts_way_at_any_scale();
      if (!w.doubts_turn() && !doubts_way) continue;
      for (SpanVerdict& verdict : verdicts)
        if (overlap(w.first, w.last, verdict.span)) verdict.is_doubted = true;
    }
  return verdicts;
}

WheelComparison compare_wheels_in(const std::vector<TimeSpan>& spans,
                                  const VoResult& odometry,
                                  const WheelOdometry& recorded) {
  WheelComparison result;
  for (const TimeSpan& span : spans) result.doubts.push_back({span});
  measure(odometry, windows_of(odometry, recorded, 1), result);
  return result;
}

}  // namespace roadbook
