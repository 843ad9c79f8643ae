#pragma once

#include <string>

#include "semantics/labels/labels.hpp"

namespace roadbook {

inline constexpr std::size_t kMostCorners = 1000;  ///< largest number of corners of a polygon

/// Throws BadInput that names `source`, the `field`, the value found and the value expected.
[[noreturn]] void refuse_label(const std::string& source,
                               const std::string& field,
                               const std::string& got,
                               const std::string& want);

/// Checks that a label is consistent: sides above zero, a polygon that does not cross itself,
/// finite values, a class. Throws BadInput naming `source`.
void check_label(const Label& label, const std::string& source);

/// `check_label` and, for a label that is to be stored, further rules that older programs did not
/// enforce: a polygon must have an area and must not touch itself; a class has no control
/// characters. Throws BadInput naming `source`.
void check_new_label(const Label& label, const std::string& source);

/// Checks that the map has a pose for the label's anchor; for a window label, that the session and
/// camera exist and the stamp lies within the session. Throws BadInput naming `source`.
void check_label_anchor(const Map& map, const Label& label, const std::string& source);

/// Removes the detector's score if the class has changed: the score belongs to the class that the
/// search looked for. The label then counts as drawn by hand.
void forget_other_search(const Label& before, Label& label);

}  // namespace roadbook
