#include "diagnosis/motion/closed_form_start.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "diagnosis/motion/motion_fit.hpp"
#include "diagnosis/streams/lag_by_correlation.hpp"
#include "diagnosis/streams/motion_effects.hpp"
#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/wheel_rows.hpp"

namespace roadbook {
namespace {

// What differs by less is in reach of linear steps.
constexpr double kRatioInReach = 1.5;
// Two wheels with the same error, up to this ratio, have one common cause.
constexpr double kRatiosAlike = 0.2;
// [rad] below which a car has turned too little for a ratio of turns.
constexpr double kLeastTurn = 0.5;
// [m/s] below which the poses' curvature is noise.
constexpr double kLeastSteered = 1.0;

struct Factor {
  double value = 1.0;
  double explained = 0.0;  // share of the variance that the other regressor leaves
};

// Regression of readings on two regressors through the origin.
struct TwoRegressors {
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Vector2d products = Eigen::Vector2d::Zero();
  double total = 0.0;

  void add(const Eigen::Vector2d& x, double y) {
    squares += x * x.transpose();
    products += x * y;
    total += y * y;
  }
  // Empty if regressor `which` explains too little in addition to the other: its noise would make
  // the factor too small.
  [[nodiscard]] std::optional<Factor> factor(Eigen::Index which) const {
    constexpr double kExplained = 0.9;
    Eigen::Matrix2d held = squares;
    held.diagonal() *= 1.0 + 1e-9;
    held.diagonal().array() += 1e-12;
    const Eigen::Vector2d x = held.ldlt().solve(products);
    const double own = x[which] * x[which] * held.determinant() / held(1 - which, 1 - which);
    const double left = std::max(0.0, total - x.dot(products));
    if (!(own > kExplained * (own + left))) return std::nullopt;
    return Factor{x[which], own / (own + left)};
  }
};

bool is_out_of_reach(double ratio) {
  return (ratio < 1.0 / kRatioInReach || ratio > kRatioInReach) && std::abs(ratio) > 1e-3;
}

class GrossStart {
 public:
  GrossStart(const Observations& obs, const EffectSizes& known, const LibraryOptions& library)
      : known_(known),
        motion_(smoothed(trajectory_of_poses(obs, motion_effects_of(known).pose.latency))) {
    for (std::size_t j = 0; j + 1 < motion_.knots(); ++j)
      turned_ += std::abs(motion_.yaw_rate[j]) * motion_.step_s();
    // Of what reads another time than is thought, factors tell nothing.
    const StreamLags lags = large_lags(obs, motion_, known);
    sizes_ = named_lags(lags, library.without);
    EffectSizes aligned = known;
    for (const auto& [name, size] : named_lags(lags, {"cam.latency"})) aligned[name] += size;
    obs_ = covered_by_poses(obs, aligned);
    times_ = row_times(obs_, motion_effects_of(aligned));
  }

  EffectSizes sizes() && {
    if (obs_.wheels.size() > 2) add_wheels();
    if (turned_ < kLeastTurn) return std::move(sizes_);
    add_steering();
    add_gyro();
    return std::move(sizes_);
  }

 private:
  // A factor of a reading that goes with 1 + size.
  void add(const std::string& name, double factor) {
    const auto has = known_.find(name);
    sizes_[name] = factor - 1.0 - (has == known_.end() ? 0.0 : has->second);
  }
  void add_radius(const std::string& name, double ratio) {
    if (is_out_of_reach(ratio) && shows_effect(obs_.wheels_read, name)) add(name, 1.0 / ratio);
  }

  // Each wheel's way on the way and the turn of the poses, so that a track width does no harm.
  void add_wheels() {
    const bool both = obs_.wheels_read == WheelsRead::kBoth;
    const double half = both ? 0.5 * obs_.wheel_model.track_width_m : 0.0;
    TwoRegressors left, right;
    for (std::size_t k = 1; k < times_.wheels.size(); ++k) {
      const MotionState a = motion_.rates_at(times_.wheels[k - 1]);
      const MotionState b = motion_.rates_at(times_.wheels[k]);
      const Eigen::Vector2d motion(b.distance_m - a.distance_m, b.turned - a.turned);
      const double middle = obs_.wheels[k].distance_m - obs_.wheels[k - 1].distance_m;
      const double aside = half * (obs_.wheels[k].heading - obs_.wheels[k - 1].heading);
      left.add(motion, middle - aside);
      right.add(motion, middle + aside);
    }
    const auto of_left = left.factor(0);
    const auto of_right = right.factor(0);
    if (!of_left || !of_right) return;
    const double mean = 0.5 * (of_left->value + of_right->value);
    if (std::abs(of_left->value - of_right->value) <= kRatiosAlike * std::abs(mean)) {
      add_radius("wheels0.radius", mean);
      if (!both) add_radius("wheels0.left_radius", mean);
      if (!both) add_radius("wheels0.right_radius", mean);
    } else {
      add_radius("wheels0.left_radius", of_left->value);
      add_radius("wheels0.right_radius", of_right->value);
    }
    const auto left_turn = left.factor(1);
    const auto right_turn = right.factor(1);
    if (!both || turned_ < kLeastTurn || !left_turn || !right_turn) return;
    // Half a track to either side, of wheels whose radii are right.
    const double track = right_turn->value / of_right->value - left_turn->value / of_left->value;
    const double ratio = track / obs_.wheel_model.track_width_m;
    if (is_out_of_reach(ratio)) add("wheels0.track_width", ratio);
  }

  // A ratio is a factor of the angle, a wheelbase one of its tangent.
  void add_steering() {
    TwoRegressors angle, tangent;
    for (std::size_t k = 0; k < obs_.steering.size(); ++k) {
      const MotionState s =
          motion_.rates_at(0.5 * (times_.steering_begin[k] + times_.steering_end[k]));
      if (std::abs(s.speed) < kLeastSteered) continue;
      const double nominal = obs_.wheel_model.wheelbase_m * s.yaw_rate / s.speed;
      angle.add({std::atan(nominal), 1.0}, obs_.steering[k].value);
      tangent.add({nominal, 1.0}, std::tan(obs_.steering[k].value));
    }
    const auto ratio = angle.factor(0);
    const auto wheelbase = tangent.factor(0);
    if (ratio && (!wheelbase || ratio->explained >= wheelbase->explained)) {
      if (is_out_of_reach(ratio->value)) add("steering0.ratio", ratio->value);
    } else if (wheelbase && is_out_of_reach(wheelbase->value)) {
      add("steering0.wheelbase", wheelbase->value);
    }
  }

  void add_gyro() {
    TwoRegressors rate;
    for (std::size_t k = 0; k < obs_.gyro.size(); ++k) {
      const double t = 0.5 * (times_.gyro_begin[k] + times_.gyro_end[k]);
      rate.add({motion_.rates_at(t).yaw_rate, 1.0}, obs_.gyro[k].value);
    }
    if (const auto factor = rate.factor(0); factor && is_out_of_reach(factor->value))
      add("imu0.gyro_scale", factor->value);
  }

  Observations obs_;
  const EffectSizes& known_;
  Trajectory motion_;
  RowTimes times_;
  double turned_ = 0.0;
  EffectSizes sizes_;
};

}  // namespace

EffectSizes start_of_large_effects(const Observations& obs,
                                   const EffectSizes& known,
                                   const LibraryOptions& library) {
  EffectSizes sizes = GrossStart(obs, known, library).sizes();
  for (const std::string& name : library.without) sizes.erase(name);
  return sizes;
}

}  // namespace roadbook
