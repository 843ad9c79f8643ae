#include "exchange/layers/ground_fields.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "exchange/layers/layer_ages.hpp"
#include "exchange/layers/table_row.hpp"
#include "exchange/layers/value_raster.hpp"

namespace roadbook {
namespace {

constexpr const char* kWantGrid = "an occupancy grid (roadbook occupancy writes it)";

// The values of a raster from the least y. Cells without a value are NaN.
std::vector<float> upward_values(const MapLayers& layers,
                                 const std::string& name,
                                 const RasterInfo& like) {
  const RasterInfo info = layers.raster_info(name);
  if (info.width != like.width || info.height != like.height || info.corner != like.corner)
    throw BadInput({Severity::kError, layers.file().string(), 0, name,
                    "another extent than that of occupancy", kWantGrid});
  const cv::Mat read = layers.read_raster(name, {0, 0, info.width, info.height});
  if (read.type() != CV_32F)
    throw BadInput(
        {Severity::kError, layers.file().string(), 0, name, "no numbers of 32 bits", kWantGrid});
  std::vector<float> values;
  values.reserve(read.total());
  for (int row = info.height - 1; row >= 0; --row)
    for (int column = 0; column < info.width; ++column) {
      const float value = read.at<float>(row, column);
      values.push_back(value == static_cast<float>(kNoValue) ? NAN : value);
    }
  return values;
}

// The class of a layer whose outlines name none: those from the truth.
const char* class_of_layer(const std::string& layer) {
  if (layer == "parking_spaces") return "parking_space";
  return layer == "crossings" ? "crossing" : "other";
}

LabelledOutline outline_of(const VectorLayer& layer, const Feature& feature) {
  LabelledOutline outline;
  outline.kind = class_of_layer(layer.name);
  outline.sigma_m = NAN;
  for (std::size_t i = 0; i < layer.fields.size(); ++i) {
    const std::string& name = layer.fields[i].name;
    const FieldValue& value = feature.values[i];
    if (const auto* number = std::get_if<std::int64_t>(&value); number && name == "space")
      outline.id = *number;
    if (const auto* text = std::get_if<std::string>(&value); text && name == "class")
      outline.kind = *text;
    if (const auto* real = std::get_if<double>(&value); real && name == "sigma_m")
      outline.sigma_m = *real;
  }
  for (const Eigen::Vector4d& p : feature.points) outline.corners.emplace_back(p.head<2>());
  if (outline.corners.size() > 1 && outline.corners.front() == outline.corners.back())
    outline.corners.pop_back();
  return outline;
}

}  // namespace

std::optional<OccupancyField> read_occupancy_field(const MapLayers& layers, std::int64_t now_ns) {
  for (const char* name : {"occupancy", "occupancy_sigma", "occupancy_age"})
    if (!layers.has(name)) return std::nullopt;
  const RasterInfo info = layers.raster_info("occupancy");
  OccupancyCells cells;
  cells.cell_m = info.resolution_m;
  cells.columns = info.width;
  cells.rows = info.height;
  cells.low = info.corner - Eigen::Vector2d(0.0, info.height * info.resolution_m);
  cells.probability = upward_values(layers, "occupancy", info);
  cells.sigma = upward_values(layers, "occupancy_sigma", info);
  cells.age_s = upward_values(layers, "occupancy_age", info);
  // The raster holds ages before the newest reading.
  const AgedLayers ages = read_layer_ages(layers);
  if (const AgedItem* grid = ages.find("occupancy")) {
    const double since_s = std::max(0.0, 1e-9 * static_cast<double>(now_ns - grid->date_ns));
    for (float& age_s : cells.age_s) age_s += static_cast<float>(since_s);
  } else {
    std::fill(cells.age_s.begin(), cells.age_s.end(), NAN);  // of a program without these ages
  }
  try {
    return OccupancyField(std::move(cells));
  } catch (const InvalidOption& fault) {
    throw BadInput({Severity::kError, layers.file().string(), 0, "occupancy", fault.problem().got,
                    fault.problem().want});
  }
}

std::optional<LabelField> read_label_field(const MapLayers& layers) {
  std::vector<LabelledOutline> outlines;
  bool any = false;
  for (const char* name : {"parking_spaces", "crossings", "other_labels"}) {
    if (!layers.has(name)) continue;
    const VectorLayer layer = layers.read_layer(name);
    if (layer.type != GeometryType::kPolygonZ)
      throw BadInput(
          {Severity::kError, layers.file().string(), 0, name, "no polygons", "polygons"});
    any = true;
    for (const Feature& feature : layer.features) outlines.push_back(outline_of(layer, feature));
  }
  if (!any) return std::nullopt;
  return LabelField(std::move(outlines));
}

}  // namespace roadbook
