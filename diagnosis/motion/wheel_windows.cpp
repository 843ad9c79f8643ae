#include "diagnosis/motion/wheel_windows.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "diagnosis/streams/motion_prediction.hpp"

namespace roadbook {
namespace {

constexpr double kLongestStep = 0.04;  // [s]
constexpr double kStands = 0.02;       // [m/s]
constexpr double kMoves = 0.1;         // [m/s]

constexpr auto kWindowLength = static_cast<Eigen::Index>(kWheelWindow);
constexpr auto kLeft = static_cast<Eigen::Index>(kWheelRows);
using Readings = Eigen::Matrix<double, kWindowLength, 1>;

struct Contrasts {
  WheelContrasts of;
  Eigen::Matrix<double, kLeft, 1> walk;

  Contrasts() {
    Eigen::Matrix<double, kWindowLength, 3> parabola;
    Eigen::Matrix<double, kWindowLength, kWindowLength> walked;
    for (Eigen::Index i = 0; i < kWindowLength; ++i) {
      const double t = static_cast<double>(i) - 0.5 * static_cast<double>(kWindowLength - 1);
      parabola.row(i) << 1.0, t, t * t;
      for (Eigen::Index j = 0; j < kWindowLength; ++j)
        walked(i, j) = static_cast<double>(std::min(i, j));
    }
    const Eigen::Matrix<double, kWindowLength, kWindowLength> q =
        parabola.householderQr().householderQ();
    const Eigen::Matrix<double, kWindowLength, kLeft> left = q.rightCols(kLeft);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kLeft, kLeft>> parts(
        left.transpose() * walked * left);
    of = parts.eigenvectors().transpose() * left.transpose();
    walk = parts.eigenvalues();
  }
};

const Contrasts& contrasts() {
  static const Contrasts kContrasts;
  return kContrasts;
}

double usual_step(const std::vector<WheelObservation>& readings) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < readings.size(); ++k)
    steps.push_back(readings[k].t_s - readings[k - 1].t_s);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

double tick_of(const std::vector<WheelObservation>& readings) {
  constexpr double kSame = 3e-6;  // [rad]: as files round
  std::vector<double> steps;
  for (std::size_t k = 1; k < readings.size(); ++k) {
    steps.push_back(readings[k].left_rad - readings[k - 1].left_rad);
    steps.push_back(readings[k].right_rad - readings[k - 1].right_rad);
  }
  std::sort(steps.begin(), steps.end());
  // Without the fastest and wildest.
  const std::size_t first = steps.size() / 20;
  const std::size_t last = steps.size() - 1 - first;
  double different = 0.0;
  double sum = 0.0;
  for (std::size_t k = first + 1; k <= last; ++k) {
    const double gap = steps[k] - steps[k - 1];
    if (gap < kSame) continue;
    different += 1.0;
    sum += gap;
  }
  return sum / std::max(different, 1.0);
}

class Windows {
 public:
  Windows(const Observations& obs, const MotionModel& model)
      : smooth_(smoothed(model.point.trajectory)) {
    all_.wheel_model = obs.wheel_model;
    all_.wheels_read = obs.wheels_read;
    all_.origin_s = obs.origin_s;
    all_.wheels = obs.wheel_readings;
    times_ = row_times(all_, model.point.effects).wheels;
    const std::vector<double> predicted =
        predict_rows(all_, model.point.trajectory, model.point.effects, kWheels, &smooth_);
    const std::size_t first = all_.offsets()[index_of(Channel::kWheelHeading)];
    heading_.push_back(0.0);
    for (std::size_t k = 1; k < times_.size(); ++k)
      heading_.push_back(heading_.back() + all_.wheels[k].heading - all_.wheels[k - 1].heading -
                         predicted[first + k - 1]);
    for (const WheelObservation& w : all_.wheels) distance_.push_back(w.distance_m);
  }

  WheelWindows run() {
    const double longest = 1.5 * usual_step(all_.wheels);
    for (std::size_t k = 0; k + kWheelWindow <= times_.size();) {
      std::size_t held = 1;
      while (held < kWheelWindow && times_[k + held] - times_[k + held - 1] < longest) ++held;
      if (held == kWheelWindow) look(k);
      k += held;
    }
    result_.tick_rad = tick_of(all_.wheels);
    return std::move(result_);
  }

 private:
  void look(std::size_t k) {
    const double before = std::abs(smooth_.rates_at(times_[k]).speed);
    const double after = std::abs(smooth_.rates_at(times_[k + kWheelWindow - 1]).speed);
    if (std::min(before, after) > kMoves) moving(k);
    if (std::max(before, after) < kStands) standing(k);
  }

  void moving(std::size_t k) {
    const MotionState from = smooth_.rates_at(times_[k]);
    const MotionState to = smooth_.rates_at(times_[k + kWheelWindow - 1]);
    const double step_m =
        std::abs(to.distance_m - from.distance_m) / static_cast<double>(kWheelWindow - 1);
    const WheelModel& wheels = all_.wheel_model;
    const double mean_radius = 0.5 * (wheels.radius_left_m + wheels.radius_right_m);
    const double arc = mean_radius / wheels.track_width_m;
    WheelWindow w;
    w.read = 2.0 * arc * arc;
    w.readings = 2.0 * static_cast<double>(kWheelWindow);
    w.speed = 0.5 * std::abs(from.speed + to.speed);
    w.turn = 0.5 * std::abs(from.yaw_rate + to.yaw_rate);
    Readings turned, moved;
    for (Eigen::Index i = 0; i < kWindowLength; ++i) {
      const std::size_t at = k + static_cast<std::size_t>(i);
      turned[i] = heading_[at];
      moved[i] = distance_[at];
    }
    add(turned, step_m, w);
    w.along = true;
    w.read = 0.5 * mean_radius * mean_radius;
    add(moved, step_m, w);
  }

  void standing(std::size_t k) {
    for (double WheelObservation::*wheel :
         {&WheelObservation::left_rad, &WheelObservation::right_rad}) {
      Readings x;
      for (Eigen::Index i = 0; i < kWindowLength; ++i)
        x[i] = all_.wheels[k + static_cast<std::size_t>(i)].*wheel - all_.wheels[k].*wheel;
      // Ticks of a standing encoder carry no information.
      if (x.isZero(0.0)) continue;
      add(x, 0.0, {});
    }
  }

  void add(const Readings& x, double step_m, WheelWindow w) {
    const Eigen::Matrix<double, kLeft, 1> z = contrasts().of * x;
    for (Eigen::Index i = 0; i < kLeft; ++i) {
      w.rows[static_cast<std::size_t>(i)] = z[i];
      w.walk[static_cast<std::size_t>(i)] = step_m * contrasts().walk[i];
    }
    result_.windows.push_back(w);
  }

  Trajectory smooth_;
  Observations all_;
  std::vector<double> times_;
  std::vector<double> heading_;   ///< read less predicted, cumulative
  std::vector<double> distance_;  ///< as read
  WheelWindows result_;
};

}  // namespace

const WheelContrasts& wheel_contrasts() { return contrasts().of; }

WheelWindows wheel_windows(const Observations& obs, const MotionModel& model) {
  if (obs.wheels_read != WheelsRead::kBoth || obs.gyro.empty() ||
      obs.wheel_readings.size() < kWheelWindow || usual_step(obs.wheel_readings) > kLongestStep)
    return {};
  return Windows(obs, model).run();
}

}  // namespace roadbook
