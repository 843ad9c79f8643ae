#pragma once

#include <optional>
#include <vector>

#include "exchange/import/label_readers.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {

// Which outlines of a file are labels that the map has already.

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

/// Sorts the outlines of a file by what the map has.
///
/// - An outline that names a label of this map (`identity`: number, version and the time of that
///   version are those of one of the label's events) is that label. It is there already where it
///   lies as the label does, within the rounding of its file and how far the map has moved since
///   somebody saw the label; it is an edit where class, note or shape are others. It is left out
///   where somebody has changed the label since the file was written and the file changes it too.
///   A number without a time is believed where both overlap by half.
/// - Any other outline is compared with the labels of its class: it is there already where one lies
///   within its file's rounding (or, of an upright box, is surrounded by it so); it is left out
///   where one overlaps with it by half or more, as a twin must not lie on its twin.
///
/// `cut_at`: what an export has cut at the edge of this picture is there too. Twice in a file is
/// once.
[[nodiscard]] MatchedLabels match_outlines(const Map& map,
                                           const std::vector<LabelEvent>& events,
                                           const std::vector<Label>& labels,
                                           const std::optional<PicturePlace>& cut_at,
                                           const std::string& file,
                                           std::vector<LabelOutline> outlines);

}  // namespace roadbook
