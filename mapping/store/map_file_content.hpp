#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "mapping/map.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "mapping/store/map_finish_options.hpp"

namespace roadbook {

/// Writes struct Map with its layers and `meta` into `file`, an empty place or the copy of an older
/// map whose other layers and tables stay. The file is not yet sealed.
void write_map_content(const std::filesystem::path& file,
                       const Map& map,
                       const std::map<std::string, std::string>& meta,
                       const MapFinishOptions& options);

/// Registers table `sessions`, the one table without geometry that GIS programs list: GDAL shows
/// none that is not registered.
void register_sessions(const SqlDatabase& database, const Map& map);

/// Verifies MAP and copies it to `file`, whole even if another process changes MAP meanwhile.
void copy_map_file(const std::filesystem::path& map, const std::filesystem::path& file);

}  // namespace roadbook
