#pragma once

#include "mapping/map_layers.hpp"
#include "mapping/map_layers_gdal.hpp"

namespace roadbook {

/// Creates or replaces a layer in an open GeoPackage. Throws StorageError; InvalidOption for a name
/// that is no identifier, or features that do not fit the fields.
void write_vector_layer(const GdalScope& scope, GDALDataset& dataset, const VectorLayer& layer);

/// Throws BadInput for a geometry or field type that roadbook does not write.
[[nodiscard]] VectorLayer read_vector_layer(GDALDataset& dataset, const std::string& name);

/// Throws InvalidOption for anything but letters, digits and underscores, letter first.
void check_layer_name(const std::string& name);

}  // namespace roadbook
