#pragma once

#include <filesystem>
#include <vector>

#include "base/progress.hpp"
#include "mapping/pipeline/build_summary.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

// Builds a map file from recorded drives [metric-semantic maps, section IV]. `build_map` runs all
// stages (mapping/pipeline/map_stages.hpp) and saves a checkpoint after the long ones.

/// Builds the map file `map` from `drives`; each drive becomes a session. Checkpoints go to
/// MAP.part: an interrupted run resumes there and ends with the same content.
///
/// A map made from the same drives, options, seed and version of the program is not built again,
/// unless `options.replace`; only the paths of its drives are renewed. Layers and tables of an
/// existing map are kept if all poses are the same bit for bit. Otherwise only the tables in
/// `keep_tables` are kept, and `MapSummary::dropped` names the others.
///
/// Throws BadInput (a drive cannot be read; the map is damaged, or its drives are not the first of
/// `drives` and `replace` is not set), Refused (too little evidence: MapGateOptions), StorageError,
/// Interrupted. A refused build leaves the existing map as it is.
MapSummary build_map(const std::vector<std::filesystem::path>& drives,
                     const std::filesystem::path& map,
                     const MapOptions& options,
                     const Progress& progress = {});

}  // namespace roadbook
