#pragma once

#include <string>

#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// Writes table `layer_styles`, in which QGIS looks for the style of a layer when it opens one: a
/// row for each vector layer that has a style (mapping/layers/layer_style_qml.hpp), by name.
/// Replaces the table, so that the same layers have the same rows, whatever was written before.
///
/// `content_time`: what the rows are dated (utc_text).
void write_layer_styles(const SqlDatabase& database, const std::string& content_time);

}  // namespace roadbook
