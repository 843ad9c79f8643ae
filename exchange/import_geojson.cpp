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
    LabelOutline outline;
    outline.kind = properties["class"];
    outline.shape = LabelShape::kPolygon;
    outline.where = where + ".geometry.coordinates";
    if (properties.contains("length_m") && properties["length_m"].is_number())
      outline.shape = LabelShape::kBox;
    const Json score = properties.value("score", Json());
    if (!score.is_null() && !(score.is_number() && score >= 0.0 && score <= 1.0))
      return fault(where + ".properties.score", score.dump(), "0 to 1");
    if (score.is_number()) outline.score = score;
    const Json sigma_m = properties.value("sigma_m", Json());
    if (!sigma_m.is_null() && !sigma_m.is_number())
      return fault(where + ".properties.sigma_m", sigma_m.dump(), "a number of metres");
    if (sigma_m.is_number()) outline.sigma_m = sigma_m;
    if (properties.contains("note") && properties["note"].is_string())
      outline.note = properties["note"];
    if (!read_ring(geometry.value("coordinates", Json()), outline)) return;
    const auto wrong = outline_problems(file_, outline);
    problems_.insert(problems_.end(), wrong.begin(), wrong.end());
    outlines_.push_back(std::move(outline));
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
