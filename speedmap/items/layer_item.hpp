#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "speedmap/presence/map_ages.hpp"

namespace roadbook {

// Items of a place that change faster than its map ([environment representation]: layers of four
// ages): vehicles, queues, road works, weather, planned changes, roads. Each has the time of its
// observation and a half-life.

/// What an item does to the speed near it.
enum class ItemEffect : std::uint8_t {
  kSlow,   ///< the vehicle goes no faster than the speed of the item
  kGrip,   ///< friction is multiplied by a factor
  kSpeed,  ///< as kSlow; the item must name its speed
};

/// A kind of item and its defaults.
struct ItemKind {
  const char* name;
  double half_life_s;
  ItemEffect effect;
  double reach_m;  ///< of points and lines: distance to which the item holds
};
/// All kinds, from the fastest to the slowest.
[[nodiscard]] const std::vector<ItemKind>& item_kinds();
/// Null for an unknown name.
[[nodiscard]] const ItemKind* find_item_kind(const std::string& name);

enum class ItemShape : std::uint8_t { kPoint, kLine, kPolygon };
[[nodiscard]] const char* to_text(ItemShape shape);
[[nodiscard]] std::optional<ItemShape> item_shape(const std::string& text);

/// Whether an item is used at some time.
enum class ItemState : std::uint8_t {
  kUsed,
  kStale,    ///< older than its half-life: its weight is below kLeastItemWeight
  kExpired,  ///< marked as no longer used
  kLater,    ///< observed after that time
};
[[nodiscard]] const char* to_text(ItemState state);

inline constexpr double kLeastItemWeight = 0.5;   ///< below, an item is stale
inline constexpr double kWetGripFactor = 0.7;     ///< of weather that names no `grip_factor`
inline constexpr double kFarthestItem_m = 100e3;  ///< of a corner from the map's origin

struct LayerItem {
  std::int64_t id = 0;  ///< in the order they were put, from 0
  std::string kind;     ///< of `item_kinds`
  ItemShape shape = ItemShape::kPoint;
  /// Map frame [m]. Points, lines, or rings that need no closing point; a ring within another is a
  /// hole.
  std::vector<std::vector<Eigen::Vector2d>> parts;
  double reach_m = 0.0;               ///< distance from the geometry to which the item holds
  std::int64_t observed_ns = 0;       ///< since 1970
  double half_life_s = 0.0;           ///< above 0
  std::optional<double> speed;        ///< [m/s]; empty: the least speed of the speed map
  std::optional<double> grip_factor;  ///< 0 to 1
  std::string note;
  std::int64_t recorded_ns = 0;              ///< when it was put into the map
  std::optional<std::int64_t> expired_ns{};  ///< when it was marked as no longer used

  /// "road_works 3": the name of the item in messages and in `layer_ages`.
  [[nodiscard]] std::string name() const;
  /// Its age class follows from the half-life.
  [[nodiscard]] AgedItem aged() const { return {name(), observed_ns, half_life_s}; }
  /// 2^(-age / half-life): the probability that the item still holds, if items end at random.
  [[nodiscard]] double weight(std::int64_t now_ns) const { return aged().weight(now_ns); }
  [[nodiscard]] ItemState state(std::int64_t now_ns) const;
  /// Distance [m] from the geometry; 0 in a polygon.
  [[nodiscard]] double distance_m(const Eigen::Vector2d& p) const;
};

/// The time for which items count where a user names none: the later of `now_ns` and the newest
/// time at which an item was put or marked.
[[nodiscard]] std::int64_t time_of_items(const std::vector<LayerItem>& items, std::int64_t now_ns);

}  // namespace roadbook
