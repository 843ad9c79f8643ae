#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "mapping/layers/map_layers.hpp"
#include "semantics/labels/label_evidence.hpp"

namespace roadbook {

// Further measurements of label positions (Label::sightings) as stored in the map file: table
// `label_sightings`, one row each. They are computed from images, so no event records them, and
// they can be computed again.

struct StoredSighting {
  std::int64_t label = 0;
  std::int64_t version = 0;  ///< of the label whose shape was found
  LabelSighting sighting;
};

/// The newest sighting of each label in each session: stored ones, updated by new searches.
class SightingRecord {
 public:
  explicit SightingRecord(const std::vector<StoredSighting>& stored = {});
  /// Updates the record with the result of a search in a session's images: stores the sighting if
  /// the label was found, removes it if it was not. kUnseen changes nothing. Returns whether the
  /// record changed.
  bool take(const Map& map, const Label& label, int session, const LabelEvidence& evidence);
  /// Sorted by label, then session.
  [[nodiscard]] std::vector<StoredSighting> sightings() const;

 private:
  std::map<std::pair<std::int64_t, int>, StoredSighting> sightings_;
};

/// Searches all labels on the ground in the images of every other session (`look_again`). Throws
/// Interrupted.
void look_for_sightings(const Map& map,
                        const std::vector<Label>& labels,
                        const KeyframeImages& images,
                        SightingRecord& record,
                        const Progress& progress = {});

[[nodiscard]] PlainTable label_sightings_table(const std::vector<StoredSighting>& sightings);
/// Empty if the map has no such table. Throws BadInput for an invalid row.
[[nodiscard]] std::vector<StoredSighting> read_label_sightings(const MapLayers& layers);

/// Adds each sighting to its label. Sightings of an older version of the label are ignored.
void add_sightings(const std::vector<StoredSighting>& sightings, std::vector<Label>& labels);

}  // namespace roadbook
