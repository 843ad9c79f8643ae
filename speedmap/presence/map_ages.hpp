#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace roadbook {

// The content of a map grows old ([environment representation]: static, semi-static, semi-dynamic,
// dynamic layers). The source orders layers by how often they change. It puts weather into two of
// them, and traffic signs into the layer of pedestrians. Therefore age is kept by item, and
// the layer of an item follows from its half-life.

enum class AgeLayer : std::uint8_t {
  kStatic,       ///< months: lanes, walls
  kSemiStatic,   ///< hours: planned changes, wet ground
  kSemiDynamic,  ///< minutes: road works, queues
  kDynamic,      ///< real time: vehicles, pedestrians, signals
};
[[nodiscard]] const char* to_text(AgeLayer layer);

/// An item of a map, the time of its last confirmation, and its rate of decay.
struct AgedItem {
  std::string name;
  std::int64_t date_ns = 0;  ///< since 1970
  double half_life_s = 0.0;  ///< 0: never fades

  /// By half-life: up to a minute dynamic, up to an hour semi-dynamic, up to a week semi-static;
  /// longer, or never fading, static.
  [[nodiscard]] AgeLayer layer() const;
  /// 1 when new, halved with every half-life; 1 for items dated after `now_ns`.
  [[nodiscard]] double weight(std::int64_t now_ns) const;
  /// Older than its own half-life.
  [[nodiscard]] bool stale(std::int64_t now_ns) const;
};

/// Items by layer, static first, in the order they were added within a layer.
class AgedLayers {
 public:
  /// Adds the item, or replaces the item of the same name. Throws InvalidOption for a half-life
  /// that is negative or not finite.
  void put(const AgedItem& item);
  [[nodiscard]] const AgedItem* find(const std::string& name) const;
  [[nodiscard]] std::vector<AgedItem> of(AgeLayer layer) const;
  [[nodiscard]] std::vector<AgedItem> all() const;

 private:
  std::vector<AgedItem> items_;
};

}  // namespace roadbook
