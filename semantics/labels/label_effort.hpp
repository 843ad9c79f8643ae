#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

#include "semantics/labels/label_replay.hpp"

namespace roadbook {

// What the labels of a map took to make, from its list of events: what was drawn and answered, with
// how many clicks, in how long.

/// What a step of a labeller is: all that one request has stored.
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

/// Between two steps of a labeller no more is counted: a longer pause is none of the work. [s]
inline constexpr double kLongestPauseS = 60.0;

struct LabelEffort {
  std::size_t labels = 0;    ///< things and people there now
  std::size_t drawn = 0;     ///< boxes, polygons, people drawn by hand, deleted ones too
  std::size_t filled = 0;    ///< boxes of rows that were filled or gone on with, deleted ones too
  std::size_t imported = 0;  ///< stored by no page: `roadbook import`, or another program
  std::size_t accepted = 0;  ///< hypotheses accepted and rejected
  std::size_t rejected = 0;
  std::size_t images = 0;   ///< said to show nobody else
  std::size_t changes = 0;  ///< of shape or class, deletions, undos
  /// Clicks and keys that the steps took at least, by kind of step: a box three, a polygon one a
  /// corner and one to end it, a person two, every other step one, however many labels it stored.
  std::map<LabelStep, std::size_t> clicks{};
  /// From one step of a labeller to the next, no longer than kLongestPauseS each; their first step
  /// counts nothing.
  double seconds = 0.0;

  [[nodiscard]] std::size_t all_clicks() const;
};

struct LabelLedger {
  std::map<std::string, LabelEffort> classes;  ///< rejections of a class are with the class
  LabelEffort all;                             ///< changes of the list of classes too
};

/// Of all labels, on the ground and in images. Linear in the number of events.
[[nodiscard]] LabelLedger label_effort(const LabelReplay& replay);

}  // namespace roadbook
