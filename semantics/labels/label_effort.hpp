#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

#include "semantics/labels/label_replay.hpp"

namespace roadbook {

// Effort of labelling, computed from the map's event log: labels drawn, hypotheses answered, clicks
// and time.

/// Kind of a labelling step. A step is everything that one request stored.
enum class LabelStep { kDraw, kFill, kAccept, kReject, kChange, kDelete, kUndo };

[[nodiscard]] constexpr const char* to_text(LabelStep step) {
  switch (step) {
    case LabelStep::kDraw:
      return "draw";
    case LabelStep::kFill:
      return "fill";
    case LabelStep::kAccept:
      return "accept";
    case LabelStep::kReject:
      return "reject";
    case LabelStep::kChange:
      return "change";
    case LabelStep::kDelete:
      return "delete";
    case LabelStep::kUndo:
      return "undo";
  }
  return "";
}

inline constexpr std::array kLabelSteps{LabelStep::kDraw,   LabelStep::kFill,   LabelStep::kAccept,
                                        LabelStep::kReject, LabelStep::kChange, LabelStep::kDelete,
                                        LabelStep::kUndo};

/// Longest time counted between two steps of a labeller; a longer pause counts as this long. [s]
inline constexpr double kLongestPauseS = 60.0;

struct LabelEffort {
  std::size_t labels = 0;    ///< active labels, without rejections and done images
  std::size_t drawn = 0;     ///< boxes, polygons and people drawn by hand, also if deleted later
  std::size_t filled = 0;    ///< boxes made by filling or extending a row, also if deleted later
  std::size_t imported = 0;  ///< stored by `roadbook import` or another program, not by the page
  std::size_t accepted = 0;  ///< hypotheses accepted
  std::size_t rejected = 0;  ///< hypotheses rejected
  std::size_t images = 0;    ///< images in which all people were said to be labelled
  std::size_t changes = 0;   ///< changes of shape or class, deletions, undos
  /// Smallest number of clicks and keys for the steps, by kind of step: three for a box, one for
  /// each corner of a polygon plus one to close it, two for a person, one for every other step,
  /// however many labels it stored.
  std::map<LabelStep, std::size_t> clicks{};
  /// Sum of the times between successive steps of each labeller, each limited to kLongestPauseS. A
  /// labeller's first step adds nothing.
  double seconds = 0.0;

  [[nodiscard]] std::size_t all_clicks() const;
};

struct LabelLedger {
  std::map<std::string, LabelEffort> classes;  ///< by class; rejections count for their class X
  LabelEffort all;                             ///< all classes, and changes of the list of classes
};

/// Effort for all labels, on the ground and in images. Linear in the number of events.
[[nodiscard]] LabelLedger label_effort(const LabelReplay& replay);

}  // namespace roadbook
