#include "speedmap/speeds/path_query.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/gravity.hpp"
#include "speedmap/property_map/interpolation.hpp"

namespace roadbook {
namespace {

double quantile_of_normal(double p) { return -std::sqrt(2.0) * boost::math::erfc_inv(2.0 * p); }

}  // namespace

LaneQuery::LaneQuery(const LaneStrips& strips,
                     const LaneProfile& profile,
                     const PresenceAt& presence,
                     const std::function<PlaceClass(const Eigen::Vector2d&)>& place,
                     const PropertyMap* friction,
                     const LaneSpeedOptions& options,
                     double knot_spacing_m,
                     const GroundFields& fields)
    : strip_(strips.find(profile.lane)),
      profile_(profile),
      place_(place),
      friction_(friction),
      options_(options),
      fields_(fields) {
  if (strip_ == nullptr)
    throw InvalidOption("lane", std::to_string(profile.lane), "a lane with a path");
  KnotGridOptions grid;
  grid.length_m = strip_->length_m();
  grid.closed = strip_->frame.curve().closed() && grid.length_m >= 8.0 * knot_spacing_m;
  grid.e_min_m = -strip_->half_width_m;
  grid.e_max_m = strip_->half_width_m;
  grid.spacing_s_m = grid.spacing_e_m = knot_spacing_m;
  grid.width = {2.0 * knot_spacing_m, 2.0 * knot_spacing_m};
  std::vector<PathPlace> known;
  const Knots all = Knots::grid(grid);
  for (const PathPlace& v : all.places())
    if (const auto p = strip_->frame.position(v.s_m, v.e_m); p && presence)
      if (const auto value = presence(*p)) {
        known.push_back(v);
        values_.push_back(*value);
      }
  if (!known.empty()) knots_.emplace(std::move(known), grid.width, all.period_m());
}

std::optional<SmoothValue> LaneQuery::presence_at(const PathPlace& v) const {
  if (!knots_) return std::nullopt;
  thread_local Interpolation near;
  thread_local InterpolationDerivatives derivatives;
  interpolate(*knots_, v, near, derivatives);
  if (!near.covered()) return std::nullopt;
  SmoothValue result;
  double sigma = 0.0;
  for (std::size_t n = 0; n < near.size(); ++n) {
    const PresenceValue& knot = values_[static_cast<std::size_t>(near.knots[n])];
    result.value += near.weights[n] * knot.presence;
    result.gradient += knot.presence * derivatives.gradients[n];
    sigma += near.weights[n] * std::sqrt(knot.variance);
  }
  result.variance = sigma * sigma;  // as if neighbours erred together: never too small
  return result;
}

const LaneSpeed& LaneQuery::place_near(double s_m) const {
  const double at = std::round(s_m / profile_.step_m);
  return profile_.places[static_cast<std::size_t>(
      std::clamp(at, 0.0, static_cast<double>(profile_.places.size()) - 1.0))];
}

SmoothValue LaneQuery::profile_at(double s_m) const {
  SmoothValue result;
  result.value = profile_.speed_at(s_m, &result.gradient.x());
  // The variance of what limits it at the nearest place; law and bends have none.
  const LaneSpeed& place = place_near(s_m);
  if (place.item < std::min({place.limit, place.pedestrian, place.bend, place.grip}))
    result.variance = place.item_sigma * place.item_sigma;
  else if (place.pedestrian <= std::min({place.limit, place.bend, place.grip}))
    result.variance = std::pow((options_.max_speed - options_.min_speed) * place.presence_sigma, 2);
  else if (place.grip <= std::min(place.limit, place.bend)) {
    const double mu = place.grip_acceleration / (options_.grip_share * kGravity);
    const double slope = 0.5 * place.grip / mu;  // of sqrt(mu); stopping is at most that steep
    result.variance = std::pow(slope * place.friction_sigma, 2);
  }
  return result;
}

// `factor`: of friction, by the items of the place.
SmoothValue LaneQuery::stopping_at(const PropertyMomentsDerivatives& friction,
                                   double factor) const {
  const double z = quantile_of_normal(options_.grip_quantile);
  const double sigma = std::sqrt(friction.variance);
  const double low = factor * (friction.mean + z * sigma);
  SmoothValue result;
  result.value = grip_speed(std::max(low, kLeastFriction), 0.0, options_);
  if (low <= kLeastFriction) return result;  // flat
  const double k = options_.grip_share * kGravity;
  const double t = options_.reaction_s;
  const double a = k * low;
  const double slope = k * (-t + (a * t * t + options_.sight_m) /
                                     std::sqrt(a * a * t * t + 2.0 * a * options_.sight_m));
  result.gradient = slope * factor * (friction.d_mean + 0.5 * z / sigma * friction.d_variance);
  result.variance = slope * slope * factor * factor * friction.variance;
  return result;
}

// Gradients by x and y become those by s and e: the point is g(s) + e n(s), and n' = -k g'.
void LaneQuery::add_fields(double s_m, double e_m, PathAnswer& answer) const {
  if (fields_.occupancy == nullptr && fields_.labels == nullptr) return;
  const PathPoint on_path = strip_->frame.curve().at(s_m);
  const Eigen::Vector2d along = (1.0 - on_path.curvature * e_m) * on_path.tangent;
  const Eigen::Vector2d left = on_path.left();
  const auto in_path = [&](const Eigen::Vector2d& gradient) {
    return Eigen::Vector2d(gradient.dot(along), gradient.dot(left));
  };
  if (fields_.occupancy != nullptr)
    if (const auto at = fields_.occupancy->at(answer.position))
      answer.occupancy = {{at->probability, in_path(at->gradient), at->sigma * at->sigma},
                          at->age_s};
  if (fields_.labels == nullptr) return;
  thread_local std::vector<LabelAt> near;
  fields_.labels->at(answer.position, near);
  answer.labels.emplace();
  answer.labels->reserve(near.size());
  for (const LabelAt& at : near)
    answer.labels->push_back(
        {at.label, {at.distance_m, in_path(at.gradient), at.label->sigma_m * at.label->sigma_m}});
}

std::optional<PathAnswer> LaneQuery::at(double s_m, double e_m) const {
  const auto position = strip_->frame.position(s_m, e_m);
  if (!position) return std::nullopt;
  PathAnswer answer;
  answer.lane = strip_->lane;
  answer.position = *position;
  answer.place = place_ ? place_(*position) : PlaceClass::kOther;
  answer.speed = profile_at(s_m);
  answer.limited_by = place_near(s_m).limited_by();
  answer.presence = presence_at({s_m, e_m});
  if (answer.presence) {
    const double range = options_.min_speed - options_.max_speed;
    const double pedestrian =
        recommended_speed(answer.presence->value, options_.min_speed, options_.max_speed);
    if (pedestrian < answer.speed.value) {
      answer.speed = {pedestrian, range * answer.presence->gradient,
                      range * range * answer.presence->variance};
      answer.limited_by = SpeedLimitedBy::kPedestrian;
    }
  }
  if (friction_ != nullptr) {
    const PathPlace place{strip_->begin_m + s_m, e_m};
    answer.friction = friction_->moments_with_derivatives(0, place);
    answer.ground_shares.resize(friction_->classes());
    if (!friction_->class_shares(place, answer.ground_shares)) answer.ground_shares.clear();
  }
  if (answer.friction) {
    const double factor = place_near(s_m).item_grip;
    const SmoothValue stopping = stopping_at(*answer.friction, factor);
    if (stopping.value < answer.speed.value) {
      answer.speed = stopping;
      answer.limited_by = factor < 1.0 ? SpeedLimitedBy::kItem : SpeedLimitedBy::kGrip;
    }
  } else if (options_.unknown_grip > 0.0) {
    const double assumed = grip_speed(
        std::max(kLeastFriction, place_near(s_m).item_grip * options_.unknown_grip), 0.0, options_);
    if (assumed < answer.speed.value) {
      answer.speed = {assumed, Eigen::Vector2d::Zero(), 0.0};
      answer.limited_by = SpeedLimitedBy::kGrip;
    }
  }
  add_fields(s_m, e_m, answer);
  return answer;
}

}  // namespace roadbook
