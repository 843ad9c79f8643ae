#include "mapping/localisation/localiser.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/format.hpp"
#include "base/index.hpp"
#include "vo/exposure_shift.hpp"
#include "vo/planar_motion.hpp"

namespace roadbook {
namespace {

constexpr double kStartReachM = 10.0;               // of the map around a given start
constexpr double kStartWithinM = 5.0;               // of a given start
constexpr double kStartSeconds = 2.0;               // for which a given start is tried
constexpr double kFastest = 40.0;                   // [m/s] of a car whose velocity is not known
constexpr std::int64_t kLeftOutNs = 1'000'000'000;  // for which doubted wheels predict nothing

double seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

// Covariance of a fix beside its prediction. Both come from the same landmarks, so they do not add
// up: along each of their common axes the fix counts, or the prediction where the fix knows much
// less.
Matrix6d covariance_of_fix(const Matrix6d& predicted, const Matrix6d& fix) {
  constexpr double kMuchLess = 4.0;
  // predicted = L L^T; L^-1 fix L^-T = V D V^T: in the coordinates V^T L^-1 x, the prediction has
  // the variances 1 and the fix has D.
  const Eigen::LLT<Matrix6d> llt(predicted);
  if (llt.info() != Eigen::Success) return fix;
  const Matrix6d L = llt.matrixL();
  const Matrix6d half = L.triangularView<Eigen::Lower>().solve(fix);
  const Matrix6d inner = L.triangularView<Eigen::Lower>().solve(half.transpose().eval());
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(0.5 * (inner + inner.transpose()));
  Vector6d variances = eigen.eigenvalues();
  for (double& v : variances)
    if (v > kMuchLess) v = 1.0;
  const Matrix6d axes = L * eigen.eigenvectors();
  return axes * variances.asDiagonal() * axes.transpose();
}

// A vehicle with a pose, confirmed or tentative.
struct VehicleTrack {
  PredictedPose pose;
  std::int64_t t_ns = 0;
  // The pose of the last fix, and the velocity from the two last ones (per second).
  Eigen::Isometry3d T_map_fixed = Eigen::Isometry3d::Identity();
  std::int64_t fixed_ns = 0;
  Matrix6d fixed_covariance = Matrix6d::Zero();
  std::optional<Vector6d> velocity;
  Matrix6d random = Matrix6d::Zero();  // covariance without errors that last
  double since_fix_m = 0.0;
  // Distance, turn and time since the last fix that the wheels and the velocity predicted.
  double wheels_m = 0.0;
  double wheels_rad = 0.0;
  double blind_s = 0.0;
  int jumps = 0;  // frames in a row whose fix contradicts the prediction
  std::int64_t doubted_until_ns = std::numeric_limits<std::int64_t>::min();
  // Of a pose without prediction, until it is confirmed.
  bool tentative = false;
  double tried_m = 0.0;        // driven by the prediction
  double tried_fixes_m = 0.0;  // driven from fix to fix
  int tried = 0;
  int fixed = 0;

  // Wheels that two frames in a row contradict predict nothing for a second.
  bool doubts_wheels(std::int64_t now_ns) {
    constexpr int kContradicted = 2;
    if (jumps >= kContradicted) doubted_until_ns = std::max(doubted_until_ns, now_ns + kLeftOutNs);
    return now_ns < doubted_until_ns;
  }
};

}  // namespace

std::string_view name_of(LocalisationStatus status) {
  switch (status) {
    case LocalisationStatus::kLocalised:
      return "localised";
    case LocalisationStatus::kRelocalised:
      return "relocalised";
    case LocalisationStatus::kPredicted:
      return "predicted";
    case LocalisationStatus::kLost:
      return "lost";
  }
  return "lost";
}

void LocaliserOptions::check() const {
  fix.check();
  relocalise.check();
  if (!(lost_m > 0.0)) throw InvalidOption("lost_m", std::to_string(lost_m), "> 0");
  if (!(confirm_m >= 0.0)) throw InvalidOption("confirm_m", std::to_string(confirm_m), ">= 0");
}

struct Localiser::State {
  const LandmarkIndex& index;
  Rig stated_rig;
  Rig rig;  // the same, with cameras where they exposed the present frame
  Vector6d exposure_twist = Vector6d::Zero();  // for `rig`
  LocaliserOptions options;
  std::optional<Relocaliser> relocaliser;  // made when it is needed for the first time
  std::optional<Eigen::Vector3d> start;    // where the vehicle is said to stand
  double start_heading_rad = 0.0;
  std::optional<std::int64_t> start_tried_ns;  // when it was tried for the first time
  std::optional<VehicleTrack> track;
  std::optional<std::int64_t> last_frame_ns;
  std::optional<std::int64_t> last_try_ns;
  bool confirmed = false;
  // Sums over past frames, which fade: the factor on the covariance of a fix is their ratio.
  double pull_found = 0.0;
  double pull_expected = 0.0;
  double before_noise_factor = 1.0;

  State(const LandmarkIndex& i, Rig r, const LocaliserOptions& o)
      : index(i),
        stated_rig(std::move(r)),
        rig(stated_rig),
        options(o),
        before_noise_factor(o.fix.noise_factor) {
    options.check();
  }

  const Relocaliser& places() {
    if (!relocaliser) relocaliser.emplace(index, options.relocalise);
    return *relocaliser;
  }

  void place_cameras(const LocaliserFrame& frame, bool use_wheels);
  void predict(const LocaliserFrame& frame, bool use_wheels);
  [[nodiscard]] bool is_lost() const;
  bool try_fix(const FrameCorners& corners, LocalisedFrame& result);
  bool try_without_wheels(const LocaliserFrame& frame,
                          const FrameCorners& corners,
                          LocalisedFrame& result);
  bool fix_without_motion(const FrameCorners& corners);
  void learn_noise(const FrameFix& fix);
  void take_fix(const Eigen::Isometry3d& T_map_vehicle, const Matrix6d& covariance);
  void look_for_place(const LocaliserFrame& frame, const FrameCorners& corners);
  [[nodiscard]] bool agrees_with_start(const Eigen::Isometry3d& T_map_vehicle) const;
  void judge_tentative(bool has_fix);
};

// Late cameras saw the world from where the car was then, by its motion since the last frame.
void Localiser::State::place_cameras(const LocaliserFrame& frame, bool use_wheels) {
  const double dt = last_frame_ns ? seconds(*last_frame_ns, frame.t_ns) : 0.0;
  last_frame_ns = frame.t_ns;
  if (!exposes_beside_stamp(stated_rig)) return;
  // The velocity between two fixes depends on where the cameras were placed for them. Taken over at
  // once, a delay of more than one frame would swing up.
  constexpr double kShareOfNew = 0.2;
  if (use_wheels && dt > 0.0)
    exposure_twist = se3_log(planar_transform(*frame.wheels)) / dt;
  else if (track && track->velocity)
    exposure_twist += kShareOfNew * (*track->velocity - exposure_twist);
  rig = rig_at_exposure(stated_rig, exposure_twist);
}

// Moves the track to the time of the frame, by the wheels or with its velocity.
void Localiser::State::predict(const LocaliserFrame& frame, bool use_wheels) {
  VehicleTrack& t = *track;
  const double dt = seconds(t.t_ns, frame.t_ns);
  Eigen::Isometry3d T_old_new = Eigen::Isometry3d::Identity();
  Matrix6d noise = Matrix6d::Zero();
  if (use_wheels) {
    T_old_new = planar_transform(*frame.wheels);
    noise = planar_information(*frame.wheels).inverse();
    t.wheels_m += T_old_new.translation().norm();
    t.wheels_rad += so3_log(T_old_new.linear()).norm();
  } else {
    constexpr double kPlace = 0.02;  // [m] of the velocity between two fixes, over one frame
    constexpr double kTurn = 0.005;  // [rad]
    if (t.velocity) T_old_new = se3_exp(*t.velocity * dt);
    noise.diagonal() << Eigen::Vector3d::Constant(kPlace * kPlace),
        Eigen::Vector3d::Constant(kTurn * kTurn);
    t.blind_s += dt;
    if (frame.wheels && t.velocity) {
      // The wheels were wrong since the last fix: the velocity leads on from there instead.
      t.blind_s = seconds(t.fixed_ns, frame.t_ns);
      t.pose.T_map_vehicle = t.T_map_fixed;
      t.random = t.fixed_covariance;
      T_old_new = se3_exp(*t.velocity * t.blind_s);
      t.since_fix_m = t.wheels_m = t.wheels_rad = 0.0;
    }
  }
  const double way = T_old_new.translation().norm();
  t.pose.T_map_vehicle = t.pose.T_map_vehicle * T_old_new;
  t.random = compose_covariance(t.random, T_old_new, noise);
  t.since_fix_m += way;
  // A wrong radius and a changed velocity do not average out.
  const double sigma_turn = options.wheel_error * (t.wheels_rad + 0.05 * t.wheels_m) +
                            0.5 * options.angular_acceleration_rad_s2 * t.blind_s * t.blind_s;
  const double changed_m =
      t.velocity ? 0.5 * options.acceleration_m_s2 * t.blind_s * t.blind_s : kFastest * t.blind_s;
  const double sigma_along = options.wheel_error * t.wheels_m + changed_m;
  const double sigma_across = 0.5 * sigma_turn * t.since_fix_m + changed_m;
  t.pose.covariance = t.random;
  t.pose.covariance(0, 0) += sigma_along * sigma_along;
  t.pose.covariance(1, 1) += sigma_across * sigma_across;
  t.pose.covariance(5, 5) += sigma_turn * sigma_turn;
  t.tried_m += way;
  t.t_ns = frame.t_ns;
}

bool Localiser::State::is_lost() const {
  const Matrix6d& P = track->pose.covariance;
  if (!P.allFinite()) return true;
  const double place = std::sqrt(std::max(P(0, 0), P(1, 1)));
  return place > options.lost_m || std::sqrt(P(5, 5)) > options.lost_rad ||
         track->since_fix_m > options.lost_after_m || track->jumps >= options.max_jumps;
}

// Takes the pose that the landmarks give, if there are enough and they do not contradict.
bool Localiser::State::try_fix(const FrameCorners& corners, LocalisedFrame& result) {
  VehicleTrack& t = *track;
  auto fix = fix_frame(rig, corners, index, t.pose, options.fix, &result.in_view);
  result.landmarks = static_cast<int>(result.in_view.size());
  if (!fix) return false;
  result.matched = fix->matched;
  if (!has_enough(*fix, rig, options.fix)) {
    t.jumps = 0;
    return false;
  }
  const Vector6d jump = se3_log(t.pose.T_map_vehicle.inverse() * fix->T_map_vehicle);
  const Matrix6d S = t.pose.covariance + fix->covariance;
  if (!(jump.dot(S.ldlt().solve(jump)) <= options.max_jump_chi2)) {
    ++t.jumps;
    return false;
  }
  result.jump_m = jump.head<3>().norm();
  result.inliers = fix->inliers();
  result.views = std::move(fix->views);
  result.cameras = fix->cameras;
  result.chi2 = fix->chi2;
  take_fix(fix->T_map_vehicle, covariance_of_fix(t.pose.covariance, fix->covariance));
  learn_noise(*fix);
  return true;
}

// Errors of the landmarks are larger or smaller than stated, and neighbours have errors in common.
void Localiser::State::learn_noise(const FrameFix& fix) {
  constexpr double kFading = 0.98;       // a frame's weight halves in 34 frames
  constexpr double kLeastFactor = 0.25;  // pairs are chosen among those near the prediction
  pull_found = kFading * pull_found + fix.pull_found;
  pull_expected = kFading * pull_expected + fix.pull_expected;
  // Until there are some frames, the factor of the options counts as much as these.
  constexpr double kBefore = 50.0;
  const double factor = (pull_found + kBefore * before_noise_factor) / (pull_expected + kBefore);
  options.fix.noise_factor = std::max(kLeastFactor, factor);
}

void Localiser::State::take_fix(const Eigen::Isometry3d& T_map_vehicle,
                                const Matrix6d& covariance) {
  constexpr double kLongest = 1.0;  // [s] between two fixes that tell a velocity
  VehicleTrack& t = *track;
  const double dt = seconds(t.fixed_ns, t.t_ns);
  if (dt > 0.0 && dt < kLongest) t.velocity = se3_log(t.T_map_fixed.inverse() * T_map_vehicle) / dt;
  t.tried_fixes_m += (T_map_vehicle.translation() - t.T_map_fixed.translation()).norm();
  t.T_map_fixed = T_map_vehicle;
  t.fixed_ns = t.t_ns;
  t.pose = {T_map_vehicle, covariance};
  t.random = t.fixed_covariance = covariance;
  t.since_fix_m = t.wheels_m = t.wheels_rad = t.blind_s = 0.0;
  t.jumps = 0;
}

// Where the prediction of the wheels gives no fix, wrong wheels may be the cause: the velocity of
// the last fixes is tried instead. If it gives one, the wheels are left out for a second.
bool Localiser::State::try_without_wheels(const LocaliserFrame& frame,
                                          const FrameCorners& corners,
                                          LocalisedFrame& result) {
  constexpr double kLongest = 1.0;  // [s] for which a velocity says where the car is
  const VehicleTrack by_wheels = *track;
  if (seconds(by_wheels.fixed_ns, frame.t_ns) > kLongest) return false;
  bool is_placed = false;
  if (track->velocity)
    predict(frame, false);
  else
    is_placed = fix_without_motion(corners);
  if ((track->velocity || is_placed) && try_fix(corners, result)) {
    track->doubted_until_ns = frame.t_ns + kLeftOutNs;
    result.jump_m = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  *track = by_wheels;
  return false;
}

// Without wheels and without a velocity nothing predicts the pose: the place around the last one is
// searched as if no pose were known.
bool Localiser::State::fix_without_motion(const FrameCorners& corners) {
  const auto found =
      places().find_near(rig, corners, track->T_map_fixed.translation(), options.fix);
  if (!found || found->ambiguous) return false;
  const double moved =
      (found->fix.T_map_vehicle.translation() - track->T_map_fixed.translation()).norm();
  constexpr double kMarginM = 0.5;
  if (moved > kFastest * seconds(track->fixed_ns, track->t_ns) + kMarginM) return false;
  take_fix(found->fix.T_map_vehicle, found->fix.covariance);
  return true;
}

bool Localiser::State::agrees_with_start(const Eigen::Isometry3d& T_map_vehicle) const {
  constexpr double kWithinRad = 0.52;
  if (!start) return true;
  return (T_map_vehicle.translation() - *start).head<2>().norm() < kStartWithinM &&
         std::abs(wrap_angle(heading_of(T_map_vehicle) - start_heading_rad)) < kWithinRad;
}

void Localiser::State::look_for_place(const LocaliserFrame& frame, const FrameCorners& corners) {
  if (!options.may_relocalise && !start) return;
  if (last_try_ns && seconds(*last_try_ns, frame.t_ns) < options.retry_s) return;
  last_try_ns = frame.t_ns;
  if (start && !start_tried_ns) start_tried_ns = frame.t_ns;
  // The car may have left the given start meanwhile, or never stood there.
  if (start && seconds(*start_tried_ns, frame.t_ns) > kStartSeconds) {
    start.reset();
    if (!options.may_relocalise) return;
  }
  const auto found = start ? places().find_near(rig, corners, *start, options.fix)
                           : places().find(rig, corners, options.fix);
  if (!found || found->ambiguous || !agrees_with_start(found->fix.T_map_vehicle)) return;
  VehicleTrack t;
  t.pose = {found->fix.T_map_vehicle, found->fix.covariance};
  t.random = t.fixed_covariance = t.pose.covariance;
  t.T_map_fixed = t.pose.T_map_vehicle;
  t.t_ns = t.fixed_ns = frame.t_ns;
  t.tentative = !start;  // a given start is accepted at once
  start.reset();
  track = t;
}

// A pose without prediction is accepted when the car has driven and most frames had a fix.
void Localiser::State::judge_tentative(bool has_fix) {
  VehicleTrack& t = *track;
  if (!t.tentative) return;
  ++t.tried;
  t.fixed += has_fix ? 1 : 0;
  constexpr int kFewest = 5;
  const bool is_poor = t.tried >= kFewest && t.fixed < options.confirm_share * t.tried;
  if (is_poor) {
    track.reset();
    return;
  }
  if (t.tried < kFewest || std::max(t.tried_m, t.tried_fixes_m) < options.confirm_m) return;
  t.tentative = false;
  confirmed = true;
}

Localiser::Localiser(const LandmarkIndex& index, Rig half_rig, const LocaliserOptions& options)
    : state_(std::make_unique<State>(index, std::move(half_rig), options)) {}
Localiser::~Localiser() = default;
Localiser::Localiser(Localiser&&) noexcept = default;
Localiser& Localiser::operator=(Localiser&&) noexcept = default;

void Localiser::start_near(double x_m, double y_m, double heading_rad) {
  State& s = *state_;
  int best = -1;
  double least = kStartReachM;
  const Map& map = s.index.map();
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (s.index.seen_from(static_cast<int>(k)).empty()) continue;
    const Eigen::Vector3d p = map.T_map_vehicle(static_cast<int>(k)).translation();
    const double distance = (p.head<2>() - Eigen::Vector2d(x_m, y_m)).norm();
    if (distance >= least) continue;
    least = distance;
    best = static_cast<int>(k);
  }
  if (best < 0)
    throw InvalidOption("--start", fixed(x_m, 2) + "," + fixed(y_m, 2),
                        "a place within 10 m of the map's poses");
  s.start = Eigen::Vector3d(x_m, y_m, map.T_map_vehicle(best).translation().z());
  s.start_heading_rad = heading_rad;
  s.start_tried_ns.reset();
  s.track.reset();
}

LocalisedFrame Localiser::add(LocaliserFrame frame) {
  State& s = *state_;
  s.confirmed = false;
  LocalisedFrame result;
  result.frame = frame.frame;
  result.t_ns = frame.t_ns;
  const bool use_wheels =
      frame.wheels.has_value() && !(s.track && s.track->doubts_wheels(frame.t_ns));
  s.place_cameras(frame, use_wheels);
  const FrameCorners corners(s.rig, std::move(frame.features));
  const bool is_blind = s.track && !use_wheels && !s.track->velocity;
  if (s.track) s.predict(frame, use_wheels);
  const bool is_placed = is_blind && s.fix_without_motion(corners);
  if (s.track && s.is_lost()) {
    // Frames of a pose that was never confirmed end with this one, before another may begin.
    const bool was_tentative = s.track->tentative;
    s.track.reset();
    if (was_tentative) return result;
  }
  const bool had_track = s.track.has_value();
  if (!s.track) s.look_for_place(frame, corners);
  if (!s.track) return result;
  const bool has_fix =
      s.try_fix(corners, result) || (use_wheels && s.try_without_wheels(frame, corners, result));
  if (!had_track || is_placed || !use_wheels)
    result.jump_m = std::numeric_limits<double>::quiet_NaN();
  s.judge_tentative(has_fix);
  if (!s.track) {  // the tentative pose was wrong
    LocalisedFrame lost;
    lost.frame = result.frame;
    lost.t_ns = result.t_ns;
    return lost;
  }
  const VehicleTrack& t = *s.track;
  result.tentative = t.tentative;
  result.status = t.tentative ? LocalisationStatus::kLost
                  : has_fix   ? LocalisationStatus::kLocalised
                              : LocalisationStatus::kPredicted;
  if (s.confirmed && has_fix) result.status = LocalisationStatus::kRelocalised;
  result.T_map_vehicle = t.pose.T_map_vehicle;
  result.local_covariance = t.pose.covariance;
  result.keyframe = s.index.nearest_keyframe(t.pose.T_map_vehicle.translation());
  if (result.keyframe >= 0) {
    const Map& map = s.index.map();
    result.covariance = compose_covariance(
        map.keyframes[at(result.keyframe)].covariance,
        map.T_map_vehicle(result.keyframe).inverse() * t.pose.T_map_vehicle, t.pose.covariance);
  }
  result.since_fix_m = t.since_fix_m;
  return result;
}

void Localiser::prepare() { static_cast<void>(state_->places()); }

bool Localiser::confirmed() const { return state_->confirmed; }

}  // namespace roadbook
