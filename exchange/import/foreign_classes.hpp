#pragma once

#include <string>

#include "exchange/import/label_readers.hpp"

namespace roadbook {

/// Renames the classes of a file's outlines to the names in the map. A name that differs from a
/// class of the map in case, blanks, dashes or a plural s alone is that class. `not_X` is left out
/// where X is a class of the map: there, `not_X` means a rejection. Any other `not_X` becomes
/// `is_not_X`, because the map would read `not_X` as a rejection. `file.notes` lists each change of
/// a name once.
void name_foreign_classes(const MapLayers& layers, const std::string& source, LabelFile& file);

}  // namespace roadbook
