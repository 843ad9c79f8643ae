#include "speedmap/items/layer_item.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/geometry/outline.hpp"

namespace roadbook {
namespace {

constexpr double kMinute_s = 60.0;
constexpr double kHour_s = 3600.0;
constexpr double kDay_s = 86400.0;

constexpr std::array<std::pair<ItemShape, const char*>, 3> kShapes{
    {{ItemShape::kPoint, "point"}, {ItemShape::kLine, "line"}, {ItemShape::kPolygon, "polygon"}}};

// A ring within a ring is a hole.
bool is_in_rings(const Eigen::Vector2d& p, const std::vector<std::vector<Eigen::Vector2d>>& rings) {
  return std::count_if(rings.begin(), rings.end(),
                       [&](const auto& ring) { return is_inside(ring, p); }) %
             2 ==
         1;
}

}  // namespace

const std::vector<ItemKind>& item_kinds() {
  static const std::vector<ItemKind> kinds{
      {"vehicle", 20.0, ItemEffect::kSlow, 3.0},
      {"pedestrian", 20.0, ItemEffect::kSlow, 3.0},
      {"queue", 10.0 * kMinute_s, ItemEffect::kSlow, 5.0},
      {"accident", 30.0 * kMinute_s, ItemEffect::kSlow, 10.0},
      {"weather", 30.0 * kMinute_s, ItemEffect::kGrip, 1000.0},
      {"road_works", kHour_s, ItemEffect::kSlow, 5.0},
      {"weather_forecast", 6.0 * kHour_s, ItemEffect::kGrip, 1000.0},
      {"planned_change", 12.0 * kHour_s, ItemEffect::kSpeed, 3.0},
      {"road_change", 90.0 * kDay_s, ItemEffect::kSpeed, 3.0}};
  return kinds;
}

const ItemKind* find_item_kind(const std::string& name) {
  for (const ItemKind& kind : item_kinds())
    if (name == kind.name) return &kind;
  return nullptr;
}

const char* to_text(ItemShape shape) {
  for (const auto& [one, text] : kShapes)
    if (one == shape) return text;
  return "";
}

std::optional<ItemShape> item_shape(const std::string& text) {
  for (const auto& [one, name] : kShapes)
    if (text == name) return one;
  return std::nullopt;
}

const char* to_text(ItemState state) {
  switch (state) {
    case ItemState::kUsed:
      return "used";
    case ItemState::kStale:
      return "stale";
    case ItemState::kExpired:
      return "expired";
    case ItemState::kLater:
      break;
  }
  return "later";
}

std::string LayerItem::name() const { return kind + " " + std::to_string(id); }

ItemState LayerItem::state(std::int64_t now_ns) const {
  if (observed_ns > now_ns) return ItemState::kLater;
  if (expired_ns && *expired_ns <= now_ns) return ItemState::kExpired;
  return weight(now_ns) < kLeastItemWeight ? ItemState::kStale : ItemState::kUsed;
}

double LayerItem::distance_m(const Eigen::Vector2d& p) const {
  if (shape == ItemShape::kPolygon && is_in_rings(p, parts)) return 0.0;
  double nearest = INFINITY;
  for (const auto& part : parts) {
    if (part.size() == 1) nearest = std::min(nearest, (p - part.front()).norm());
    for (std::size_t i = 1; i < part.size(); ++i)
      nearest = std::min(nearest, distance_to_segment(p, part[i - 1], part[i]));
    if (shape == ItemShape::kPolygon && part.size() > 2)
      nearest = std::min(nearest, distance_to_segment(p, part.back(), part.front()));
  }
  return nearest;
}

std::int64_t time_of_items(const std::vector<LayerItem>& items, std::int64_t now_ns) {
  for (const LayerItem& item : items)
    now_ns = std::max({now_ns, item.recorded_ns, item.expired_ns.value_or(now_ns)});
  return now_ns;
}

}  // namespace roadbook
