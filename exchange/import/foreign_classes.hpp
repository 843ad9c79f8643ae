#pragma once

#include <string>

#include "exchange/import/label_readers.hpp"

namespace roadbook {

/// Gives the outlines of a file the names that the map has for their classes.
///
/// A name that differs from a class of the map in case, blanks, dashes or a plural s alone is that
/// class. `not_X` is left out where X is a class of the map: it means a rejection there, which is
/// no thing. Any other `not_X` becomes `is_not_X`, as the map would take `not_X` for a rejection.
/// Each change of a name is told once, in `file.notes`.
void name_foreign_classes(const MapLayers& layers, const std::string& source, LabelFile& file);

}  // namespace roadbook
