#pragma once

#include <string>

#include "semantics/labels/labels.hpp"

namespace roadbook {

inline constexpr std::size_t kMostCorners = 1000;  ///< of a polygon

/// Throws BadInput: `source`, `field` of it, what it holds and what it should.
[[noreturn]] void refuse_label(const std::string& source,
                               const std::string& field,
                               const std::string& got,
                               const std::string& want);

/// Contradictions in a label: a side that is not positive, a polygon that crosses itself, a value
/// that is no number, an empty kind. Throws BadInput naming `source`.
void check_label(const Label& label, const std::string& source);

/// The same of a label that is to be stored, and what older programs let pass: a polygon that
/// touches itself or has no area, a kind with control characters. Throws BadInput naming `source`.
void check_new_label(const Label& label, const std::string& source);

/// Whether the map has what a label hangs on: a keyframe; of a window, an image of a session.
/// Throws BadInput naming `source`.
void check_label_anchor(const Map& map, const Label& label, const std::string& source);

/// What a search said of a label, it said of the class that it looked for: a label that somebody
/// has given another class is from then on as one drawn by hand.
void forget_other_search(const Label& before, Label& label);

}  // namespace roadbook
