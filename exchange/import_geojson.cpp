#include <cmath>
#include <set>

#include "exchange/label_readers.hpp"
#include "semantics/label_classes.hpp"
#include "semantics/label_layers.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr double kFarthestM = 20e3;  // of a label from the map's origin
constexpr double kClosedM = 1e-3;    // between a ring's first corner and its last

class GeoJsonReader {
 public:
  GeoJsonReader(std::string file, const GeoOrigin& origin)
      : file_(std::move(file)), to_degrees_(origin) {}

  Outlines read(const Json& json) {
    if (json.is_object()) check_reference(json.value("crs", Json()));
    const bool whole = json.is_object() && json.value("type", Json()) == "FeatureCollection" &&
                       json.contains("features") && json["features"].is_array();
    if (!whole) fault("file", "another object", "a FeatureCollection");
    if (whole)
      for (std::size_t i = 0; i < json["features"].size(); ++i)
        read_feature(json["features"][i], "features[" + std::to_string(i) + "]");
    if (!problems_.empty()) throw BadInput(problems_);
    return std::move(outlines_);
  }

 private:
  void fault(const std::string& field, const std::string& got, const std::string& want) {
    problems_.push_back({Severity::kError, file_, 0, field, got, want});
  }

  // The older standard (2008) lets a file name its coordinate reference system.
  void check_reference(const Json& crs) {
    static const std::set<std::string> known{"urn:ogc:def:crs:OGC:1.3:CRS84",
                                             "urn:ogc:def:crs:OGC:1.3:CRS84h",
                                             "urn:ogc:def:crs:OGC::CRS84",
                                             "OGC:CRS84",
                                             "urn:ogc:def:crs:EPSG::4326",
                                             "urn:ogc:def:crs:EPSG::4979",
                                             "EPSG:4326",
                                             "EPSG:4979"};
    if (crs.is_null()) return;
    const Json properties = crs.is_object() ? crs.value("properties", Json()) : Json();
    const Json name = properties.is_object() ? properties.value("name", Json()) : Json();
    if (!name.is_string() || !known.contains(name.get<std::string>()))
      fault("crs", name.is_string() ? name.get<std::string>() : shown(crs),
            "none, or WGS84 (urn:ogc:def:crs:OGC:1.3:CRS84)");
  }

  static std::string shown(const Json& value) { return value.dump().substr(0, 60); }

  // A property that may be left out or null; null and a fault where it is of another kind.
  Json property(const Json& properties,
                const std::string& where,
                const char* name,
                bool (*is)(const Json&),
                const char* want) {
    Json value = properties.value(name, Json());
    if (value.is_null() || is(value)) return value;
    fault(where + ".properties." + name, shown(value), want);
    return nullptr;
  }

  // A layer of labels has a class in each of its features; features of other layers have none.
  void read_feature(const Json& feature, const std::string& where) {
    if (!feature.is_object() || !feature.contains("properties") || !feature.contains("geometry"))
      return fault(where, "no feature", "an object with geometry and properties");
    const Json& properties = feature["properties"];
    const Json& geometry = feature["geometry"];
    const Json layer = properties.is_object() ? properties.value("layer", Json()) : Json();
    const bool layered = layer.is_string() && !is_label_layer(layer);
    const bool classed = properties.is_object() && properties.contains("class");
    if (!classed && layered) return;
    if (!classed || !properties["class"].is_string() || properties["class"] == "")
      return fault(where + ".properties.class", classed ? properties["class"].dump() : "nothing",
                   "the name of a class");
    if (const auto wrong = wrong_name(properties["class"]))
      return fault(where + ".properties.class", *wrong, kNameWanted);
    if (!geometry.is_object() || geometry.value("type", Json()) != "Polygon")
      return layered
                 ? void()
                 : fault(where + ".geometry.type",
                         geometry.is_object() ? geometry.value("type", Json()).dump() : "nothing",
                         "Polygon");
    read_label(properties, geometry.value("coordinates", Json()), where);
  }

  void read_label(const Json& properties, const Json& rings, const std::string& where) {
    LabelOutline outline;
    outline.kind = properties["class"];
    outline.where = where + ".geometry.coordinates";
    const std::size_t before = problems_.size();
    const auto given = [&](const char* name, bool (*is)(const Json&), const char* want) {
      return property(properties, where, name, is, want);
    };
    const auto is_number = [](const Json& v) { return v.is_number(); };
    const auto is_length = [](const Json& v) { return v.is_number() && v > 0.0; };
    const auto is_share = [](const Json& v) { return v.is_number() && v >= 0.0 && v <= 1.0; };
    const Json score = given("score", is_share, "0 to 1");
    const Json sigma_m = given("sigma_m", is_number, "a number of metres");
    const Json note = given(
        "note", [](const Json& v) { return v.is_string(); }, "text");
    const Json length_m = given("length_m", is_length, "a number of metres above 0");
    const Json width_m = given("width_m", is_length, "a number of metres above 0");
    if (!read_ring(rings, outline) || problems_.size() > before) return;
    if (!score.is_null()) outline.score = score;
    if (!sigma_m.is_null()) outline.sigma_m = sigma_m.get<double>();
    if (!note.is_null()) outline.note = note;
    if (!length_m.is_null()) {
      outline.shape = LabelShape::kBox;
      if (!width_m.is_null() && outline.corners.size() == 4)
        outline.heading_rad = heading_of(outline.corners, length_m, width_m);
    } else if (properties.value("space", Json()).is_number_integer()) {
      outline.shape = LabelShape::kPolygon;  // it has a label's number, and is no box
    }
    const auto wrong = outline_problems(file_, outline);
    problems_.insert(problems_.end(), wrong.begin(), wrong.end());
    outlines_.push_back(std::move(outline));
  }

  // Of a box from ahead on the right, or a corner later, whichever fits its sides. `heading_rad` in
  // the file is of its writer's map, whose x axis may have another direction than this one's.
  static double heading_of(const std::vector<Eigen::Vector2d>& c, double length_m, double width_m) {
    const Eigen::Vector2d first = 0.5 * (c[0] + c[1] - c[2] - c[3]);
    const Eigen::Vector2d second = 0.5 * (c[1] + c[2] - c[3] - c[0]);
    const auto misfit = [&](const Eigen::Vector2d& along, const Eigen::Vector2d& across) {
      return std::abs(along.norm() - length_m) + std::abs(across.norm() - width_m);
    };
    const Eigen::Vector2d& ahead = misfit(second, first) < misfit(first, second) ? second : first;
    return std::atan2(ahead.y(), ahead.x());
  }

  bool read_ring(const Json& rings, LabelOutline& outline) {
    if (!rings.is_array() || rings.size() != 1 || !rings[0].is_array()) {
      fault(outline.where,
            rings.is_array() && rings.size() > 1 ? std::to_string(rings.size()) + " rings"
                                                 : "no ring",
            "one ring without holes");
      return false;
    }
    for (const Json& point : rings[0]) {
      if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number()) {
        fault(outline.where, point.dump().substr(0, 60), "longitude, latitude");
        return false;
      }
      const Eigen::Vector2d degrees(point[0].get<double>(), point[1].get<double>());
      const auto place = to_degrees_.inverse(degrees);
      if (!place || !(place->norm() < kFarthestM)) {
        fault(outline.where,
              std::to_string(degrees.x()) + ", " + std::to_string(degrees.y()) +
                  (place ? ", far from the map's origin" : ", which are no degrees"),
              "longitude, latitude of this place in degrees");
        return false;
      }
      outline.corners.push_back(*place);
    }
    if (outline.corners.size() > 1 &&
        (outline.corners.front() - outline.corners.back()).norm() < kClosedM)
      outline.corners.pop_back();
    return true;
  }

  std::string file_;
  ToDegrees to_degrees_;
  std::vector<Problem> problems_;
  Outlines outlines_;
};

}  // namespace

Outlines read_geojson(const std::filesystem::path& file, const GeoOrigin& origin) {
  return GeoJsonReader(file.string(), origin).read(read_json_file(file));
}

}  // namespace roadbook
