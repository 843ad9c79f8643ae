#pragma once

#include <vector>

#include "mapping/pipeline/parking_row_prior.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// Rows of equal parking spaces among a map's labels, for mapping/pipeline/parking_row_prior.hpp.
//
// Spaces side by side that point the same way are a chain; a row is a stretch of it in which each
// next space lies where the ones before it lead, give or take what hands and paint explain. Judged
// is from neighbour to neighbour: a bent map is straight over 15 m, and its rows are wanted most.

struct SpaceRowOptions {
  std::size_t min_spaces = 5;
  /// A chain of which rows take less than this part is irregular, and none of it is used.
  double min_share = 0.6;
  int max_step = 3;           ///< a pillar or two spaces without label between two of a row
  double max_sigmas = 3.0;    ///< of a space from where the row leads
  EqualRowOptions paint{};    ///< what is unequal in the best of rows
  double max_turn_rad = 0.1;  ///< between neighbours, beside their headings' sigma

  /// Throws InvalidOption.
  void check() const;
};

/// The rows among active boxes of class `parking_space`; `pose` of a view is a keyframe of `map`,
/// of which keyframes and map frames are asked alone. Labels whose image is no keyframe are left
/// out, and further anchors (`Label::sightings`) likewise. In the order of the first space's label;
/// n log n in the number of labels.
[[nodiscard]] std::vector<EqualRow> space_rows(const Map& map,
                                               const std::vector<Label>& labels,
                                               const SpaceRowOptions& options = {});

}  // namespace roadbook
