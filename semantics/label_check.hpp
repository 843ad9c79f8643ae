#pragma once

#include <string>

#include "semantics/labels.hpp"

namespace roadbook {

/// Contradictions in a label: a side that is not positive, a polygon that crosses itself, a value
/// that is no number, an empty kind. Throws BadInput naming `source`.
void check_label(const Label& label, const std::string& source);

/// Whether the map has what a label hangs on: a keyframe; of a window, an image of a session.
/// Throws BadInput naming `source`.
void check_label_anchor(const Map& map, const Label& label, const std::string& source);

}  // namespace roadbook
