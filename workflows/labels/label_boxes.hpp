#pragma once

#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "semantics/labels/label_store.hpp"
#include "semantics/oriented_box.hpp"

namespace roadbook {

/// The training examples that labels of a class give a detector: boxes in the map.
struct LabelBoxes {
  std::vector<OrientedBox> positives;
  std::vector<OrientedBox> negatives;  ///< rejected boxes

  /// Adds the label if it is of that class or rejected as one, and not deleted.
  void add(const Map& map, const Label& label, const std::string& kind);
};

/// Returns the boxes after `events`, the first events of a map, in the order of label numbers.
[[nodiscard]] LabelBoxes label_boxes(const Map& map,
                                     const std::vector<LabelEvent>& events,
                                     const std::string& kind);

}  // namespace roadbook
