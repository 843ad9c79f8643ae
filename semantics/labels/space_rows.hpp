#pragma once

#include <vector>

#include "mapping/pipeline/parking_row_prior.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// Finds rows of equal parking spaces among labels, for mapping/pipeline/parking_row_prior.hpp.
//
// A chain is a sequence of adjacent spaces with the same heading. A row is a part of a chain in
// which each space lies where the last few spaces predict it, within the errors of drawing and
// paint. The prediction is local because a distorted map is still straight over 15 m, and distorted
// maps need the rows most.

struct SpaceRowOptions {
  std::size_t min_spaces = 5;
  /// A chain is dropped as irregular if its rows contain less than this share of its spaces.
  double min_share = 0.6;
  int max_step = 3;           ///< largest step in a row: up to two spaces may lack a label
  double max_sigmas = 3.0;    ///< largest deviation from the predicted position
  EqualRowOptions paint{};    ///< irregularity of the paint in a regular row
  double max_turn_rad = 0.1;  ///< largest turn between neighbours, plus the sigma of their headings

  /// Throws InvalidOption.
  void check() const;
};

/// Rows among the active boxes of class `parking_space`, in the order of their first space's label.
/// `pose` of a view is a keyframe index of `map`. Labels and sightings whose image is no keyframe
/// are left out. Cost: n log n in the number of labels.
[[nodiscard]] std::vector<EqualRow> space_rows(const Map& map,
                                               const std::vector<Label>& labels,
                                               const SpaceRowOptions& options = {});

}  // namespace roadbook
