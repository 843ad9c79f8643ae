#pragma once

#include <string>
#include <vector>

#include "exchange/import/label_matching.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {

struct NewLabels {
  std::vector<Label> created;
  std::vector<Label> changed;
};

/// Creates labels from the outlines of a file. Each label refers to the images of the map that show
/// its ground best. A rectangle becomes a box where the file does not call it a polygon and its
/// class has boxes. Messages give `file` as the file. Throws BadInput naming each outline that no
/// image shows whole.
[[nodiscard]] NewLabels labels_of_outlines(const Map& map,
                                           const MatchedLabels& matched,
                                           const std::vector<LabelClass>& classes,
                                           const std::string& file);

}  // namespace roadbook
