#include "diagnosis/views/view_prediction.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "sensors/camera_effects.hpp"
#include "sensors/wheel_imperfections.hpp"

namespace roadbook {
namespace {

constexpr double kWheelStep = 1e-4;
constexpr double kSlopeStep = 1e-4;
constexpr std::size_t kSlopeColumn = 1;
static_assert(kGroundColumns[kSlopeColumn] == "slope");

std::optional<Eigen::Vector2d> projected(const MountedCamera& mounted,
                                         const Eigen::Isometry3d& T_map_vehicle,
                                         const Eigen::Vector3d& p_map) {
  return mounted.camera.project(mounted.T_vehicle_camera.inverse() *
                                (T_map_vehicle.inverse() * p_map));
}

Eigen::Isometry3d planar(double distance_m, double turn_rad) {
  const double half = 0.5 * turn_rad;
  const double chord = distance_m * (std::abs(half) < 1e-6 ? 1.0 : std::sin(half) / half);
  return pose_from_planar(chord * std::cos(half), chord * std::sin(half), turn_rad);
}

// Change of a motion (right perturbation) if the wheels roll on ground that slopes up in driving
// direction by `slope`, relative to the plane of the vehicle's axes.
Vector6d slope_change(const Eigen::Isometry3d& T_from_to, double slope_rad) {
  const Eigen::AngleAxisd T_ground_vehicle(slope_rad, Eigen::Vector3d::UnitY());
  return se3_log(T_from_to.inverse() * T_ground_vehicle * T_from_to * T_ground_vehicle.inverse());
}

Eigen::Isometry3d motion_of(const ViewPoint& point, const MotionConstraint& motion) {
  return point.state.poses[at(motion.from)].inverse() * point.state.poses[at(motion.to)];
}

}  // namespace

std::vector<MountedCamera> real_cameras(const std::vector<MountedCamera>& nominal,
                                        const EffectSizes& effects) {
  std::vector<MountedCamera> real;
  for (const MountedCamera& camera : nominal) real.push_back(apply_camera_effects(camera, effects));
  return real;
}

SteppedCameras::SteppedCameras(std::vector<MountedCamera> real) : now(std::move(real)) {
  for (const MountedCamera& camera : now) {
    more.emplace_back();
    less.emplace_back();
    for (std::size_t k = 0; k < kSteps.size(); ++k) {
      const std::size_t column = kFirstGeometryColumn + k;
      const std::string effect =
          column < kCameraColumns.size()
              ? camera.name + "." + std::string(kCameraColumns[column])
              : "rig." + std::string(kRigColumns[column - kCameraColumns.size()]);
      more.back()[k] = apply_camera_effects(camera, {{effect, kSteps[k]}});
      less.back()[k] = apply_camera_effects(camera, {{effect, -kSteps[k]}});
    }
  }
}

SteppedWheels::SteppedWheels(const EffectSizes& effects) : now(wheel_imperfections(effects)) {
  for (std::size_t k = 0; k < kWheelColumns.size(); ++k) {
    const auto stepped = [&](double step) {
      EffectSizes other = effects;
      other["wheels0." + std::string(kWheelColumns[k])] += step;
      return wheel_imperfections(other);
    };
    more[k] = stepped(kWheelStep);
    less[k] = stepped(-kWheelStep);
  }
}

ViewPrediction::ViewPrediction(const ViewData& data, const ViewBasis& basis)
    : data_(data), basis_(basis), frame_(view_frame(data)) {}

Eigen::Vector2d ViewPrediction::timing_shift(const ViewPoint& point,
                                             const ViewTiming& timing,
                                             const MountedCamera& real,
                                             const BundleObservation& o) const {
  const double dt = timing.after_stamp(real.camera, o.camera, o.pixel.y());
  if (dt == 0.0) return Eigen::Vector2d::Zero();
  const Eigen::Isometry3d& T = point.state.poses[at(o.pose)];
  const Eigen::Vector3d& p = point.state.points[at(o.point)];
  const auto now = projected(real, T, p);
  const Vector6d moved = dt * timing.twist(o.pose, dt);
  // At the edge of the image the whole displacement may leave the field of view; a fraction of it
  // gives the same derivative.
  for (double part = 1.0; now && part > 0.01; part *= 0.25)
    if (const auto then = projected(real, T * se3_exp(part * moved), p))
      return (*then - *now) / part;
  return Eigen::Vector2d::Zero();
}

void ViewPrediction::apply_views(const ViewPoint& point,
                                 BundleProblem& problem,
                                 int num_threads) const {
  const std::size_t terms = 2 * kViewTermCount;
  const ViewTiming timing(data_, point.effects);
  parallel_for_small(problem.observations.size(), num_threads, [&](std::size_t i) {
    BundleObservation& o = problem.observations[i];
    const BundleObservation& read = data_.bundle.observations[i];
    const MountedCamera& real = problem.cameras[at(o.camera)];
    o.pixel = read.pixel - timing_shift(point, timing, real, read);
    const auto sizes = point.linear.segment(index(basis_.term(at(o.camera), 0, 0)), index(terms));
    if (sizes.isZero(0.0)) return;
    const auto predicted =
        projected(real, point.state.poses[at(o.pose)], point.state.points[at(o.point)]);
    if (!predicted) return;
    const auto values = view_terms(frame_, real.camera, *predicted, data_.moments[at(o.pose)],
                                   point.state.poses[at(o.pose)].translation().head<2>());
    const Eigen::Vector2d ahead = radial_direction(real.camera, *predicted);
    const Eigen::Vector2d aside(-ahead.y(), ahead.x());
    for (std::size_t t = 0; t < kViewTermCount; ++t)
      o.pixel -= values[t] * (sizes[index(t)] * ahead + sizes[index(kViewTermCount + t)] * aside);
  });
}

void ViewPrediction::apply(const ViewPoint& point, BundleProblem& problem, int num_threads) const {
  problem.cameras = real_cameras(data_.bundle.cameras, point.effects);
  apply_views(point, problem, num_threads);
  const WheelImperfections<double> off = wheel_imperfections(point.effects);
  const double slope = point.linear[index(basis_.ground() + kSlopeColumn)] +
                       effect_size(point.effects, "ground", kGroundColumns[kSlopeColumn]);
  for (std::size_t i = 0; i < problem.motions.size(); ++i) {
    const MotionConstraint& read = data_.bundle.motions[i];
    Vector6d change = wheel_change(point, read, off, off.latency);
    for (std::size_t h = 0; h < basis_.hinges; ++h)
      if (const double size = point.linear[index(basis_.hinge(h))]; size != 0.0)
        change += size * hinge_change(point, read, point.hinges[h]);
    if (slope != 0.0) change += slope_change(motion_of(point, read), slope);
    problem.motions[i].T_from_to = read.T_from_to * se3_exp(-change);
  }
  const auto sizes = [&] {
    Eigen::VectorXd s =
        point.linear.segment(index(basis_.hinge()), index(basis_.size() - basis_.hinge()));
    for (std::size_t g = 0; g < kGroundColumns.size(); ++g)
      s[index(basis_.ground() - basis_.hinge() + g)] +=
          effect_size(point.effects, "ground", kGroundColumns[g]);
    return s;
  }();
  for (std::size_t p = 0; p < problem.points.size(); ++p)
    if (problem.points[p].ground)
      problem.points[p].ground_height_m =
          sizes.dot(ground_columns(point, problem.points[p], point.state.points[p]));
}

void ViewPrediction::view_columns(const ViewPoint& point,
                                  const SteppedCameras& cameras,
                                  const ViewTiming& timing,
                                  std::span<const std::uint8_t> needed,
                                  const BundleObservation& o,
                                  const TermResidual& term,
                                  Eigen::Ref<Strip> strip) const {
  strip.setZero();
  const MountedCamera& now = cameras.now[at(o.camera)];
  const Eigen::Isometry3d& T = point.state.poses[at(o.pose)];
  const Eigen::Vector3d p_vehicle = T.inverse() * point.state.points[at(o.point)];
  // Effects that change the camera: central differences of its projection.
  for (std::size_t k = 0; k < SteppedCameras::kSteps.size(); ++k) {
    const std::size_t column = kFirstGeometryColumn + k;
    if (!needed.empty() && needed[column] == 0) continue;
    const auto seen = [&](const MountedCamera& other) {
      return other.camera.project(other.T_vehicle_camera.inverse() * p_vehicle);
    };
    const double step = SteppedCameras::kSteps[k];
    const auto more = seen(cameras.more[at(o.camera)][k]);
    const auto less = seen(cameras.less[at(o.camera)][k]);
    // At the edge of the image one side of the difference may be outside the field of view.
    const Eigen::Vector2d here = o.pixel + term.r;
    if (more && less)
      strip.col(index(column)) = (*more - *less) / (2.0 * step);
    else if (more || less)
      strip.col(index(column)) = more ? (*more - here) / step : (here - *less) / step;
  }
  const double dt = timing.after_stamp(now.camera, o.camera, o.pixel.y());
  // The derivative of the displacement over [0, dt] is the twist at dt, which is the mean twist
  // over [0, 2 dt].
  const Eigen::Vector2d per_second = term.J_pose * timing.twist(o.pose, 2.0 * dt);
  strip.col(index(kLatencyColumn)) = -per_second;
  strip.col(index(kShutterColumn)) = ViewTiming::row_share(now.camera, o.pixel.y()) * per_second;
  if (!needed.empty() && std::all_of(needed.begin() + kFirstTermColumn, needed.end(),
                                     [](std::uint8_t n) { return n == 0; }))
    return;
  const Eigen::Vector2d predicted = o.pixel + term.r;
  const auto values = view_terms(frame_, now.camera, predicted, data_.moments[at(o.pose)],
                                 T.translation().head<2>());
  const Eigen::Vector2d ahead = radial_direction(now.camera, predicted);
  for (std::size_t t = 0; t < kViewTermCount; ++t) {
    strip.col(index(kFirstTermColumn + t)) = values[t] * ahead;
    strip.col(index(kFirstTermColumn + kViewTermCount + t)) =
        values[t] * Eigen::Vector2d(-ahead.y(), ahead.x());
  }
}

Vector6d ViewPrediction::wheel_change(const ViewPoint& point,
                                      const MotionConstraint& motion,
                                      const WheelImperfections<double>& off,
                                      double wheels_late_s) const {
  const ViewMoment& from = data_.moments[at(motion.from)];
  const ViewMoment& to = data_.moments[at(motion.to)];
  // Uses the estimated poses: derivatives built from the readings would be correlated with their
  // noise.
  const Eigen::Isometry3d T = motion_of(point, motion);
  TrueMotion<double> m;
  m.turn_rad = heading_of(T);
  const double half = 0.5 * m.turn_rad;
  m.distance_m = std::copysign(T.translation().head<2>().norm(), T.translation().x()) *
                 (std::abs(half) < 1e-6 ? 1.0 : half / std::sin(half));
  const Eigen::Isometry3d plain = planar(m.distance_m, m.turn_rad);
  // The interval shifted back by the latency; the moments' rates are already late by the known
  // latency.
  const double later = wheels_late_s - 0.5 * off.latency;
  m.distance_m -=
      off.latency * (to.speed - from.speed + later * (to.acceleration - from.acceleration));
  m.turn_rad -= off.latency * (to.yaw_rate - from.yaw_rate +
                               later * (to.yaw_acceleration - from.yaw_acceleration));
  m.speed = 0.5 * (from.speed + to.speed);
  m.acceleration = 0.5 * (from.acceleration + to.acceleration);
  m.left_phase_rad = from.left_phase_rad;
  m.right_phase_rad = from.right_phase_rad;
  const WheelModel& wheels = data_.wheels;
  const auto turns = predict_wheel_turns<double>(wheels, off, m);
  const Eigen::Vector2d read = wheel_increment<double>(turns.x(), turns.y(), wheels.radius_left_m,
                                                       wheels.radius_right_m, wheels.track_width_m);
  return se3_log(plain.inverse() * planar(read.x(), read.y()));
}

ViewPrediction::MotionStrip ViewPrediction::motion_columns(const ViewPoint& point,
                                                           const SteppedWheels& wheels,
                                                           const MotionConstraint& motion) const {
  const std::size_t variations = kWheelColumns.size();
  MotionStrip strip = MotionStrip::Zero(6, index(basis_.size() - basis_.wheels()));
  for (std::size_t k = 0; k < kWheelColumns.size(); ++k) {
    const auto change = [&](const WheelImperfections<double>& off) {
      return wheel_change(point, motion, off, wheels.now.latency);
    };
    strip.col(index(k)) = (change(wheels.more[k]) - change(wheels.less[k])) / (2.0 * kWheelStep);
  }
  const ViewMoment& from = data_.moments[at(motion.from)];
  const ViewMoment& to = data_.moments[at(motion.to)];
  for (std::size_t v = 0; v < kWheelVariations.size(); ++v) {
    const auto* of =
        std::find(kWheelColumns.begin(), kWheelColumns.end(), kWheelVariations[v].column);
    strip.col(index(variations + v)) =
        covariate_value(kWheelVariations[v].covariate, from, to, frame_.end_s) *
        strip.col(of - kWheelColumns.begin());
  }
  for (std::size_t h = 0; h < basis_.hinges; ++h)
    strip.middleCols<3>(index(basis_.hinge(h) - basis_.wheels())) = hinge_columns<6>(
        point.hinges[h], [&](const HingeLine& line) { return hinge_change(point, motion, line); });
  strip.col(index(basis_.ground() + kSlopeColumn - basis_.wheels())) =
      slope_change(motion_of(point, motion), kSlopeStep) / kSlopeStep;
  return strip;
}

Vector6d ViewPrediction::hinge_change(const ViewPoint& point,
                                      const MotionConstraint& motion,
                                      const HingeLine& line) const {
  const auto stand = [&](int pose) {
    return pose_on_hinge(line, point.state.poses[at(pose)], data_.wheels).perturbation();
  };
  const Matrix6d back = se3_adjoint(motion.T_from_to.inverse());
  return back * stand(motion.from) - stand(motion.to);
}

Eigen::VectorXd ViewPrediction::ground_columns(const ViewPoint& point,
                                               const BundlePoint& ground,
                                               const Eigen::Vector3d& p_map) const {
  Eigen::VectorXd columns(index(basis_.size() - basis_.hinge()));
  const Eigen::Isometry3d& T = point.state.poses[at(ground.ground_pose)];
  const Eigen::Vector3d p = T.inverse() * p_map;
  const auto over_wheels = [&](const HingeLine& line) {
    const HingePose stand = pose_on_hinge(line, T, data_.wheels);
    return Eigen::Vector<double, 1>(line.height(p_map.head<2>()) - stand.height -
                                    stand.rise_ahead * p.x() - stand.rise_aside * p.y());
  };
  for (std::size_t h = 0; h < basis_.hinges; ++h)
    columns.segment<3>(index(basis_.hinge(h) - basis_.hinge())) =
        hinge_columns<1>(point.hinges[h], over_wheels).transpose();
  columns.tail<2>() << 1.0, p.x();
  return columns;
}

}  // namespace roadbook
