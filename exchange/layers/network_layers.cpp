#include "exchange/layers/network_layers.hpp"

#include <charconv>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

// Ids have 64 bits without sign, which no column of numbers holds: they are stored as text.
std::string id_text(std::uint64_t id) { return std::to_string(id); }

Eigen::Vector4d to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z(), 0.0}; }

const std::vector<Field>& source_fields() {
  static const std::vector<Field> fields{{"sigma_m", FieldType::kReal},
                                         {"coverage", FieldType::kReal},
                                         {"date_utc", FieldType::kText},
                                         {"sessions", FieldType::kText}};
  return fields;
}

void add_source(const RoadNetwork& network, const NetworkSource& source, Feature& feature) {
  feature.values.insert(feature.values.end(),
                        {source.sigma_m, network.coverage, source.date_utc, source.sessions});
}

VectorLayer intersection_layer(const RoadNetwork& network, const NetworkSource& source) {
  VectorLayer layer;
  layer.name = "intersections";
  layer.description = "Places where lanes meet";
  layer.type = GeometryType::kPointZ;
  layer.fields = {{"intersection", FieldType::kText}, {"degree", FieldType::kInteger}};
  layer.fields.insert(layer.fields.end(), source_fields().begin(), source_fields().end());
  std::vector<std::int64_t> degree(network.intersections.size(), 0);
  for (const Lane& lane : network.lanes)
    for (const int end : {lane.from_intersection, lane.to_intersection})
      if (end >= 0) ++degree.at(static_cast<std::size_t>(end));
  for (std::size_t i = 0; i < network.intersections.size(); ++i) {
    Feature feature;
    feature.points.push_back(to_point(network.intersections[i].position));
    feature.values = {id_text(network.intersections[i].id), degree[i]};
    add_source(network, source, feature);
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

VectorLayer lane_layer(const RoadNetwork& network, const NetworkSource& source) {
  VectorLayer layer;
  layer.name = "lanes";
  layer.description = "Driven lanes between intersections, first to last point forwards";
  layer.type = GeometryType::kLineStringZ;
  layer.fields = {{"lane", FieldType::kText},
                  {"from_intersection", FieldType::kText},
                  {"to_intersection", FieldType::kText},
                  {"closed", FieldType::kInteger},
                  {"one_way", FieldType::kInteger},
                  {"forward_passes", FieldType::kInteger},
                  {"backward_passes", FieldType::kInteger},
                  {"reverse_gear_passes", FieldType::kInteger},
                  {"length_m", FieldType::kReal},
                  {"width_m", FieldType::kReal}};
  layer.fields.insert(layer.fields.end(), source_fields().begin(), source_fields().end());
  const auto end_id = [&](int index) -> FieldValue {
    if (index < 0) return std::monostate{};
    return id_text(network.intersections.at(static_cast<std::size_t>(index)).id);
  };
  for (const Lane& lane : network.lanes) {
    Feature feature;
    for (const Eigen::Vector3d& p : lane.centre) feature.points.push_back(to_point(p));
    feature.values = {id_text(lane.id),
                      end_id(lane.from_intersection),
                      end_id(lane.to_intersection),
                      std::int64_t{lane.closed ? 1 : 0},
                      std::int64_t{lane.one_way() ? 1 : 0},
                      std::int64_t{lane.forward_passes},
                      std::int64_t{lane.backward_passes},
                      std::int64_t{lane.reverse_gear_passes},
                      lane.length_m,
                      lane.width_m};
    add_source(network, source, feature);
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

void check_ids(const RoadNetwork& network) {
  std::set<std::uint64_t> intersections;
  std::set<std::uint64_t> lanes;
  bool unique = true;
  for (const Intersection& i : network.intersections)
    unique = intersections.insert(i.id).second && unique;
  for (const Lane& l : network.lanes) unique = lanes.insert(l.id).second && unique;
  if (!unique)
    throw Refused("error: road network: got two parts with the same id, want unique ids");
}

/// One row of a layer or table; reads values by name and checks them.
class Row {
 public:
  Row(const std::string& file,
      std::string table,
      const std::vector<Field>& fields,
      const std::vector<FieldValue>& values)
      : file_(file), table_(std::move(table)), fields_(fields), values_(values) {}

  template <typename T>
  [[nodiscard]] T get(const std::string& name) const {
    const FieldValue* value = find(name);
    if (value == nullptr || !std::holds_alternative<T>(*value)) fail(name, "no value of its type");
    return std::get<T>(*value);
  }
  [[nodiscard]] int integer(const std::string& name) const {
    return static_cast<int>(get<std::int64_t>(name));
  }
  /// Text of an id as number; empty where the field is null.
  [[nodiscard]] std::optional<std::uint64_t> id(const std::string& name) const {
    const FieldValue* value = find(name);
    if (value != nullptr && std::holds_alternative<std::monostate>(*value)) return std::nullopt;
    const std::string text = get<std::string>(name);
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) fail(name, text);
    return number;
  }
  [[noreturn]] void fail(const std::string& name, const std::string& got) const {
    throw BadInput(Problem{Severity::kError, file_, 0, table_ + "." + name, got, "a road network"});
  }

 private:
  [[nodiscard]] const FieldValue* find(const std::string& name) const {
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (fields_[i].name == name) return &values_[i];
    return nullptr;
  }

  const std::string& file_;
  std::string table_;
  const std::vector<Field>& fields_;
  const std::vector<FieldValue>& values_;
};

Lane to_lane(const Row& row,
             const Feature& feature,
             const std::map<std::uint64_t, int>& intersections) {
  const auto end_index = [&](const char* name) {
    const auto id = row.id(name);
    if (!id) return -1;
    const auto found = intersections.find(*id);
    if (found == intersections.end()) row.fail(name, id_text(*id));
    return found->second;
  };
  Lane lane;
  lane.id = row.id("lane").value_or(0);
  for (const Eigen::Vector4d& p : feature.points) lane.centre.emplace_back(p.head<3>());
  lane.from_intersection = end_index("from_intersection");
  lane.to_intersection = end_index("to_intersection");
  lane.closed = row.integer("closed") != 0;
  lane.forward_passes = row.integer("forward_passes");
  lane.backward_passes = row.integer("backward_passes");
  lane.reverse_gear_passes = row.integer("reverse_gear_passes");
  lane.length_m = row.get<double>("length_m");
  lane.width_m = row.get<double>("width_m");
  return lane;
}

}  // namespace

void write_network_layers(MapUpdate& update,
                          const RoadNetwork& network,
                          const NetworkSource& source) {
  check_ids(network);
  update.write_layer(intersection_layer(network, source));
  update.write_layer(lane_layer(network, source));
  PlainTable table;
  table.name = "road_network";
  table.fields = {{"length_m", FieldType::kReal},
                  {"coverage", FieldType::kReal},
                  {"reach_m", FieldType::kReal},
                  {"cycle_rank", FieldType::kInteger},
                  {"components", FieldType::kInteger}};
  table.rows.push_back({network.length_m, network.coverage, network.reach_m,
                        std::int64_t{network.cycle_rank}, std::int64_t{network.components}});
  update.write_table(table);
}

RoadNetwork read_network_layers(const MapLayers& layers) {
  const std::string file = layers.file().string();
  RoadNetwork network;
  std::map<std::uint64_t, int> index_of;
  const VectorLayer intersections = layers.read_layer("intersections");
  for (const Feature& feature : intersections.features) {
    const Row row(file, "intersections", intersections.fields, feature.values);
    const std::uint64_t id = row.id("intersection").value_or(0);
    if (feature.points.size() != 1) row.fail("geom", "no point");
    index_of[id] = static_cast<int>(network.intersections.size());
    network.intersections.push_back({id, feature.points.front().head<3>()});
  }
  const VectorLayer lanes = layers.read_layer("lanes");
  for (const Feature& feature : lanes.features)
    network.lanes.push_back(
        to_lane(Row(file, "lanes", lanes.fields, feature.values), feature, index_of));
  const PlainTable table = layers.read_table("road_network");
  for (const auto& values : table.rows) {
    const Row row(file, "road_network", table.fields, values);
    network.length_m = row.get<double>("length_m");
    network.coverage = row.get<double>("coverage");
    network.reach_m = row.get<double>("reach_m");
    network.cycle_rank = row.integer("cycle_rank");
    network.components = row.integer("components");
  }
  return network;
}

}  // namespace roadbook
