#pragma once

#include "mapping/layers/layer_types.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// Creates or replaces a layer in an open GeoPackage. Throws StorageError; InvalidOption for a name
/// that is no identifier, or features that do not fit the fields.
void write_vector_layer(const GdalScope& scope, GDALDataset& dataset, const VectorLayer& layer);

/// Gives all layers the same definition of the map frame. Files of earlier versions hold two
/// definitions, and GIS programs refuse to combine layers of different definitions.
void unite_map_frames(const SqlDatabase& database);

/// Throws InvalidOption for anything but letters, digits and underscores, letter first.
void check_layer_name(const std::string& name);

}  // namespace roadbook
