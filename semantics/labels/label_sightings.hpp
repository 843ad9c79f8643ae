#pragma once

#include <map>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "mapping/layers/map_layers.hpp"
#include "semantics/labels/label_evidence.hpp"

namespace roadbook {

// Further anchors of labels (Label::sightings), as the map file keeps them: table
// `label_sightings`, a row each. They are measured, nobody's word: no event tells of them, and they
// are found anew at any time.

struct StoredSighting {
  std::int64_t label = 0;
  std::int64_t version = 0;  ///< of the label, whose shape was found
  LabelSighting sighting;
};

/// What is known of further anchors, one a label and session: what was stored, and what looking
/// again makes of it.
class SightingRecord {
 public:
  explicit SightingRecord(const std::vector<StoredSighting>& stored = {});
  /// The newest look into a session's images stands: where the label was found in them, or that it
  /// was not. Images that are not at hand, or do not show the place, leave what is known. Whether
  /// that has changed.
  bool take(const Map& map, const Label& label, int session, const LabelEvidence& evidence);
  /// By label and session.
  [[nodiscard]] std::vector<StoredSighting> sightings() const;

 private:
  std::map<std::pair<std::int64_t, int>, StoredSighting> sightings_;
};

/// Looks for all things that labels show in the images of every session but the one they hang on
/// (`look_again`). Throws Interrupted.
void look_for_sightings(const Map& map,
                        const std::vector<Label>& labels,
                        const KeyframeImages& images,
                        SightingRecord& record,
                        const Progress& progress = {});

[[nodiscard]] PlainTable label_sightings_table(const std::vector<StoredSighting>& sightings);
/// Empty where the map has none. Throws BadInput for rows that are none.
[[nodiscard]] std::vector<StoredSighting> read_label_sightings(const MapLayers& layers);

/// Gives labels the sightings of their version: one that somebody has changed since has none.
void add_sightings(const std::vector<StoredSighting>& sightings, std::vector<Label>& labels);

}  // namespace roadbook
