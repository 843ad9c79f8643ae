#include "speedmap/presence/map_ages.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr double kMinute = 60.0;
constexpr double kHour = 3600.0;
constexpr double kWeek = 7.0 * 24.0 * kHour;

}  // namespace

const char* to_text(AgeLayer layer) {
  switch (layer) {
    case AgeLayer::kStatic:
      return "static";
    case AgeLayer::kSemiStatic:
      return "semi-static";
    case AgeLayer::kSemiDynamic:
      return "semi-dynamic";
    case AgeLayer::kDynamic:
      break;
  }
  return "dynamic";
}

AgeLayer AgedItem::layer() const {
  if (half_life_s <= 0.0 || half_life_s > kWeek) return AgeLayer::kStatic;
  if (half_life_s > kHour) return AgeLayer::kSemiStatic;
  return half_life_s > kMinute ? AgeLayer::kSemiDynamic : AgeLayer::kDynamic;
}

double AgedItem::weight(std::int64_t now_ns) const {
  if (half_life_s <= 0.0 || now_ns <= date_ns) return 1.0;
  return std::exp2(-1e-9 * static_cast<double>(now_ns - date_ns) / half_life_s);
}

bool AgedItem::stale(std::int64_t now_ns) const {
  return half_life_s > 0.0 && 1e-9 * static_cast<double>(now_ns - date_ns) > half_life_s;
}

void AgedLayers::put(const AgedItem& item) {
  if (!(std::isfinite(item.half_life_s) && item.half_life_s >= 0.0))
    throw InvalidOption("half_life_s", std::to_string(item.half_life_s), "0 or more");
  const auto same = std::find_if(items_.begin(), items_.end(),
                                 [&](const AgedItem& other) { return other.name == item.name; });
  if (same != items_.end())
    *same = item;
  else
    items_.push_back(item);
}

const AgedItem* AgedLayers::find(const std::string& name) const {
  for (const AgedItem& item : items_)
    if (item.name == name) return &item;
  return nullptr;
}

std::vector<AgedItem> AgedLayers::of(AgeLayer layer) const {
  std::vector<AgedItem> result;
  for (const AgedItem& item : items_)
    if (item.layer() == layer) result.push_back(item);
  return result;
}

std::vector<AgedItem> AgedLayers::all() const {
  std::vector<AgedItem> result;
  for (const AgeLayer layer :
       {AgeLayer::kStatic, AgeLayer::kSemiStatic, AgeLayer::kSemiDynamic, AgeLayer::kDynamic})
    for (const AgedItem& item : of(layer)) result.push_back(item);
  return result;
}

}  // namespace roadbook
