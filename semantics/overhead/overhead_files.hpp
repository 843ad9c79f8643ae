#pragma once

#include <filesystem>

#include "base/progress.hpp"
#include "semantics/overhead/overhead_input.hpp"
#include "semantics/overhead/overhead_options.hpp"
#include "semantics/overhead/overhead_summary.hpp"
#include "semantics/overhead/tile_store.hpp"

namespace roadbook {

/// Writes layers and tables of all tiles with content to folder `out`, and sets paths, extent and
/// coverage of `summary`. Throws Refused if no pixel was observed; StorageError.
void write_overhead(const OverheadInput& input,
                    const std::filesystem::path& out,
                    const OverheadOptions& options,
                    const Progress& progress,
                    TileStore* store,
                    OverheadSummary* summary);

}  // namespace roadbook
