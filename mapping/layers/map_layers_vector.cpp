#include "mapping/layers/map_layers_vector.hpp"

#include <ogr_feature.h>
#include <ogrsf_frmts.h>

#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.hpp"

namespace roadbook {
namespace {

struct GeometryName {
  GeometryType type;
  OGRwkbGeometryType ogr;
};
constexpr std::array<GeometryName, 4> kGeometries{{{GeometryType::kPointZ, wkbPoint25D},
                                                   {GeometryType::kPointZM, wkbPointZM},
                                                   {GeometryType::kLineStringZ, wkbLineString25D},
                                                   {GeometryType::kPolygonZ, wkbPolygon25D}}};
struct FieldName {
  FieldType type;
  OGRFieldType ogr;
};
constexpr std::array<FieldName, 4> kFields{{{FieldType::kInteger, OFTInteger64},
                                            {FieldType::kReal, OFTReal},
                                            {FieldType::kText, OFTString},
                                            {FieldType::kBytes, OFTBinary}}};

OGRwkbGeometryType ogr_type(GeometryType type) {
  for (const GeometryName& g : kGeometries)
    if (g.type == type) return g.ogr;
  return wkbUnknown;
}

OGRFieldType ogr_type(FieldType type) {
  for (const FieldName& f : kFields)
    if (f.type == type) return f.ogr;
  return OFTString;
}

OGRSpatialReference map_crs() {
  OGRSpatialReference crs;
  ROADBOOK_ASSERT(crs.importFromWkt(map_crs_wkt().c_str()) == OGRERR_NONE);
  return crs;
}

void add_points(OGRSimpleCurve& curve, const std::vector<Eigen::Vector4d>& points) {
  for (const Eigen::Vector4d& p : points) curve.addPoint(p.x(), p.y(), p.z());
}

std::unique_ptr<OGRGeometry> to_geometry(GeometryType type,
                                         const std::vector<Eigen::Vector4d>& points) {
  if (type == GeometryType::kLineStringZ) {
    auto line = std::make_unique<OGRLineString>();
    add_points(*line, points);
    return line;
  }
  if (type == GeometryType::kPolygonZ) {
    auto ring = std::make_unique<OGRLinearRing>();
    add_points(*ring, points);
    auto polygon = std::make_unique<OGRPolygon>();
    polygon->addRingDirectly(ring.release());
    return polygon;
  }
  if (points.size() != 1)
    throw InvalidOption("feature.points", std::to_string(points.size()), "1 for a point");
  const Eigen::Vector4d& p = points.front();
  if (type == GeometryType::kPointZM) return std::make_unique<OGRPoint>(p.x(), p.y(), p.z(), p.w());
  return std::make_unique<OGRPoint>(p.x(), p.y(), p.z());
}

void set_value(OGRFeature& feature, int field, const FieldValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    feature.SetField(field, static_cast<GIntBig>(*number));
  } else if (const auto* real = std::get_if<double>(&value); real && !std::isnan(*real)) {
    feature.SetField(field, *real);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    feature.SetField(field, text->c_str());
  } else if (const auto* bytes = std::get_if<Bytes>(&value)) {
    feature.SetField(field, static_cast<int>(bytes->size()), bytes->data());
  } else {
    feature.SetFieldNull(field);
  }
}

void write_features(const GdalScope& scope,
                    const std::filesystem::path& file,
                    OGRLayer& target,
                    const VectorLayer& layer) {
  for (const Feature& feature : layer.features) {
    if (feature.values.size() != layer.fields.size())
      throw InvalidOption(layer.name + ".values", std::to_string(feature.values.size()),
                          std::to_string(layer.fields.size()));
    OGRFeature row(target.GetLayerDefn());
    row.SetGeometryDirectly(to_geometry(layer.type, feature.points).release());
    for (std::size_t i = 0; i < feature.values.size(); ++i)
      set_value(row, static_cast<int>(i), feature.values[i]);
    scope.require(target.CreateFeature(&row) == OGRERR_NONE, file, layer.name);
  }
}

}  // namespace

void check_layer_name(const std::string& name) {
  bool ok = !name.empty() && name.size() <= 60 &&
            std::isalpha(static_cast<unsigned char>(name.front())) != 0;
  for (const char c : name)
    ok = ok && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_');
  // Names that SQLite and GeoPackage reserve.
  for (const char* reserved : {"sqlite_", "gpkg_", "rtree_"})
    ok = ok && name.rfind(reserved, 0) != 0;
  if (!ok) throw InvalidOption("layer name", name, "letters, digits, underscores; a letter first");
}

void unite_map_frames(const SqlDatabase& database) {
  const OGRSpatialReference crs = map_crs();
  char* text = nullptr;
  ROADBOOK_ASSERT(crs.exportToWkt(&text) == OGRERR_NONE);
  const std::string definition = text;
  CPLFree(text);
  database
      .prepare(
          "UPDATE gpkg_spatial_ref_sys SET definition = ?1 WHERE srs_name = ?2 AND definition != "
          "?1")
      .bind_text(1, definition)
      .bind_text(2, crs.GetName())
      .run();
}

void write_vector_layer(const GdalScope& scope, GDALDataset& dataset, const VectorLayer& layer) {
  check_layer_name(layer.name);
  const std::filesystem::path file = dataset.GetDescription();
  OGRSpatialReference crs = map_crs();
  CPLStringList options;
  options.SetNameValue("OVERWRITE", "YES");
  options.SetNameValue("FID", "fid");
  options.SetNameValue("GEOMETRY_NAME", "geom");
  if (!layer.description.empty()) options.SetNameValue("DESCRIPTION", layer.description.c_str());
  OGRLayer* target =
      dataset.CreateLayer(layer.name.c_str(), &crs, ogr_type(layer.type), options.List());
  scope.require(target != nullptr, file, layer.name);
  for (const Field& field : layer.fields) {
    check_layer_name(field.name);
    OGRFieldDefn definition(field.name.c_str(), ogr_type(field.type));
    scope.require(target->CreateField(&definition) == OGRERR_NONE, file, layer.name);
  }
  scope.require(dataset.StartTransaction() == OGRERR_NONE, file, layer.name);
  write_features(scope, file, *target, layer);
  scope.require(dataset.CommitTransaction() == OGRERR_NONE, file, layer.name);
}

}  // namespace roadbook
