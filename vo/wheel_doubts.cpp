#include "vo/wheel_doubts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/se3.hpp"
#include "vo/ground_scale.hpp"

namespace roadbook {
namespace {

constexpr double kSigmas = 4.0;
constexpr std::array<std::size_t, 3> kWindows{1, 4, 16};  // keyframes
constexpr std::size_t kTypical = 1;                       // of them, for the ratio of lengths
constexpr int kFewestInliers = 20;

// Motion over a window of keyframes: forwards [m] and turn [rad].
struct Window {
  std::size_t first = 0;
  std::size_t last = 0;
  double way = 0.0;  // by the cameras
  double turn = 0.0;
  double wheel_way = 0.0;
  double wheel_turn = 0.0;
  double sigma_way = 0.0;
  double sigma_turn = 0.0;
  double scale = 1.0;  // cameras' length over wheels' length hereabouts

  [[nodiscard]] double turn_gap() const { return angle_difference(wheel_turn, turn); }
  [[nodiscard]] double way_gap() const { return wheel_way - way / scale; }
  [[nodiscard]] bool doubts_turn() const { return std::abs(turn_gap()) > kSigmas * sigma_turn; }
  [[nodiscard]] bool doubts_way() const { return std::abs(way_gap()) > kSigmas * sigma_way; }
  static double angle_difference(double a, double b) { return std::remainder(a - b, 2.0 * M_PI); }
};

double signed_length(double x, double y) { return std::copysign(std::hypot(x, y), x); }

// Honest wheels: radius and track are known to some percent, stamps to some hundredths of a second.
void set_sigmas(const PlanarMotion& wheels, double dt_s, double sight_turn, Window& w) {
  constexpr double kOfTurn = 0.04;
  constexpr double kOfWay = 0.05;
  constexpr double kLeastTurn = 0.004;
  constexpr double kLeastWay = 0.02;
  (void)dt_s;
  w.sigma_turn = std::sqrt(wheels.covariance(2, 2) + kLeastTurn * kLeastTurn +
                           std::pow(kOfTurn * sight_turn, 2));
  w.sigma_way = std::sqrt(wheels.covariance.topLeftCorner<2, 2>().trace() + kLeastWay * kLeastWay +
                          std::pow(kOfWay * w.way, 2));
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
    set_sigmas(*moved, 0.0, w.turn, w);
    windows.push_back(w);
  }
  return windows;
}

}  // namespace

WheelComparison compare_wheels(const VoResult& odometry,
                               const WheelOdometry& wheels,
                               bool knows_scale) {
  WheelComparison c;
  for (std::size_t l : kWindows) {
    auto ws = windows_of(odometry, wheels, l);
    if (!knows_scale) {
      auto t = windows_of(odometry, wheels, kWindows[kTypical]);
      for (auto& w : ws) {
        std::vector<double> r;
        for (auto& x : t)
          if (std::abs((long)x.first - (long)w.first) < 30 && std::abs(x.wheel_way) > 0.05 &&
              !x.doubts_turn())
            r.push_back(x.way / x.wheel_way);
        if (r.empty()) continue;
        std::nth_element(r.begin(), r.begin() + r.size() / 2, r.end());
        w.scale = r[r.size() / 2];
      }
    }
    int bt = 0, bw = 0;
    std::vector<double> zt, zw;
    for (auto& w : ws) {
      bt += w.doubts_turn();
      bw += w.doubts_way();
      zt.push_back(std::abs(w.turn_gap()) / w.sigma_turn);
      zw.push_back(std::abs(w.way_gap()) / w.sigma_way);
    }
    std::sort(zt.begin(), zt.end());
    std::sort(zw.begin(), zw.end());
    if (ws.size())
      std::fprintf(stderr,
                   "DBG L%zu n %zu bad turn %d way %d  zt med %.2f p95 %.2f max %.2f  zw med %.2f "
                   "p95 %.2f max %.2f\n",
                   l, ws.size(), bt, bw, zt[zt.size() / 2], zt[zt.size() * 95 / 100], zt.back(),
                   zw[zw.size() / 2], zw[zw.size() * 95 / 100], zw.back());
  }
  return c;
}

std::optional<double> ground_factor(const VoResult& odometry, double camera_height_m) {
  constexpr double kAhead = 1.5;
  constexpr double kBeside = 1.6;
  constexpr std::size_t kReach = 60;  // keyframes after the first view in which the car gets there
  constexpr int kFewest = 40;
  std::vector<double> ratios;
  for (const Track& track : odometry.tracks) {
    if (!track.p_odom) continue;
    const auto first = static_cast<std::size_t>(track.observations.front().keyframe);
    const std::size_t end = std::min(odometry.keyframes.size(), first + kReach);
    double best = std::hypot(kAhead, kBeside);
    std::optional<double> height;
    for (std::size_t k = first; k < end; ++k) {
      if (k > first && odometry.keyframes[k].after_gap) break;
      const Eigen::Vector3d p = odometry.keyframes[k].T_odom_vehicle.inverse() * *track.p_odom;
      if (std::abs(p.x()) > kAhead || std::abs(p.y()) > kBeside) continue;
      if (p.head<2>().norm() >= best) continue;
      best = p.head<2>().norm();
      height = p.z();
    }
    if (height && *height < 0.95 * camera_height_m)
      ratios.push_back(camera_height_m / (camera_height_m - *height));
  }
  const auto found = ground_scale(std::move(ratios), kFewest);
  if (found)
    std::fprintf(stderr, "DBG ground %.4f sigma %.4f support %d\n", found->scale, found->sigma,
                 found->support);
  if (!found) return std::nullopt;
  return found->scale;
}

}  // namespace roadbook
