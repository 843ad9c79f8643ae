#include "speedmap/speeds/lane_speeds.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <map>
#include <string>

#include "base/error.hpp"
#include "base/gravity.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

constexpr double kLeastSpeed = 0.1;  // [m/s]

// Worst presence and worst grip under the vehicle at one place.
void look_under(const WayPoint& at,
                const PresenceAt& presence,
                const FrictionAt& friction,
                const LaneSpeedOptions& options,
                LaneSpeed& place) {
  const int half = static_cast<int>(std::ceil(0.5 * options.vehicle_width_m / 0.5));
  double worst_presence = -1.0;
  double worst_friction = INFINITY;
  place.presence = place.presence_sigma = place.friction = place.friction_sigma = NAN;
  for (int i = -half; i <= half; ++i) {
    const double e = 0.5 * options.vehicle_width_m * i / half;
    if (presence)
      if (const auto value = presence(at.position + e * at.left)) {
        const double sigma = std::sqrt(value->variance);
        const double cautious = value->presence + options.caution * sigma;
        if (cautious > worst_presence) {
          worst_presence = cautious;
          place.presence = value->presence;
          place.presence_sigma = sigma;
        }
      }
    const auto value = friction ? friction(place.s_m, e) : std::nullopt;
    if (value) {
      const double low = grip_speed_of(*value, at.curvature, options).friction;
      if (low < worst_friction) {
        worst_friction = low;
        place.friction = value->mean;
        place.friction_sigma = std::sqrt(value->variance);
      }
    } else if (options.unknown_grip > 0.0 && options.unknown_grip < worst_friction) {
      worst_friction = options.unknown_grip;
      place.friction = place.friction_sigma = NAN;
    }
  }
  place.pedestrian = worst_presence < 0.0
                         ? INFINITY
                         : recommended_speed(worst_presence, options.min_speed, options.max_speed);
  const bool known = std::isfinite(worst_friction);
  place.grip = known ? grip_speed(worst_friction, at.curvature, options) : INFINITY;
  place.grip_acceleration = known ? options.grip_share * worst_friction * kGravity : INFINITY;
}

}  // namespace

void LaneSpeedOptions::check() const {
  require_option(min_speed >= kLeastSpeed && min_speed <= 100.0, "min_speed_mps", min_speed,
                 "0.1 to 100");
  require_option(max_speed >= min_speed && max_speed <= 100.0, "max_speed_mps", max_speed,
                 "min_speed_mps to 100");
  require_option(caution >= 0.0 && caution <= 10.0, "caution", caution, "0 to 10");
  require_option(grip_quantile > 0.0 && grip_quantile <= 0.5, "grip_quantile", grip_quantile,
                 "above 0, to 0.5");
  require_option(grip_share > 0.0 && grip_share <= 1.0, "grip_share", grip_share, "above 0, to 1");
  require_option(unknown_grip >= 0.0 && unknown_grip <= 1.5, "unknown_grip", unknown_grip,
                 "0 to 1.5");
  require_option(sight_m > 0.0 && sight_m <= 1e4, "sight_m", sight_m, "above 0, to 1e4");
  require_option(reaction_s >= 0.0 && reaction_s <= 60.0, "reaction_s", reaction_s, "0 to 60");
  require_option(vehicle_width_m > 0.0 && vehicle_width_m <= 20.0, "vehicle_width_m",
                 vehicle_width_m, "above 0, to 20");
  require_option(step_m >= 0.01 && step_m <= 2.0, "step_m", step_m, "0.01 to 2");
  motion.check();
}

double LaneSpeed::ceiling() const {
  return std::max(kLeastSpeed, std::min({limit, pedestrian, bend, grip, item}));
}

SpeedLimitedBy LaneSpeed::limited_by() const {
  if (speed < ceiling() - 1e-6) return SpeedLimitedBy::kMotion;
  if (item < std::min({limit, pedestrian, bend, grip})) return SpeedLimitedBy::kItem;
  if (pedestrian <= std::min({limit, bend, grip})) return SpeedLimitedBy::kPedestrian;
  if (grip <= std::min(limit, bend)) return SpeedLimitedBy::kGrip;
  return bend < limit ? SpeedLimitedBy::kBend : SpeedLimitedBy::kLaw;
}

double grip_speed(double mu, double curvature, const LaneSpeedOptions& options) {
  const double a = options.grip_share * mu * kGravity;
  const double in_bend = std::sqrt(a / std::max(std::abs(curvature), 1e-9));
  // v t + v^2 / 2a = sight
  const double t = options.reaction_s;
  const double stopping = -a * t + std::sqrt(a * a * t * t + 2.0 * a * options.sight_m);
  return std::min(in_bend, stopping);
}

GripSpeed grip_speed_of(const PropertyMoments& friction,
                        double curvature,
                        const LaneSpeedOptions& options) {
  const double z = -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * options.grip_quantile);
  const double sigma = std::sqrt(friction.variance);
  GripSpeed grip;
  grip.friction = std::max(friction.mean + z * sigma, kLeastFriction);
  grip.speed = grip_speed(grip.friction, curvature, options);
  // Speed goes with the root of friction at most: that slope is not too small.
  grip.sigma = 0.5 * grip.speed / grip.friction * sigma;
  return grip;
}

std::vector<LaneSpeed> speed_limits_along(const std::vector<WayPoint>& way,
                                          const std::vector<double>& s_m,
                                          double limit,
                                          const PresenceAt& presence,
                                          const FrictionAt& friction,
                                          const LaneSpeedOptions& options) {
  options.check();
  ROADBOOK_ASSERT(way.size() == s_m.size());
  std::vector<LaneSpeed> places(way.size());
  for (std::size_t i = 0; i < way.size(); ++i) {
    LaneSpeed& place = places[i];
    place.s_m = s_m[i];
    place.position = way[i].position;
    place.limit = limit;
    place.bend = std::sqrt(options.motion.lateral / std::max(std::abs(way[i].curvature), 1e-9));
    look_under(way[i], presence, friction, options, place);
    place.speed = place.ceiling();
  }
  return places;
}

void make_feasible(std::vector<LaneSpeed>& places,
                   double step_m,
                   bool closed,
                   const LaneSpeedOptions& options) {
  SpeedCeiling ceiling;
  ceiling.step_m = step_m;
  ceiling.closed = closed;
  for (const LaneSpeed& place : places) {
    ceiling.speed.push_back(place.speed);
    ceiling.grip_acceleration.push_back(place.item_grip * place.grip_acceleration);
  }
  const std::vector<double> speed = feasible_speeds(ceiling, options.motion);
  for (std::size_t i = 0; i < places.size(); ++i) places[i].speed = speed[i];
}

std::vector<double> even_places(const PathCurve& curve, double step_m) {
  const int steps = std::max(2, static_cast<int>(std::ceil(curve.length_m() / step_m)));
  std::vector<double> s;
  for (int i = 0; i < steps + (curve.closed() ? 0 : 1); ++i)
    s.push_back(curve.length_m() * i / steps);
  return s;
}

std::vector<WayPoint> way_points(const PathCurve& curve, const std::vector<double>& s_m) {
  std::vector<WayPoint> way;
  for (const double s : s_m) {
    const PathPoint at = curve.at(s);
    way.push_back({at.position, at.left(), at.curvature});
  }
  return way;
}

double LaneProfile::speed_at(double s_m, double* slope) const {
  const auto n = static_cast<double>(places.size());
  double at = s_m / step_m;
  at = closed ? at - n * std::floor(at / n) : std::clamp(at, 0.0, n - 1.0);
  const auto i = std::min(static_cast<std::size_t>(at), places.size() - (closed ? 1 : 2));
  const double a = places[i].speed;
  const double b = places[(i + 1) % places.size()].speed;
  if (slope != nullptr) *slope = (b - a) / step_m;
  return a + (at - static_cast<double>(i)) * (b - a);
}

void agree_at_intersections(std::vector<LaneProfile>& profiles, const LaneSpeedOptions& options) {
  // Speeds only fall, and every round that changes one takes it down to another's: this ends.
  for (bool changed = true; changed;) {
    changed = false;
    std::map<int, double> slowest;
    const auto for_ends = [](LaneProfile& profile, const auto& visit) {
      if (profile.closed || profile.places.empty()) return;
      if (profile.from_intersection >= 0)
        visit(profile.from_intersection, profile.places.front().speed);
      if (profile.to_intersection >= 0) visit(profile.to_intersection, profile.places.back().speed);
    };
    for (LaneProfile& profile : profiles)
      for_ends(profile, [&](int intersection, double& speed) {
        const auto [at, added] = slowest.try_emplace(intersection, speed);
        at->second = std::min(at->second, speed);
      });
    for (LaneProfile& profile : profiles) {
      bool lowered = false;
      for_ends(profile, [&](int intersection, double& speed) {
        lowered = lowered || speed > slowest[intersection] + 1e-6;
        speed = std::min(speed, slowest[intersection]);
      });
      if (lowered) make_feasible(profile.places, profile.step_m, false, options);
      changed = changed || lowered;
    }
  }
}

}  // namespace roadbook
