#pragma once

#include "apps/console.hpp"
#include "mapping/sessions/curate_map.hpp"

namespace roadbook {

/// Prints what a curation kept, or would keep.
void print_curation(const Console& console, const CurateSummary& summary, bool dry_run);

}  // namespace roadbook
