#include "diagnosis/reckoning_error.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnosis/motion/motion_fit.hpp"
#include "diagnosis/streams/dead_reckoning.hpp"
#include "diagnosis/streams/motion_prediction.hpp"

namespace roadbook {
namespace {

constexpr double kAveraged_s = 1.0;  // of the reference, at both ends of a piece
constexpr double kLeastWay_m = 1.0;
constexpr std::size_t kFewestPieces = 3;

Observations freed_of(const Observations& obs,
                      const MotionEffects& known,
                      const MotionEffects& found) {
  const Trajectory along = smoothed(trajectory_of_poses(obs));
  constexpr unsigned kReadings = kWheels | kSteeringBit | kGyroBit | kPoses;
  std::vector<double> change = predict_rows(obs, along, found, kReadings);
  const std::vector<double> usual = predict_rows(obs, along, known, kReadings);
  for (std::size_t i = 0; i < change.size(); ++i) change[i] -= usual[i];
  const auto first = obs.offsets();
  const auto of = [&](Channel channel, std::size_t i) {
    return change[first[index_of(channel)] + i];
  };
  Observations freed = obs;
  double distance = 0.0;
  double heading = 0.0;
  for (std::size_t i = 0; i + 1 < obs.wheels.size(); ++i) {
    distance += of(Channel::kWheelDistance, i);
    if (obs.rows(Channel::kWheelHeading) > 0) heading += of(Channel::kWheelHeading, i);
    freed.wheels[i + 1].distance_m -= distance;
    freed.wheels[i + 1].heading -= heading;
  }
  for (std::size_t i = 0; i < obs.steering.size(); ++i)
    freed.steering[i].value -= of(Channel::kSteering, i);
  for (std::size_t i = 0; i < obs.gyro.size(); ++i) freed.gyro[i].value -= of(Channel::kGyro, i);
  for (std::size_t i = 0; i < obs.poses.size(); ++i) {
    freed.poses[i].x -= of(Channel::kPoseAlong, i);
    freed.poses[i].y -= of(Channel::kPoseAcross, i);
    if (obs.poses_have_heading)
      freed.poses[i].heading -= of(Channel::kPoseHeading, i);
    else
      freed.poses[i].heading = along.at(obs.poses[i].t_s).heading;
  }
  return freed;
}

struct Reckoned {
  double t_s = 0.0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double heading = 0.0;
};

// The way from `begin_s`, from the origin along x; empty at a gap of the readings.
std::vector<Reckoned> reckon(const Observations& obs, double begin_s, double end_s) {
  std::vector<Reckoned> way{{begin_s, Eigen::Vector2d::Zero(), 0.0}};
  for (double t = begin_s; t < end_s; t += obs.step_s) {
    const auto speed = reckoned_speed(obs, t + 0.5 * obs.step_s);
    const auto rate = reckoned_yaw_rate(obs, t + 0.5 * obs.step_s);
    if (!speed || !rate) return {};
    const Reckoned& last = way.back();
    const double middle = last.heading + 0.5 * obs.step_s * *rate;
    way.push_back(
        {t + obs.step_s,
         last.position + obs.step_s * *speed * Eigen::Vector2d(std::cos(middle), std::sin(middle)),
         last.heading + obs.step_s * *rate});
  }
  return way;
}

Reckoned at(const std::vector<Reckoned>& way, double t_s, double step_s) {
  const double k = (t_s - way.front().t_s) / step_s;
  const auto i = std::min(static_cast<std::size_t>(std::max(0.0, k)), way.size() - 2);
  const double share = k - static_cast<double>(i);
  return {t_s, (1.0 - share) * way[i].position + share * way[i + 1].position,
          (1.0 - share) * way[i].heading + share * way[i + 1].heading};
}

double wrapped(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

// Mean over the poses from `begin_s` to `end_s` of reference minus way, turned by `turn` and moved
// by `move`.
struct Off {
  std::size_t poses = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double heading = 0.0;
};
Off off_reference(const Observations& obs,
                  const std::vector<Reckoned>& way,
                  double begin_s,
                  double end_s,
                  double turn,
                  const Eigen::Vector2d& move) {
  Off off;
  double first = 0.0;
  auto sample = std::lower_bound(obs.poses.begin(), obs.poses.end(), begin_s,
                                 [](const PoseSample& p, double t) { return p.t_s < t; });
  for (; sample != obs.poses.end() && sample->t_s <= end_s; ++sample) {
    const PoseSample& pose = *sample;
    const Reckoned here = at(way, pose.t_s, obs.step_s);
    off.position +=
        Eigen::Vector2d(pose.x, pose.y) - (Eigen::Rotation2Dd(turn) * here.position + move);
    const double heading = wrapped(pose.heading - here.heading - turn);
    if (off.poses == 0) first = heading;
    off.heading += first + wrapped(heading - first);
    ++off.poses;
  }
  if (off.poses == 0) return off;
  off.position /= static_cast<double>(off.poses);
  off.heading /= static_cast<double>(off.poses);
  return off;
}

struct PieceErrors {
  std::vector<double> position_m;
  std::vector<double> heading_rad;
};

PieceErrors piece_errors(const Observations& obs,
                         const EffectSizes& known,
                         const EffectSizes& found,
                         double over_s) {
  PieceErrors errors;
  // A single wheel rolls another way than the car's middle.
  if (obs.poses.size() < 2 || obs.wheels.size() < 2 ||
      (obs.wheels_read != WheelsRead::kBoth && obs.wheels_read != WheelsRead::kMiddle))
    return errors;
  const Observations freed = freed_of(obs, motion_effects_of(known), motion_effects_of(found));
  const double half = 0.5 * kAveraged_s;
  // From the middle of the first second to that of the last half second: `over_s`.
  const double whole = half + over_s + 0.5 * half;
  const double last = obs.poses.back().t_s - whole;
  for (double begin = obs.poses.front().t_s; begin <= last; begin += 1.0) {
    const double end = begin + whole;
    const std::vector<Reckoned> way = reckon(freed, begin, end);
    if (way.size() < 3 || way.back().position.norm() < kLeastWay_m) continue;
    const double start = begin + kAveraged_s;
    const Off turn = off_reference(freed, way, begin, start, 0.0, Eigen::Vector2d::Zero());
    const Off move = off_reference(freed, way, begin, start, turn.heading, Eigen::Vector2d::Zero());
    const Off off = off_reference(freed, way, end - half, end, turn.heading, move.position);
    if (turn.poses < 2 || off.poses < 1) continue;
    errors.position_m.push_back(off.position.norm());
    errors.heading_rad.push_back(off.heading);
  }
  return errors;
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

std::vector<double> reckoning_errors_m(const Observations& obs,
                                       const EffectSizes& known,
                                       const EffectSizes& found) {
  return piece_errors(obs, known, found, ReckoningError{}.over_s).position_m;
}

std::optional<ReckoningError> reckoning_error(const Observations& obs,
                                              const EffectSizes& known,
                                              const EffectSizes& found) {
  ReckoningError error;
  const PieceErrors errors = piece_errors(obs, known, found, error.over_s);
  error.pieces = errors.position_m.size();
  if (error.pieces < kFewestPieces) return std::nullopt;
  error.position_m = root_mean_square(errors.position_m);
  error.heading_rad = root_mean_square(errors.heading_rad);
  return error;
}

void add_reckoning(const Observations& obs, const EffectSizes& known, Diagnosis& d) {
  const auto moves = [](const std::string& name) {
    const auto all = motion_effects();
    return std::any_of(all.begin(), all.end(),
                       [&](const MotionEffect& effect) { return effect.name == name; });
  };
  if (std::none_of(d.causes.begin(), d.causes.end(),
                   [&](const FoundCause& c) { return moves(c.effect); }))
    return;
  // Freed of everything that the model has: what `--model` knows is corrected as well.
  d.reckoned_before = reckoning_error(obs, {}, known);
  d.reckoned_after = reckoning_error(obs, {}, d.extended);
  for (FoundCause& cause : d.causes) {
    if (!moves(cause.effect)) continue;
    EffectSizes others = d.extended;
    const auto of_known = known.find(cause.effect);
    others.erase(cause.effect);
    if (of_known != known.end()) others.insert(*of_known);
    cause.reckoned_without = reckoning_error(obs, {}, others);
  }
}

}  // namespace roadbook
