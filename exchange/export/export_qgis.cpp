#include <cpl_vsi.h>

#include "base/error.hpp"
#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/qgis_project.hpp"
#include "mapping/layers/map_layers_gdal.hpp"

namespace roadbook {
namespace {

const char* geometry_name(GeometryType type) {
  if (type == GeometryType::kLineStringZ) return "Line";
  return type == GeometryType::kPolygonZ ? "Polygon" : "Point";
}

// From the project's folder, as QGIS writes it.
std::string relative_path(const std::filesystem::path& map, const std::filesystem::path& project) {
  const auto folder = std::filesystem::absolute(project).parent_path();
  const auto path = std::filesystem::proximate(std::filesystem::absolute(map), folder);
  const std::string text = path.generic_string();
  return path.is_absolute() || text.starts_with("../") ? text : "./" + text;
}

QgisProject project_of(const std::filesystem::path& map, const std::filesystem::path& out) {
  const MapLayers layers(map);
  QgisProject project;
  project.title = map.stem().string();
  project.map = relative_path(map, out);
  std::vector<QgisLayer> found;
  for (const LayerInfo& info : layers.list()) {
    QgisLayer layer;
    layer.name = info.name;
    layer.raster = info.raster;
    if (info.raster) {
      const RasterInfo raster = layers.raster_info(info.name);
      layer.bands = raster.bands;
      project.extent.extend(raster.corner);
      project.extent.extend(raster.corner +
                            raster.resolution_m * Eigen::Vector2d(raster.width, -raster.height));
    } else {
      const VectorLayer vector = layers.read_layer(info.name);
      layer.geometry = geometry_name(vector.type);
      if (info.name == "poses")
        for (const Feature& pose : vector.features)
          project.extent.extend(Eigen::Vector2d(pose.points.front().head<2>()));
    }
    found.push_back(std::move(layer));
  }
  project.layers = arranged_layers(found);
  return project;
}

// A .qgz is a zip archive of the .qgs alone.
void write_packed(const std::filesystem::path& out, const std::string& text) {
  WholeFile output(out);
  const GdalScope scope;
  const std::string inside =
      "/vsizip/{" + output.part().string() + "}/" + out.stem().string() + ".qgs";
  VSILFILE* const file = VSIFOpenL(inside.c_str(), "wb");
  scope.require(file != nullptr, out, "qgz");
  const bool written = VSIFWriteL(text.data(), 1, text.size(), file) == text.size();
  scope.require(VSIFCloseL(file) == 0 && written, out, "qgz");
  output.commit();
}

}  // namespace

Paths export_qgis(const std::filesystem::path& map, const std::filesystem::path& out) {
  if (out.extension() != ".qgs" && out.extension() != ".qgz")
    throw InvalidOption("--output", out.string(), "a project: NAME.qgs or NAME.qgz");
  const std::string text = qgs_text(project_of(map, out));
  if (out.extension() == ".qgz")
    write_packed(out, text);
  else
    write_whole_file(out, text);
  return {out};
}

}  // namespace roadbook
