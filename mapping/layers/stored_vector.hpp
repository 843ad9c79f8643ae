#pragma once

#include <string>

#include "mapping/layers/layer_types.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// Reads a vector layer of an open map, features by their ids, without GDAL, which takes longer to
/// load than most layers to read. Throws BadInput for a type of geometry or field that roadbook
/// does not write, and for a geometry that is cut.
[[nodiscard]] VectorLayer read_stored_vector(const SqlDatabase& database, const std::string& name);

}  // namespace roadbook
