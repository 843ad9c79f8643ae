#include <algorithm>
#include <cmath>
#include <map>

#include "exchange/import/geojson_geometry.hpp"
#include "exchange/import/json_fields.hpp"
#include "exchange/import/label_readers.hpp"
#include "exchange/import/outline_shape.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_layers.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr double kFarthestM = 20e3;          // of a label from the map's origin
constexpr double kMetresOfDegree = 111.3e3;  // at the equator: nowhere more

class GeoJsonReader {
 public:
  GeoJsonReader(const std::string& file, const GeoOrigin& origin, std::string class_field)
      : fields_(file), to_degrees_(origin), class_field_(std::move(class_field)) {}

  LabelFile read(const Json& json) {
    if (json.is_object()) check_reference(json.value("crs", Json()));
    const Json type = json.is_object() ? json.value("type", Json()) : Json();
    if (type == "FeatureCollection" && json.contains("features") && json["features"].is_array()) {
      const Json& features = json["features"];
      for (std::size_t i = 0; i < features.size(); ++i)
        read_feature(features[i], "features[" + std::to_string(i) + "]");
    } else if (type == "Feature") {
      read_feature(json, "feature");
    } else {
      fields_.fault("file", "another object", "a FeatureCollection");
    }
    if (!fields_.problems().empty()) throw BadInput(fields_.problems());
    for (auto& [layer, others] : passed_over_) {
      others.reason.got = std::to_string(others.count) + " features";
      result_.left_out.push_back(others);
    }
    return std::move(result_);
  }

 private:
  // The older standard (2008) lets a file name its coordinate reference system.
  void check_reference(const Json& crs) {
    if (const auto other = foreign_reference(crs))
      fields_.fault("crs", *other, "none, or WGS84 (urn:ogc:def:crs:OGC:1.3:CRS84)");
  }

  void leave_out(const Json& feature,
                 const std::string& field,
                 const std::string& got,
                 const std::string& want) {
    const Json& properties = feature["properties"];
    std::string what = got;
    for (const auto& [name, id] : {std::pair{"id", feature.value("id", Json())},
                                   {"space", properties.value("space", Json())}})
      if (!id.is_null()) {
        what += " (" + std::string(name) + " " + shown(id) + ")";
        break;
      }
    result_.left_out.push_back(left_out(fields_.file(), field, what, want));
  }
  // Features of a map's other layers, and of a layer of labels that came from elsewhere.
  void pass_over(const std::string& layer, const std::string& want) {
    const auto [others, is_new] =
        passed_over_.emplace(layer, left_out(fields_.file(), "layer " + layer, "", want));
    others->second.count = is_new ? 1 : others->second.count + 1;
    others->second.of_labels = false;
  }

  // The class of a feature, from the property that was asked for, else `class` in any case.
  Json class_of(const Json& properties) const {
    if (!class_field_.empty()) return properties.value(class_field_, Json());
    if (properties.contains("class")) return properties["class"];
    for (const char* name : {"Class", "CLASS"})
      if (properties.contains(name)) return properties[name];
    return nullptr;
  }
  static std::string names_of(const Json& properties) {
    std::string names;
    for (const auto& [name, value] : properties.items())
      if (value.is_string()) names += (names.empty() ? "" : ", ") + name;
    return names.substr(0, 100);
  }

  void read_feature(const Json& feature, const std::string& where) {
    if (!feature.is_object() || !feature.contains("properties") || !feature.contains("geometry"))
      return fields_.fault(where, "no feature", "an object with geometry and properties");
    const Json& properties = feature["properties"];
    const Json layer = properties.is_object() ? properties.value("layer", Json()) : Json();
    const Json kind = properties.is_object() ? class_of(properties) : Json();
    const bool classed = kind.is_string() && kind != "";
    if (layer.is_string() && !is_label_layer(layer) && !classed)
      return pass_over(layer, "labels with a class");
    if (layer.is_string() && is_label_layer(layer) && kind.is_null())
      return pass_over(layer, "ones that have a class");
    if (!classed) return refuse_class(properties, kind, where);
    if (const auto wrong = wrong_name(kind))
      return fields_.fault(where + ".properties." + class_name(), *wrong, kNameWanted);
    const Json geometry = feature["geometry"];
    const Json type = geometry.is_object() ? geometry.value("type", Json()) : Json();
    if (layer.is_string() && !is_label_layer(layer) && type != "Polygon" && type != "MultiPolygon")
      return pass_over(layer, "labels with a polygon");
    if (const auto ring = ring_of(feature, type, where)) read_label(properties, *ring, where);
  }
  [[nodiscard]] std::string class_name() const {
    return class_field_.empty() ? "class" : class_field_;
  }
  void refuse_class(const Json& properties, const Json& kind, const std::string& where) {
    const std::string names = properties.is_object() ? names_of(properties) : std::string();
    fields_.fault(
        where + ".properties." + class_name(), kind.is_null() ? "nothing" : shown(kind),
        "the name of a class" +
            (names.empty() ? std::string()
                           : " (--class-field names another of its properties: " + names + ")"));
  }

  // The one ring of a feature; null where no single ring can be a label.
  std::optional<Json> ring_of(const Json& feature, const Json& type, const std::string& where) {
    const Json geometry = feature["geometry"];
    if (type != "Polygon" && type != "MultiPolygon") {
      leave_out(feature, where + ".geometry.type", geometry.is_object() ? shown(type) : "nothing",
                "Polygon");
      return std::nullopt;
    }
    const std::string field = where + ".geometry.coordinates";
    Json rings = geometry.value("coordinates", Json());
    if (type == "MultiPolygon") {
      if (rings.is_array() && rings.size() > 1) {
        if (Json ring = joined_at_antimeridian(rings); !ring.is_null()) return ring;
        leave_out(feature, field, std::to_string(rings.size()) + " polygons", "one");
        return std::nullopt;
      }
      rings = rings.is_array() && rings.size() == 1 ? Json(rings[0]) : Json();
    }
    if (rings.is_array() && rings.size() > 1) {
      leave_out(feature, field, std::to_string(rings.size()) + " rings", "one ring without holes");
      return std::nullopt;
    }
    if (rings.is_array() && rings.size() == 1 && rings[0].is_array()) return Json(rings[0]);
    fields_.fault(field, "no ring", "one ring without holes");
    return std::nullopt;
  }

  void read_label(const Json& properties, const Json& ring, const std::string& where) {
    LabelOutline outline;
    outline.kind = class_of(properties);
    outline.where = where + ".geometry.coordinates";
    const std::string path = where + ".properties";
    const std::size_t before = fields_.problems().size();
    const auto given = [&](const char* name, JsonFields::Is is, const char* want) {
      return fields_.optional(properties, path, name, is, want);
    };
    const auto is_length = [](const Json& v) { return v.is_number() && v.get<double>() > 0.0; };
    const Json score = given("score", is_share, "0 to 1");
    const Json sigma_m = given("sigma_m", is_number, "a number of metres");
    const Json note = given("note", is_text, "text");
    const Json length_m = given("length_m", is_length, "a number of metres above 0");
    const Json width_m = given("width_m", is_length, "a number of metres above 0");
    if (!read_corners(ring, outline) || fields_.problems().size() > before) return;
    if (!score.is_null()) outline.score = score;
    if (!sigma_m.is_null()) outline.sigma_m = sigma_m.get<double>();
    if (!note.is_null()) outline.note = note;
    outline.identity = identity_of(properties);
    if (!length_m.is_null())
      outline.shape = LabelShape::kBox;
    else if (outline.identity)
      outline.shape = LabelShape::kPolygon;  // it has a label's number, and is no box
    clean_corners(outline);
    if (!length_m.is_null() && !width_m.is_null() && outline.corners.size() == 4)
      outline.heading_rad = heading_of(outline.corners, length_m, width_m);
    fields_.add(outline_problems(fields_.file(), outline));
    result_.outlines.push_back(std::move(outline));
  }

  // Of a box from ahead on the right, or a corner later, whichever fits its sides. `heading_rad` in
  // the file is of its writer's map, whose x axis may have another direction than this one's.
  static double heading_of(std::vector<Eigen::Vector2d> c, double length_m, double width_m) {
    // Roadbook writes counter-clockwise: another program has turned the ring round.
    if (twice_signed_area(c) < 0.0) std::reverse(c.begin() + 1, c.end());
    const Eigen::Vector2d first = 0.5 * (c[0] + c[1] - c[2] - c[3]);
    const Eigen::Vector2d second = 0.5 * (c[1] + c[2] - c[3] - c[0]);
    const auto misfit = [&](const Eigen::Vector2d& along, const Eigen::Vector2d& across) {
      return std::abs(along.norm() - length_m) + std::abs(across.norm() - width_m);
    };
    const Eigen::Vector2d& ahead = misfit(second, first) < misfit(first, second) ? second : first;
    return std::atan2(ahead.y(), ahead.x());
  }

  bool read_corners(const Json& ring, LabelOutline& outline) {
    std::vector<double> values;
    for (const Json& point : ring) {
      if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number()) {
        fields_.fault(outline.where, shown(point), "longitude, latitude");
        return false;
      }
      const Eigen::Vector2d degrees(point[0].get<double>(), point[1].get<double>());
      const auto place = to_degrees_.inverse(degrees);
      if (!place || !(place->norm() < kFarthestM)) {
        fields_.fault(outline.where,
                      std::to_string(degrees.x()) + ", " + std::to_string(degrees.y()) +
                          (place ? ", far from the map's origin" : ", which are no degrees"),
                      std::string("longitude, latitude of this place in degrees") +
                          (is_near({degrees.y(), degrees.x()}) ? " (here they are swapped)" : ""));
        return false;
      }
      outline.corners.push_back(*place);
      values.insert(values.end(), {degrees.x(), degrees.y()});
    }
    outline.step_m = rounding_step(values) * kMetresOfDegree;
    return true;
  }
  [[nodiscard]] bool is_near(const Eigen::Vector2d& degrees) const {
    const auto place = to_degrees_.inverse(degrees);
    return place && place->norm() < kFarthestM;
  }

  JsonFields fields_;
  ToDegrees to_degrees_;
  std::string class_field_;
  std::map<std::string, LabelsLeftOut> passed_over_;  // by layer
  LabelFile result_;
};

}  // namespace

LabelFile read_geojson(const std::filesystem::path& file,
                       const GeoOrigin& origin,
                       const std::string& class_field) {
  return GeoJsonReader(file.string(), origin, class_field).read(read_json_file(file));
}

}  // namespace roadbook
