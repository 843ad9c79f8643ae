#include "speedmap/items/item_effects.hpp"

#include <algorithm>
#include <cmath>

#include "base/gravity.hpp"

namespace roadbook {
namespace {

// The speed that a lowered friction allows. Bend and grip of the place give its curvature and its
// friction.
double speed_on(double grip_factor, const LaneSpeed& place, const LaneSpeedOptions& options) {
  if (!(grip_factor < 1.0) || !std::isfinite(place.grip_acceleration)) return place.grip;
  const double friction = place.grip_acceleration / (options.grip_share * kGravity);
  const double curvature = options.motion.lateral / (place.bend * place.bend);
  return grip_speed(std::max(kLeastFriction, grip_factor * friction), curvature, options);
}

}  // namespace

ItemEffects::ItemEffects(const std::vector<LayerItem>& items,
                         std::int64_t now_ns,
                         const LaneSpeedOptions& options)
    : now_ns_(now_ns), min_speed_(options.min_speed) {
  for (const LayerItem& item : items) {
    if (item.state(now_ns) != ItemState::kUsed) continue;
    Used used{item, {INFINITY, INFINITY}, {-INFINITY, -INFINITY}, item.weight(now_ns)};
    for (const auto& part : item.parts)
      for (const Eigen::Vector2d& p : part) {
        used.low = used.low.cwiseMin(p);
        used.high = used.high.cwiseMax(p);
      }
    used.low.array() -= item.reach_m;
    used.high.array() += item.reach_m;
    items_.push_back(std::move(used));
  }
}

template <typename Visit>
void ItemEffects::for_each_at(const Eigen::Vector2d& p,
                              double half_width_m,
                              const Visit& visit) const {
  for (const Used& used : items_) {
    if ((p.array() < used.low.array() - half_width_m).any() ||
        (p.array() > used.high.array() + half_width_m).any())
      continue;
    if (used.item.distance_m(p) <= used.item.reach_m + half_width_m) visit(used);
  }
}

EffectAt ItemEffects::at(const Eigen::Vector2d& p,
                         double half_width_m,
                         double speed_without) const {
  EffectAt effect;
  effect.speed = INFINITY;
  for_each_at(p, half_width_m, [&](const Used& used) {
    const double w = used.weight;
    if (find_item_kind(used.item.kind)->effect == ItemEffect::kGrip) {
      const double factor = 1.0 - w * (1.0 - used.item.grip_factor.value_or(kWetGripFactor));
      effect.grip_factor = std::min(effect.grip_factor, factor);
      return;
    }
    const double lowered = used.item.speed.value_or(min_speed_);
    if (!(lowered < speed_without)) return;
    const double speed = w * lowered + (1.0 - w) * speed_without;
    if (!(speed < effect.speed)) return;
    effect.speed = speed;
    effect.sigma = std::sqrt(w * (1.0 - w)) * (speed_without - lowered);
  });
  return effect;
}

std::vector<const LayerItem*> ItemEffects::holding(const Eigen::Vector2d& p,
                                                   double half_width_m) const {
  std::vector<const LayerItem*> items;
  for_each_at(p, half_width_m, [&](const Used& used) { items.push_back(&used.item); });
  return items;
}

void apply_items(std::vector<LaneProfile>& profiles,
                 const ItemEffects& effects,
                 const LaneSpeedOptions& options) {
  for (LaneProfile& profile : profiles) {
    for (LaneSpeed& place : profile.places) {
      place.item = INFINITY;
      place.item_sigma = 0.0;
      place.item_grip = 1.0;
      const EffectAt effect =
          effects.at(place.position, 0.5 * options.vehicle_width_m, place.ceiling());
      place.item = effect.speed;
      place.item_sigma = effect.sigma;
      if (std::isfinite(place.grip_acceleration)) place.item_grip = effect.grip_factor;
      const double wet = speed_on(effect.grip_factor, place, options);
      if (wet < std::min(place.item, place.grip)) {
        place.item = wet;
        place.item_sigma = 0.0;
      }
      place.speed = place.ceiling();
    }
    make_feasible(profile.places, profile.step_m, profile.closed, options);
  }
  agree_at_intersections(profiles, options);
}

}  // namespace roadbook
