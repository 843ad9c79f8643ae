#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace roadbook {

/// A layer as a QGIS project shows it.
struct QgisLayer {
  std::string name;   ///< in the map
  std::string title;  ///< in the list of layers
  std::string group;  ///< empty: in none
  bool raster = false;
  bool visible = true;
  std::string geometry;  ///< of vector layers: "Point", "Line" or "Polygon"
  double least = 0.0;    ///< of rasters of one band: values drawn black
  double most = 255.0;   ///< and white
  int bands = 1;         ///< of rasters; four are red, green, blue and opacity
};

struct QgisProject {
  std::string title;
  std::string map;                ///< file of the layers, relative to the project ("./place.gpkg")
  std::vector<QgisLayer> layers;  ///< from the top; those of a group lie next to each other
  Eigen::AlignedBox2d extent;     ///< shown first [m]
};

/// Sorts the layers `found` in drawing order: labels on top, images at the bottom. Layers that
/// would hide the overhead image are switched off.
[[nodiscard]] std::vector<QgisLayer> arranged_layers(const std::vector<QgisLayer>& found);

/// Returns the project file for QGIS 3 (.qgs, XML), with the styles of layer_style_qml.hpp.
[[nodiscard]] std::string qgs_text(const QgisProject& project);

}  // namespace roadbook
