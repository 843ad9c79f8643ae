#pragma once

#include <vector>

#include "base/error.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// Contradictions between the R-trees of a map and themselves (SQLite's `rtreecheck`) or the
/// geometries that they index: entries without a feature, features without an entry, and bounds
/// other than those of the geometry. At most one problem an R-tree.
[[nodiscard]] std::vector<Problem> rtree_problems(const SqlDatabase& database);

}  // namespace roadbook
