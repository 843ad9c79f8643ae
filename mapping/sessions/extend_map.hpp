#pragma once

#include <filesystem>
#include <string>

#include "base/progress.hpp"
#include "mapping/pipeline/build_summary.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

/// Extends the map file `map` by the drive in `folder` as a further session [metric-semantic maps,
/// sections IV-B and IV-C]: the drive is localised in the map, its corners become views of the
/// map's landmarks or new landmarks, and both are adjusted from stored observations. No recording
/// of an earlier session is read. Map frames never move; the first build fixed them.
///
/// Checkpoints go to MAP.part: an interrupted extension resumes there and ends with the same
/// content. If the last session of the map is this drive, added with the same options by the same
/// version of the program, nothing is done. Layers and tables stay if no pose of the map has moved
/// (SessionAdjust::kNone); otherwise those in `MapOptions::keep_tables` do, and
/// `MapSummary::dropped` names the others.
///
/// Throws BadInput (the drive or the map cannot be read, the drive is a session of the map),
/// Refused (the drive is not of the map's place, or with too little evidence), StorageError,
/// Interrupted. The map then stays as it is.
MapSummary extend_map(const std::filesystem::path& folder,
                      const std::filesystem::path& map,
                      const MapOptions& options,
                      const Progress& progress = {});

}  // namespace roadbook
