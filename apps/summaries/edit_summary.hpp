#pragma once

#include "apps/console.hpp"
#include "workflows/edits/edit_map.hpp"

namespace roadbook {

/// Prints the edits of a map, and what the command moved unless it only lists them.
void print_edits(const Console& console, const EditResult& result, bool only_lists);

}  // namespace roadbook
