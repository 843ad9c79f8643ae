#pragma once

#include <string>

#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// Writes table `layer_styles`, from which QGIS takes the style of a layer: one row for each vector
/// layer that has a style (mapping/layers/layer_style_qml.hpp), by name. Replaces the table, so
/// that the same layers always have the same rows.
/// `content_time`: date of the rows (utc_text).
void write_layer_styles(const SqlDatabase& database, const std::string& content_time);

}  // namespace roadbook
