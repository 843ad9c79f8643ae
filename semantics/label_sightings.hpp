#pragma once

#include <vector>

#include "base/progress.hpp"
#include "mapping/map_layers.hpp"
#include "semantics/label_evidence.hpp"

namespace roadbook {

// Further anchors of labels (Label::sightings), as the map file keeps them: table
// `label_sightings`, a row each. They are measured, nobody's word: no event tells of them, and they
// are found anew at any time.

struct StoredSighting {
  std::int64_t label = 0;
  std::int64_t version = 0;  ///< of the label, whose shape was found
  LabelSighting sighting;
};

/// Looks for all things that labels show in the images of every session but the one they hang on
/// (`look_again`), and tells where they were found; by label and session. Throws Interrupted.
[[nodiscard]] std::vector<StoredSighting> find_sightings(const Map& map,
                                                         const std::vector<Label>& labels,
                                                         const KeyframeImages& images,
                                                         const Progress& progress = {});

[[nodiscard]] PlainTable label_sightings_table(const std::vector<StoredSighting>& sightings);
/// Empty where the map has none. Throws BadInput for rows that are none.
[[nodiscard]] std::vector<StoredSighting> read_label_sightings(const MapLayers& layers);

/// Gives labels the sightings of their version: one that somebody has changed since has none.
void add_sightings(const std::vector<StoredSighting>& sightings, std::vector<Label>& labels);

}  // namespace roadbook
