#pragma once

#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "semantics/labels/label_store.hpp"
#include "semantics/oriented_box.hpp"

namespace roadbook {

/// What labels of a class teach a detector: boxes in the map.
struct LabelBoxes {
  std::vector<OrientedBox> positives;
  std::vector<OrientedBox> negatives;  ///< that were rejected

  /// Takes the label where it is of that class, or rejected as one, and not deleted.
  void add(const Map& map, const Label& label, const std::string& kind);
};

/// By the labels' numbers, as they stand after `events`, the first ones of a map.
[[nodiscard]] LabelBoxes label_boxes(const Map& map,
                                     const std::vector<LabelEvent>& events,
                                     const std::string& kind);

}  // namespace roadbook
