#include "diagnosis/tilt/tilt_windows.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/gravity.hpp"
#include "base/median.hpp"
#include "diagnosis/streams/pose_motion.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kFewestPoses = 20;

template <typename Sample>
bool ascend(const std::vector<Sample>& samples) {
  const auto goes_back = [](const Sample& a, const Sample& b) { return !(b.t_s > a.t_s); };
  return std::adjacent_find(samples.begin(), samples.end(), goes_back) == samples.end();
}

bool are_usable(const MotionStreams& s) {
  if (s.poses.size() < kFewestPoses || s.imu.empty() || s.imu.size() != s.gyro.size()) return false;
  const bool finite =
      std::all_of(s.poses.begin(), s.poses.end(),
                  [](const PoseSample& p) { return std::isfinite(p.x + p.y + p.heading); }) &&
      std::all_of(s.imu.begin(), s.imu.end(), [](const ImuSample& i) {
        return i.rate_rad_s.allFinite() && i.force_m_s2.allFinite();
      });
  return finite && ascend(s.poses) && ascend(s.imu);
}

// The reference's attitude by lines through its neighbours: a difference of two poses would carry
// their noise.
class SmoothAttitude {
 public:
  explicit SmoothAttitude(const std::vector<Attitude>& all) : all_(all) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < all.size(); ++i) steps.push_back(all[i].t_s - all[i - 1].t_s);
    if (!steps.empty()) half_s_ = std::max(half_s_, 2.5 * median(std::move(steps)));
  }

  struct Value {
    double slope = 0.0, bank = 0.0, slope_rate = 0.0, bank_rate = 0.0;
  };
  // Cheapest for times that ascend.
  Value at(double t_s) {
    while (first_ < all_.size() && all_[first_].t_s < t_s - half_s_) ++first_;
    Eigen::Matrix2d G = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d b = Eigen::Matrix2d::Zero();
    for (std::size_t i = first_; i < all_.size() && all_[i].t_s <= t_s + half_s_; ++i) {
      const Eigen::Vector2d v(1.0, all_[i].t_s - t_s);
      G += v * v.transpose();
      b += v * Eigen::RowVector2d(all_[i].slope_rad, all_[i].bank_rad);
    }
    if (G.determinant() < 1e-9) return {};
    const Eigen::Matrix2d line = G.inverse() * b;
    return {line(0, 0), line(0, 1), line(1, 0), line(1, 1)};
  }

 private:
  const std::vector<Attitude>& all_;
  double half_s_ = 0.4;
  std::size_t first_ = 0;
};

void set_attitude(const SmoothAttitude::Value& a, TiltWindow& w) {
  w.up = {std::sin(a.slope), std::cos(a.slope) * std::sin(a.bank),
          std::cos(a.slope) * std::cos(a.bank)};
  w.own_rate = {a.bank_rate, -a.slope_rate * std::cos(a.bank), a.slope_rate * std::sin(a.bank)};
}

}  // namespace

TiltAxes tilt_axes(const std::vector<ImuSample>& imu) {
  if (imu.empty()) return {};
  const auto varies = [&](const auto& value) {
    return std::any_of(imu.begin(), imu.end(),
                       [&](const ImuSample& s) { return value(s) != value(imu.front()); });
  };
  double up = 0.0;
  for (const ImuSample& s : imu) up += s.force_m_s2.norm() / static_cast<double>(imu.size());
  constexpr double kNoGravity = 3.0;  // [m/s^2] a car's own acceleration does not make up for it
  return {varies([](const ImuSample& s) { return s.rate_rad_s.x(); }) &&
              varies([](const ImuSample& s) { return s.rate_rad_s.y(); }),
          std::abs(up - kGravity) < kNoGravity &&
              varies([](const ImuSample& s) { return s.force_m_s2.x(); }) &&
              varies([](const ImuSample& s) { return s.force_m_s2.y(); })};
}

std::vector<TiltWindow> tilt_windows(const MotionStreams& streams, double step_s) {
  std::vector<TiltWindow> windows;
  if (!are_usable(streams)) return windows;
  PoseSmoother motion(streams.poses, half_window_of(streams.poses));
  SmoothAttitude attitude(streams.body);
  const auto& imu = streams.imu;
  const double start = streams.poses.front().t_s;
  const auto window_of = [&](const ImuSample& s) { return std::floor((s.t_s - start) / step_s); };
  std::vector<std::size_t> counts;
  for (std::size_t i = 0; i < imu.size();) {
    TiltWindow w;
    std::size_t end = i;
    for (; end < imu.size() && window_of(imu[end]) == window_of(imu[i]); ++end) {
      w.t_s += imu[end].t_s;
      w.rate += imu[end].rate_rad_s;
      w.force += imu[end].force_m_s2;
    }
    const auto n = static_cast<double>(end - i);
    w.t_s /= n;
    w.rate /= n;
    w.force /= n;
    if (const auto m = motion.at(w.t_s)) {
      w.speed = m->speed;
      w.acceleration = m->acceleration;
      set_attitude(attitude.at(w.t_s), w);
      windows.push_back(w);
      counts.push_back(end - i);
    }
    i = end;
  }
  if (counts.empty()) return windows;
  std::vector<double> sizes(counts.begin(), counts.end());
  const double usual = median(std::move(sizes));
  std::vector<TiltWindow> full;
  for (std::size_t k = 0; k < windows.size(); ++k)
    if (static_cast<double>(counts[k]) + 1.0 >= usual) full.push_back(windows[k]);
  return full;
}

}  // namespace roadbook
