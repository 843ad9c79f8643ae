#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "speedmap/items/layer_item.hpp"
#include "speedmap/speeds/lane_speeds.hpp"

namespace roadbook {

// The effect of items on the speeds of a place. The weight w of an item is the probability that the
// item still holds. As for the presence of people [metric-semantic maps, sec. V-C], the recommended
// speed is linear in that probability:
//     v = w v_item + (1 - w) v_without
// The factor of friction is linear as well:
//     f = w f_item + (1 - w)

/// The effect of all items at a point.
struct EffectAt {
  double speed = 0.0;  ///< [m/s]; infinite: no item slows
  /// Of that speed, because the item may have ended: sqrt(w (1 - w)) |v_item - v_without|.
  double sigma = 0.0;
  double grip_factor = 1.0;  ///< of friction; the least of all items
};

/// The items that are used at a time. Immutable.
class ItemEffects {
 public:
  /// Stale, expired and later items are left out. `options` give the least speed.
  ItemEffects(const std::vector<LayerItem>& items,
              std::int64_t now_ns,
              const LaneSpeedOptions& options);

  [[nodiscard]] bool empty() const { return items_.empty(); }
  /// The effect at `p` [m, map frame] on a vehicle that covers `half_width_m` around it and would
  /// go at `speed_without` [m/s].
  [[nodiscard]] EffectAt at(const Eigen::Vector2d& p,
                            double half_width_m,
                            double speed_without) const;
  /// Items that hold at `p`, in the order they were put.
  [[nodiscard]] std::vector<const LayerItem*> holding(const Eigen::Vector2d& p,
                                                      double half_width_m) const;
  [[nodiscard]] double weight(const LayerItem& item) const { return item.weight(now_ns_); }

 private:
  struct Used {
    LayerItem item;
    Eigen::Vector2d low, high;  ///< box of the geometry and its reach
    double weight;
  };
  template <typename Visit>
  void for_each_at(const Eigen::Vector2d& p, double half_width_m, const Visit& visit) const;

  std::vector<Used> items_;
  std::int64_t now_ns_;
  double min_speed_;
};

/// Sets `item`, `item_sigma`, `item_grip` and `speed` of every position from the items, and
/// makes the profiles feasible. `limit`, `pedestrian`, `bend` and `grip` stay: they are those
/// without items.
void apply_items(std::vector<LaneProfile>& profiles,
                 const ItemEffects& effects,
                 const LaneSpeedOptions& options);

}  // namespace roadbook
