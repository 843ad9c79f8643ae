#include "semantics/labels/label_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "base/base64.hpp"
#include "base/error.hpp"
#include "semantics/labels/label_check.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<LabelShape, const char*>, 4> kShapes{
    {{LabelShape::kBox, to_text(LabelShape::kBox)},
     {LabelShape::kPolygon, to_text(LabelShape::kPolygon)},
     {LabelShape::kUpright, to_text(LabelShape::kUpright)},
     {LabelShape::kImage, to_text(LabelShape::kImage)}}};
constexpr std::array<std::pair<LabelSource, const char*>, 3> kSources{
    {{LabelSource::kDrawn, to_text(LabelSource::kDrawn)},
     {LabelSource::kAccepted, to_text(LabelSource::kAccepted)},
     {LabelSource::kDetected, to_text(LabelSource::kDetected)}}};
constexpr std::array<std::pair<LabelState, const char*>, 2> kStates{
    {{LabelState::kActive, "active"}, {LabelState::kDeleted, "deleted"}}};

template <typename Names, typename T>
std::string name_of(const Names& names, T value) {
  for (const auto& [known, name] : names)
    if (known == value) return name;
  return "";
}

// Reads the fields of one object and names the wrong field in its error.
class Fields {
 public:
  Fields(const Json& json, const std::string& source) : json_(json), source_(source) {
    if (!json.is_object()) refuse_label(source, "label", json.type_name(), "an object");
  }
  const Json& at(const char* name) {
    used_.insert(name);
    const auto found = json_.find(name);
    if (found == json_.end()) refuse_label(source_, name, "nothing", "a value");
    return *found;
  }
  [[nodiscard]] bool has(const char* name) const { return json_.contains(name); }
  double number(const char* name) {
    const Json& value = at(name);
    if (!value.is_number()) refuse_label(source_, name, value.dump(), "a number");
    return value.get<double>();
  }
  std::int64_t integer(const char* name) {
    const Json& value = at(name);
    if (!value.is_number_integer()) refuse_label(source_, name, value.dump(), "a whole number");
    return value.get<std::int64_t>();
  }
  int index(const char* name) {
    const std::int64_t value = integer(name);
    if (value < 0 || value > 1'000'000)
      refuse_label(source_, name, std::to_string(value), "0 to 1000000");
    return static_cast<int>(value);
  }
  std::string text(const char* name) {
    const Json& value = at(name);
    if (!value.is_string()) refuse_label(source_, name, value.dump(), "text");
    return value.get<std::string>();
  }
  template <typename Names>
  auto one_of(const char* name, const Names& names) {
    const std::string got = text(name);
    std::string want;
    for (const auto& [value, known] : names) {
      if (got == known) return value;
      want += (want.empty() ? "" : ", ") + std::string(known);
    }
    refuse_label(source_, name, got, want);
  }
  Eigen::Vector3d point(const Json& value, const char* name) {
    if (!value.is_array() || value.size() != 3)
      refuse_label(source_, name, value.dump(), "x, y, z");
    for (const Json& number : value)
      if (!number.is_number()) refuse_label(source_, name, value.dump(), "three numbers");
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }
  void finish() const {
    for (const auto& [name, value] : json_.items())
      if (!used_.contains(name))
        refuse_label(source_, name, "a field that labels do not have", "none");
  }

 private:
  const Json& json_;
  const std::string& source_;
  std::set<std::string, std::less<>> used_;
};

Json point_json(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

Json anchor_json(const LabelAnchor& anchor) {
  return {{"session", anchor.session}, {"t_ns", anchor.t_ns}, {"camera", anchor.camera}};
}

LabelAnchor read_anchor(const Json& json, const std::string& source) {
  Fields fields(json, source);
  LabelAnchor anchor;
  anchor.session = fields.index("session");
  anchor.t_ns = fields.integer("t_ns");
  anchor.camera = fields.index("camera");
  fields.finish();
  return anchor;
}

void write_window(const Label& label, Json& json) {
  if (label.shape == LabelShape::kUpright) {
    json["azimuth"] = label.window.azimuth;
    json["foot_slope"] = label.window.foot_slope;
    json["size"] = label.window.size;
  }
  json["pictures"] = Json::array();
  for (const std::string& picture : label.pictures) json["pictures"].push_back(to_base64(picture));
}

// x, y, the covariance's xx, xy, yy, and the number of sessions (older maps lack it).
LabelSeen read_seen(const Json& json, const std::string& source) {
  if (!json.is_array() || (json.size() != 5 && json.size() != 6))
    refuse_label(source, "seen", json.dump(), "six numbers");
  for (const Json& number : json)
    if (!number.is_number()) refuse_label(source, "seen", json.dump(), "numbers");
  LabelSeen seen;
  seen.middle = {json[0].get<double>(), json[1].get<double>()};
  seen.covariance << json[2].get<double>(), json[3].get<double>(), json[3].get<double>(),
      json[4].get<double>();
  if (json.size() == 6) seen.sessions = json[5].get<int>();
  return seen;
}

LabelSighting read_sighting(const Json& json, const std::string& source) {
  Fields fields(json, source);
  LabelSighting sighting;
  sighting.anchor = read_anchor(fields.at("anchor"), source);
  sighting.middle_vehicle = fields.point(fields.at("middle"), "middle");
  sighting.sigma_m = fields.number("sigma_m");
  fields.finish();
  return sighting;
}

void read_window(Fields& fields, Label& label, const std::string& source) {
  label.window.camera = label.anchor.camera;
  if (label.shape == LabelShape::kUpright) {
    label.window.azimuth = fields.number("azimuth");
    label.window.foot_slope = fields.number("foot_slope");
    label.window.size = fields.number("size");
  }
  for (const Json& text : fields.at("pictures")) {
    auto bytes = text.is_string() ? from_base64(text.get<std::string>()) : std::nullopt;
    if (!bytes) refuse_label(source, "pictures", "something else", "base64");
    label.pictures.push_back(std::move(*bytes));
  }
}

void read_shape(Fields& fields, Label& label, const std::string& source) {
  label.shape = fields.one_of("shape", kShapes);
  if (label.shape == LabelShape::kBox) {
    label.T_vehicle_label.translation() = fields.point(fields.at("middle"), "middle");
    label.T_vehicle_label.linear() =
        Eigen::AngleAxisd(fields.number("heading"), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    label.length_m = fields.number("length_m");
    label.width_m = fields.number("width_m");
    return;
  }
  if (!is_on_ground(label)) return read_window(fields, label, source);
  for (const Json& corner : fields.at("corners"))
    label.corners_vehicle.push_back(fields.point(corner, "corners"));
}

}  // namespace

Json label_to_json(const Label& label) {
  Json json = {{"id", label.id},
               {"version", label.version},
               {"state", name_of(kStates, label.state)},
               {"kind", label.kind},
               {"source", name_of(kSources, label.source)},
               {"who", label.who},
               {"t_ns", label.t_ns},
               {"score", label.score},
               {"sigma_m", label.sigma_m},
               {"anchor", anchor_json(label.anchor)},
               {"shape", name_of(kShapes, label.shape)}};
  if (label.shape == LabelShape::kBox) {
    const Eigen::Matrix3d R = label.T_vehicle_label.linear();
    json["middle"] = point_json(label.T_vehicle_label.translation());
    json["heading"] = std::atan2(R(1, 0), R(0, 0));
    json["length_m"] = label.length_m;
    json["width_m"] = label.width_m;
  } else if (!is_on_ground(label)) {
    write_window(label, json);
  } else {
    json["corners"] = Json::array();
    for (const auto& corner : label.corners_vehicle) json["corners"].push_back(point_json(corner));
  }
  for (const LabelSighting& sighting : label.sightings)
    json["sightings"].push_back({{"anchor", anchor_json(sighting.anchor)},
                                 {"middle", point_json(sighting.middle_vehicle)},
                                 {"sigma_m", sighting.sigma_m}});
  if (label.seen)
    json["seen"] = {label.seen->middle.x(),       label.seen->middle.y(),
                    label.seen->covariance(0, 0), label.seen->covariance(0, 1),
                    label.seen->covariance(1, 1), label.seen->sessions};
  json["note"] = label.note;
  return json;
}

Label label_from_json(const Json& json, const std::string& source) {
  Fields fields(json, source);
  Label label;
  if (fields.has("id")) label.id = fields.integer("id");
  if (fields.has("version")) label.version = fields.integer("version");
  if (fields.has("state")) label.state = fields.one_of("state", kStates);
  if (fields.has("who")) label.who = fields.text("who");
  if (fields.has("t_ns")) label.t_ns = fields.integer("t_ns");
  label.kind = fields.text("kind");
  label.source = fields.one_of("source", kSources);
  label.score = fields.number("score");
  label.sigma_m = fields.number("sigma_m");
  label.anchor = read_anchor(fields.at("anchor"), source);
  if (fields.has("sightings"))
    for (const Json& sighting : fields.at("sightings"))
      label.sightings.push_back(read_sighting(sighting, source));
  if (fields.has("seen")) label.seen = read_seen(fields.at("seen"), source);
  read_shape(fields, label, source);
  label.note = fields.text("note");
  fields.finish();
  check_label(label, source);
  return label;
}

}  // namespace roadbook
