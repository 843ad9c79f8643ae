#include "semantics/labels/label_layers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {
namespace {

constexpr std::array<const char*, 3> kNames{"parking_spaces", "crossings", "other_labels"};

const char* layer_of(const Label& label) {
  if (label.kind == "parking_space" && label.shape == LabelShape::kBox) return kNames[0];
  if (label.kind == "crossing") return kNames[1];
  return kNames[2];
}

const std::vector<Field>& fields() {
  static const std::vector<Field> list{
      {"space", FieldType::kInteger},    {"class", FieldType::kText},
      {"version", FieldType::kInteger},  {"source", FieldType::kText},
      {"who", FieldType::kText},         {"score", FieldType::kReal},
      {"length_m", FieldType::kReal},    {"width_m", FieldType::kReal},
      {"heading_rad", FieldType::kReal}, {"sigma_m", FieldType::kReal},
      {"coverage", FieldType::kReal},    {"note", FieldType::kText},
      {"date_utc", FieldType::kText},    {"edited_utc", FieldType::kText},
      {"sessions", FieldType::kText}};
  return list;
}

// Share of the label's outline that lies inside its anchor image.
double coverage_of(const Map& map, const Label& label) {
  const auto& cameras = map.sessions[static_cast<std::size_t>(label.anchor.session)].rig.cameras;
  if (label.anchor.camera >= static_cast<int>(cameras.size())) return 0.0;
  const MountedCamera& mounted = cameras[static_cast<std::size_t>(label.anchor.camera)];
  const Eigen::Isometry3d T_map_vehicle = vehicle_of(map, label.anchor)->T_map_vehicle;
  const Eigen::Isometry3d T_camera_map = (T_map_vehicle * mounted.T_vehicle_camera).inverse();
  const auto corners = corners_in_map(map, label);
  constexpr int kSteps = 8;
  int seen = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (int k = 0; k < kSteps; ++k) {
      const Eigen::Vector3d p =
          corners[i] + (corners[(i + 1) % corners.size()] - corners[i]) * k / kSteps;
      const auto pixel = mounted.camera.project(T_camera_map * p);
      if (pixel && pixel->x() >= 0.0 && pixel->y() >= 0.0 &&
          pixel->x() <= mounted.camera.width - 1 && pixel->y() <= mounted.camera.height - 1)
        ++seen;
    }
  return static_cast<double>(seen) / static_cast<double>(corners.size() * kSteps);
}

Feature feature_of(const Map& map, const Label& label, const std::string& date) {
  Feature feature;
  for (const Eigen::Vector3d& p : corners_in_map(map, label))
    feature.points.emplace_back(p.x(), p.y(), p.z(), 0.0);
  feature.points.push_back(feature.points.front());
  const auto box = box_in_map(map, label);
  const auto number = [&](double value) -> FieldValue {
    if (!box) return std::monostate{};
    return value;
  };
  feature.values = {label.id,
                    label.kind,
                    label.version,
                    std::string(to_text(label.source)),
                    label.who,
                    label.score,
                    number(label.length_m),
                    number(label.width_m),
                    number(box ? box->heading : 0.0),
                    *sigma_in_map(map, label),
                    coverage_of(map, label),
                    label.note,
                    date,
                    utc_text(label.t_ns),
                    map.sessions[static_cast<std::size_t>(label.anchor.session)].name};
  return feature;
}

// Whether labels made this layer. A layer of the same name may come from another source.
bool is_made_of_labels(const MapLayers& layers, const std::string& name) {
  return layers.has(name) && layers.read_layer(name).field("edited_utc").has_value();
}

}  // namespace

bool is_label_layer(const std::string& name) {
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

std::vector<VectorLayer> label_layers(const Map& map, const std::vector<Label>& labels) {
  std::int64_t newest = 0;
  for (const Session& session : map.sessions) newest = std::max(newest, session.t_end_ns);
  std::vector<VectorLayer> layers;
  for (const char* name : kNames) {
    VectorLayer layer;
    layer.name = name;
    layer.description = "Labels, where the vehicle poses they hang on are";
    layer.type = GeometryType::kPolygonZ;
    layer.fields = fields();
    for (const Label& label : labels)
      if (label.state == LabelState::kActive && !is_rejected_kind(label.kind) &&
          vehicle_of(map, label.anchor) && std::string(layer_of(label)) == name)
        layer.features.push_back(feature_of(map, label, utc_text(newest)));
    if (!layer.features.empty()) layers.push_back(std::move(layer));
  }
  return layers;
}

void write_label_layers(MapUpdate& update,
                        const MapLayers& before,
                        const Map& map,
                        const std::vector<Label>& labels) {
  std::set<std::string> written;
  for (const VectorLayer& layer : label_layers(map, labels)) {
    update.write_layer(layer);
    written.insert(layer.name);
  }
  for (const char* name : kNames)
    if (!written.contains(name) && is_made_of_labels(before, name)) update.remove(name);
}

void renew_label_layers(const std::filesystem::path& map) {
  const MapHold hold(map);
  const MapLayers layers(map);
  const auto labels = read_labels(map);
  const bool stale = std::any_of(kNames.begin(), kNames.end(),
                                 [&](const char* name) { return is_made_of_labels(layers, name); });
  if (labels.empty() && !stale) return;
  MapUpdate update(map);
  write_label_layers(update, layers, load_map(map), labels);
  if (!layers.has("label_classes"))
    update.write_table(label_class_table(read_label_classes(layers)));
  update.commit();
}

std::vector<VectorLayer> label_layers_of_today(const MapLayers& layers) {
  const std::vector<Label> labels = read_labels(layers.file());
  if (labels.empty()) return {};
  return label_layers(load_map(layers.file()), labels);
}

bool label_layers_are_current(const std::filesystem::path& map) {
  using Standing = std::pair<std::int64_t, std::int64_t>;  // label, version
  const auto standing = [](const VectorLayer& layer) {
    const auto id = layer.field("space");
    const auto version = layer.field("version");
    std::vector<Standing> list;
    if (!id || !version) return list;
    for (const Feature& feature : layer.features)
      list.emplace_back(std::get<std::int64_t>(feature.values[*id]),
                        std::get<std::int64_t>(feature.values[*version]));
    return list;
  };
  const MapLayers layers(map);
  const auto today = label_layers_of_today(layers);
  return std::all_of(kNames.begin(), kNames.end(), [&](const char* name) {
    const auto now = std::find_if(today.begin(), today.end(),
                                  [&](const VectorLayer& layer) { return layer.name == name; });
    if (now == today.end()) return !is_made_of_labels(layers, name);
    return layers.has(name) && standing(layers.read_layer(name)) == standing(*now);
  });
}

std::optional<VectorLayer> layer_of_today(const MapLayers& layers,
                                          const std::vector<VectorLayer>& today,
                                          const std::string& name) {
  for (const VectorLayer& layer : today)
    if (layer.name == name) return layer;
  if (!layers.has(name) || (is_label_layer(name) && is_made_of_labels(layers, name)))
    return std::nullopt;
  return layers.read_layer(name);
}

std::vector<std::string> vector_layers_of_today(const MapLayers& layers,
                                                const std::vector<VectorLayer>& today) {
  std::set<std::string> names;
  for (const LayerInfo& layer : layers.list())
    if (!layer.raster && !(is_label_layer(layer.name) && is_made_of_labels(layers, layer.name)))
      names.insert(layer.name);
  for (const VectorLayer& layer : today) names.insert(layer.name);
  return {names.begin(), names.end()};
}

}  // namespace roadbook
