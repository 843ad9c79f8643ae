#pragma once

#include <optional>
#include <vector>

#include "exchange/import/label_readers.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {

// Matches the outlines of a file with the labels of the map.

/// An outline that changes a label of the map.
struct LabelEdit {
  Label before;  ///< as stored
  LabelOutline outline;
  bool shape = false;  ///< the shape is another; else the class or the note alone
};

struct MatchedLabels {
  std::vector<LabelOutline> fresh;
  std::vector<LabelEdit> edits;
  std::size_t already = 0;  ///< were in the map, or earlier in the file
  std::vector<LabelsLeftOut> left_out;
};

/// Compares the outlines of a file with the labels of the map.
///
/// - An outline that names a label of this map (`identity`: number, version and the time of that
///   version are those of one of the label's events) is that label. It is unchanged if it lies as
///   the label does, within the rounding of its file and the map's movement since a user saw the
///   label. It is an edit if class, note or shape differ. It is left out if a user has changed the
///   label since the file was written and the file changes it too. A number without a time is
///   accepted if both overlap by half.
/// - Any other outline is compared with the labels of its class. It is known if a label lies within
///   its file's rounding (or, for an upright box, is surrounded by it within the rounding). It is
///   left out if a label overlaps it by half or more.
///
/// `cut_at`: labels that an export has cut at the edge of this picture are known too. Duplicates in
/// a file count once.
[[nodiscard]] MatchedLabels match_outlines(const Map& map,
                                           const std::vector<LabelEvent>& events,
                                           const std::vector<Label>& labels,
                                           const std::optional<PicturePlace>& cut_at,
                                           const std::string& file,
                                           std::vector<LabelOutline> outlines);

}  // namespace roadbook
