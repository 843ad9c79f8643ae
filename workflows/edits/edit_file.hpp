#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mapping/edits/map_edit.hpp"

namespace roadbook {

// Files of edits (docs/guide/map_life.md, "Correct a map by hand"): a list `edits` of mappings with
// one of the keys loop, same_points, not_a_loop and anchor; or one such key alone.

/// Throws BadInput with all faults of the file.
[[nodiscard]] std::vector<MapEdit> read_edit_file(const std::filesystem::path& file);
/// The same from text; messages give `name` as the file.
[[nodiscard]] std::vector<MapEdit> parse_edits(const std::string& text, const std::string& name);

/// The edit as the text of a file that holds it alone; `parse_edits` reads it back to the bit.
[[nodiscard]] std::string edit_yaml(const MapEdit& edit);

}  // namespace roadbook
