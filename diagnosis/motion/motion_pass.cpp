#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "diagnosis/motion/interval_jacobian.hpp"
#include "diagnosis/motion/motion_fit.hpp"
#include "diagnosis/numerics/probes.hpp"
#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/wheel_rows.hpp"

namespace roadbook {
namespace {

class PassRunner {
 public:
  PassRunner(const Observations& obs,
             const MotionPoint& point,
             const MotionNoise& noise,
             const Columns& columns,
             const PassOptions& options)
      : obs_(obs),
        point_(point),
        trajectory_(point.trajectory),
        noise_(noise),
        columns_(columns),
        options_(options),
        times_(row_times(obs, point.effects)),
        first_(obs.offsets()),
        gain_(wheel_row_gain(obs.wheel_model, obs.wheels_read, point.effects, {})),
        sides_(1 + columns.count() + options.probes),
        elimination_(sides_, options.keep),
        row_(elimination_.stride(), 0.0),
        walk_(2 * sides_, 0.0),
        knot_sides_(3 * sides_, 0.0) {
    out_.sides = sides_;
    out_.of.reserve(first_.back());
    out_.values.reserve(first_.back() * sides_);
  }

  Pass run() {
    const std::size_t intervals = trajectory_.knots() - 1;
    for (std::size_t j = 0; j < intervals; ++j) {
      const double end =
          j + 1 == intervals ? std::numeric_limits<double>::infinity() : trajectory_.knot_s(j + 1);
      for (; wheel_ < times_.wheels.size() && times_.wheels[wheel_] < end; ++wheel_) wheel(j);
      for (; gyro_ < obs_.gyro.size() && gyro_time() < end; ++gyro_) gyro(j);
      for (; steering_ < obs_.steering.size() && steering_time() < end; ++steering_) steering(j);
      for (; pose_ < obs_.poses.size() && times_.poses[pose_] < end; ++pose_) pose(j);
      if (j + 1 < intervals) advance(j);
    }
    return {std::move(out_), std::move(elimination_), two_wheels() ? 2U : 1U};
  }

 private:
  [[nodiscard]] double gyro_time() const {
    return 0.5 * (times_.gyro_begin[gyro_] + times_.gyro_end[gyro_]);
  }
  [[nodiscard]] double steering_time() const {
    return 0.5 * (times_.steering_begin[steering_] + times_.steering_end[steering_]);
  }
  [[nodiscard]] double since_knot(std::size_t j, double t) const {
    return t - trajectory_.knot_s(j);
  }

  // Residual, columns and probes of one row at `to`, over sigma.
  // The target must be 0.
  void fill_sides(double* to,
                  Channel channel,
                  std::size_t k,
                  double over_sigma,
                  Probe probe,
                  std::size_t index) {
    to[0] = point_.residual[first_[index_of(channel)] + k] * over_sigma;
    for (const Columns::Part& part : columns_.of(channel))
      to[1 + part.column] = part.values[k] * over_sigma;
    for (std::size_t p = 0; p < options_.probes; ++p)
      to[1 + columns_.count() + p] = probe_sign(probe, index, p);
  }

  // Folds row_ in, whose slots are set for unit sigma, and keeps the innovation.
  void measure(Channel channel, std::size_t k, double t) {
    const std::size_t row = first_[index_of(channel)] + k;
    double sigma = noise_.sigma(channel);
    if (options_.inflation != nullptr) sigma *= (*options_.inflation)[row];
    for (std::size_t i = 0; i < kSlots; ++i) row_[i] /= sigma;
    fill_sides(row_.data() + kSlots, channel, k, 1.0 / sigma, Probe::kRow, row);
    keep(row, channel, t);
  }
  void keep(std::size_t row, Channel channel, double t) {
    const double variance = elimination_.measure(row_.data());
    if (variance > 0.0) {
      out_.of.push_back({row, index_of(channel), t, variance});
      out_.values.insert(out_.values.end(), row_.begin() + kSlots,
                         row_.begin() + static_cast<std::ptrdiff_t>(kSlots + sides_));
    }
    std::fill(row_.begin(), row_.end(), 0.0);
  }

  [[nodiscard]] bool two_wheels() const { return obs_.wheels_read == WheelsRead::kBoth; }
  [[nodiscard]] Eigen::Matrix2d gain_in(std::size_t j) const {
    if (obs_.wheels_read != WheelsRead::kFront) return gain_;
    TrueMotion<double> motion;
    motion.distance_m = 0.5 * (trajectory_.speed[j] + trajectory_.speed[j + 1]);
    motion.turn_rad = 0.5 * (trajectory_.yaw_rate[j] + trajectory_.yaw_rate[j + 1]);
    return wheel_row_gain(obs_.wheel_model, obs_.wheels_read, point_.effects, motion);
  }

  // Coefficients of the wheels' readings between two moments of interval j.
  void roll(std::size_t j,
            double from,
            double to,
            std::array<double, 4>& distance,
            std::array<double, 4>& heading) const {
    const HatIntegrals a = hat_integrals(trajectory_.step_s(), since_knot(j, from));
    const HatIntegrals b = hat_integrals(trajectory_.step_s(), since_knot(j, to));
    const double first = b.first - a.first;
    const double second = b.second - a.second;
    const Eigen::Matrix2d gain = gain_in(j);
    distance = {gain(0, 0) * first, gain(0, 1) * first, gain(0, 0) * second, gain(0, 1) * second};
    heading = {gain(1, 0) * first, gain(1, 1) * first, gain(1, 0) * second, gain(1, 1) * second};
  }

  void wheel(std::size_t j) {
    const double t = times_.wheels[wheel_];
    const WheelModel& model = obs_.wheel_model;
    const double arc = 0.5 * (model.radius_left_m + model.radius_right_m) * noise_.wheel_angle_rad;
    const std::array<double, 2> reading{two_wheels() ? std::sqrt(0.5) * arc : arc,
                                        std::sqrt(2.0) * arc / model.track_width_m};
    if (wheel_ > 0) {
      const double before = times_.wheels[wheel_ - 1];
      WheelStep step;
      step.reading_sigma = reading;
      roll(j, std::max(before, j == 0 ? before : trajectory_.knot_s(j)), t, step.drift,
           step.turn_drift);
      const double ds =
          std::abs(trajectory_.rates_at(t).distance_m - trajectory_.rates_at(before).distance_m);
      const double root = std::sqrt(ds + 1e-6);
      const std::size_t d = first_[index_of(Channel::kWheelDistance)] + wheel_ - 1;
      const std::size_t h = first_[index_of(Channel::kWheelHeading)] + wheel_ - 1;
      step.drift_sigma = noise_.distance_per_sqrt_m * root;
      step.turn_sigma = noise_.heading_per_sqrt_m * root;
      if (options_.inflation != nullptr) {
        step.drift_sigma *= (*options_.inflation)[d];
        if (two_wheels()) step.turn_sigma *= (*options_.inflation)[h];
      }
      // The drifts are kept relative to the readings: what was read and not predicted is drift.
      std::fill(walk_.begin(), walk_.end(), 0.0);
      fill_sides(walk_.data(), Channel::kWheelDistance, wheel_ - 1, -1.0 / step.drift_sigma,
                 Probe::kWalk, 2 * wheel_);
      if (two_wheels())
        fill_sides(walk_.data() + sides_, Channel::kWheelHeading, wheel_ - 1,
                   -1.0 / step.turn_sigma, Probe::kWalk, 2 * wheel_ + 1);
      elimination_.walk(step, walk_.data(), walk_.data() + sides_);
    }
    read_drift(kDrift, Channel::kWheelDistance, reading[0], t);
    // Of one wheel nothing is ever said of the other drift: it goes along without information.
    if (two_wheels()) read_drift(kTurnDrift, Channel::kWheelHeading, reading[1], t);
  }
  void read_drift(std::size_t slot, Channel channel, double sigma, double t) {
    row_[slot] = 1.0 / sigma;
    for (std::size_t k = 0; k < options_.probes; ++k)
      row_[kSlots + 1 + columns_.count() + k] =
          probe_sign(Probe::kReading, 2 * wheel_ + (slot == kDrift ? 0 : 1), k);
    const std::size_t row = first_[index_of(channel)] + (wheel_ > 0 ? wheel_ - 1 : 0);
    keep(row, channel, t);
  }

  void gyro(std::size_t j) {
    const double t = gyro_time();
    const double u = since_knot(j, t) / trajectory_.step_s();
    const double gain = (1.0 + point_.effects.imu.gyro_scale) * (1.0 - point_.effects.bank);
    row_[kYawA] = (1.0 - u) * gain;
    row_[kYawB] = u * gain;
    measure(Channel::kGyro, gyro_, t);
  }

  void steering(std::size_t j) {
    const double t = steering_time();
    const double u = since_knot(j, t) / trajectory_.step_s();
    const MotionState s = trajectory_.after(j, since_knot(j, t));
    const double L = obs_.wheel_model.wheelbase_m * (1.0 + point_.effects.steering.wheelbase) *
                     (1.0 - point_.effects.bank);
    const double speed = std::copysign(std::max(std::abs(s.speed), 1e-3), s.speed);
    const double square = speed * speed + L * L * s.yaw_rate * s.yaw_rate;
    const double gain = 1.0 + point_.effects.steering.ratio;
    const double by_speed = -gain * L * s.yaw_rate / square;
    const double by_yaw = gain * L * speed / square;
    row_[kSpeedA] = (1.0 - u) * by_speed;
    row_[kSpeedB] = u * by_speed;
    row_[kYawA] = (1.0 - u) * by_yaw;
    row_[kYawB] = u * by_yaw;
    measure(Channel::kSteering, steering_, t);
  }

  void pose(std::size_t j) {
    const double t = times_.poses[pose_];
    const IntervalJacobian d = interval_jacobian(trajectory_, j, since_knot(j, t));
    const double c = std::cos(d.state.heading);
    const double s = std::sin(d.state.heading);
    const auto direction = [&](Channel channel, double by_x, double by_y) {
      for (std::size_t k = 0; k < 4; ++k) row_[kSpeedA + k] = by_x * d.x[k] + by_y * d.y[k];
      row_[kX] = by_x;
      row_[kY] = by_y;
      row_[kHeading] = by_x * d.x_by_heading + by_y * d.y_by_heading;
      measure(channel, pose_, t);
    };
    direction(Channel::kPoseAlong, c, s);
    direction(Channel::kPoseAcross, -s, c);
    if (!obs_.poses_have_heading) return;
    row_[kHeading] = 1.0;
    row_[kYawA] = d.hats.first;
    row_[kYawB] = d.hats.second;
    measure(Channel::kPoseHeading, pose_, t);
  }

  void advance(std::size_t j) {
    const Trajectory& m = trajectory_;
    const double h = m.step_s();
    const IntervalJacobian d = interval_jacobian(m, j, h);
    KnotStep step;
    step.x = d.x;
    step.y = d.y;
    step.x_by_heading = d.x_by_heading;
    step.y_by_heading = d.y_by_heading;
    step.half_step_s = 0.5 * h;
    step.defect = {d.state.x - m.x[j + 1], d.state.y - m.y[j + 1],
                   d.state.heading - m.heading[j + 1]};
    step.sideways = {-std::sin(d.state.heading), std::cos(d.state.heading)};
    const double ds = 0.5 * h * std::abs(m.speed[j] + m.speed[j + 1]);
    step.creep_sigma = noise_.creep_per_sqrt_m * std::sqrt(ds + 1e-6);
    step.speed_sigma = noise_.speed_m_s;
    step.yaw_sigma = noise_.yaw_rad_s;
    step.speed_bend = m.speed[j] - 2.0 * m.speed[j + 1] + m.speed[j + 2];
    step.yaw_bend = m.yaw_rate[j] - 2.0 * m.yaw_rate[j + 1] + m.yaw_rate[j + 2];
    if (wheel_ > 0 && wheel_ <= times_.wheels.size())
      roll(j, std::max(times_.wheels[wheel_ - 1], m.knot_s(j)), m.knot_s(j + 1), step.drift,
           step.turn_drift);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < options_.probes; ++k)
        knot_sides_[i * sides_ + 1 + columns_.count() + k] = probe_sign(Probe::kKnot, 3 * j + i, k);
    elimination_.advance(step, options_.probes > 0 ? knot_sides_.data() : nullptr);
  }

  const Observations& obs_;
  const MotionPoint& point_;
  const Trajectory& trajectory_;
  const MotionNoise& noise_;
  const Columns& columns_;
  const PassOptions& options_;
  RowTimes times_;
  std::array<std::size_t, kChannels + 1> first_;
  Eigen::Matrix2d gain_;  ///< of wheel rows by distance and turn
  std::size_t sides_;
  Elimination elimination_;
  std::vector<double> row_, walk_, knot_sides_;
  Innovations out_;
  std::size_t wheel_ = 0, gyro_ = 0, steering_ = 0, pose_ = 0;
};

}  // namespace

Pass run_pass(const Observations& obs,
              const MotionPoint& point,
              const MotionNoise& noise,
              const Columns& columns,
              const PassOptions& options) {
  return PassRunner(obs, point, noise, columns, options).run();
}

}  // namespace roadbook
