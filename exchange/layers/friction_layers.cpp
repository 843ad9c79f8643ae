#include "exchange/layers/friction_layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "exchange/layers/friction_rasters.hpp"
#include "exchange/layers/speed_settings.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

std::string joined_sessions(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names)
    text += (text.empty() ? "" : std::string(1, kBetweenSessions)) + name;
  return text;
}

std::string options_json(const PropertyMapOptions& options) {
  return Json{{"semantics", static_cast<int>(options.semantics)},
              {"normal_gamma", static_cast<int>(options.normal_gamma)},
              {"dirichlet", static_cast<int>(options.dirichlet)},
              {"literal_root", options.literal_root},
              {"literal_counts", options.literal_counts},
              {"confusion", options.confusion},
              {"outlier_weight", options.outlier_weight},
              {"gate_counts", options.gate_counts},
              {"half_life_values", options.half_life_values},
              {"half_life_s", options.half_life_s},
              {"knot_half_life_s", options.knot_half_life_s}}
      .dump();
}

// Every knot with its state: points for GIS programs.
VectorLayer knot_layer(const FrictionMap& friction) {
  const PropertyMap& map = friction.map;
  VectorLayer layer;
  layer.name = "friction";
  layer.description = "friction of the ground: mean, standard deviation, labels seen";
  layer.type = GeometryType::kPointZ;
  layer.fields = {{"lane", FieldType::kText},        {"s_m", FieldType::kReal},
                  {"e_m", FieldType::kReal},         {"mean", FieldType::kReal},
                  {"sigma", FieldType::kReal},       {"class", FieldType::kText},
                  {"class_share", FieldType::kReal}, {"evidence", FieldType::kReal},
                  {"newest_utc", FieldType::kText},  {"sessions", FieldType::kText}};
  const auto& properties = map.prior().properties;
  for (std::size_t i = 1; i < properties.size(); ++i)
    for (const char* what : {"_mean", "_sigma"})
      layer.fields.push_back({properties[i].name + what, FieldType::kReal});
  std::vector<double> shares(map.classes());
  const std::string date = utc_text(friction.date_ns);
  const std::string sessions = joined_sessions(friction.sessions);
  for (std::size_t l = 0; l < map.knots().size(); ++l) {
    const PathPlace place = map.knots().places()[l];
    const LaneStrips::Strip& strip = friction.strips.strip_of(place);
    const Eigen::Vector2d p = ground_position(strip, place);
    const PropertyMoments moments = map.knot_moments(0, l);
    map.knot_shares(l, shares);
    const auto best =
        static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
    Feature feature{{{p.x(), p.y(), 0.0, 0.0}},
                    {std::to_string(strip.lane), place.s_m - strip.begin_m, place.e_m, moments.mean,
                     std::sqrt(moments.variance), map.prior().classes[best], shares[best],
                     map.knot_evidence(l), date, sessions}};
    for (std::size_t i = 1; i < properties.size(); ++i) {
      const PropertyMoments further = map.knot_moments(i, l);
      feature.values.insert(feature.values.end(), {further.mean, std::sqrt(further.variance)});
    }
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

PlainTable knot_table(const FrictionMap& friction) {
  PlainTable table;
  table.name = "friction_knots";
  table.fields = {
      {"lane", FieldType::kText},     {"s_share", FieldType::kReal}, {"e_m", FieldType::kReal},
      {"evidence", FieldType::kReal}, {"belief", FieldType::kBytes}, {"session", FieldType::kText},
      {"t_ns", FieldType::kInteger},  {"ahead_m", FieldType::kReal}, {"left_m", FieldType::kReal}};
  for (std::size_t l = 0; l < friction.map.knots().size(); ++l) {
    const PathPlace place = friction.map.knots().places()[l];
    const LaneStrips::Strip& strip = friction.strips.strip_of(place);
    const auto belief = friction.map.belief(l);
    Bytes bytes(belief.size_bytes());
    std::memcpy(bytes.data(), belief.data(), bytes.size());
    const KnotAnchor anchor = friction.anchors.empty() ? KnotAnchor{} : friction.anchors[l];
    table.rows.push_back({std::to_string(strip.lane),
                          (place.s_m - strip.begin_m) / strip.length_m(), place.e_m,
                          friction.map.knot_evidence(l), std::move(bytes), anchor.session,
                          anchor.t_ns, anchor.at.x(), anchor.at.y()});
  }
  return table;
}

PlainTable class_table(const PropertyMap& map) {
  PlainTable table;
  table.name = "property_classes";
  table.fields = {{"property", FieldType::kText},   {"class", FieldType::kText},
                  {"mu", FieldType::kReal},         {"lambda", FieldType::kReal},
                  {"alpha", FieldType::kReal},      {"beta", FieldType::kReal},
                  {"prior_count", FieldType::kReal}};
  for (std::size_t property = 0; property < map.prior().properties.size(); ++property)
    for (std::size_t i = 0; i < map.classes(); ++i) {
      const NormalGamma& ng = map.property(property)[i];
      table.rows.push_back({map.prior().properties[property].name, map.prior().classes[i], ng.mu,
                            ng.lambda, ng.alpha, ng.beta, map.prior().counts[i]});
    }
  return table;
}

// A row for each property; all but its own columns are the same in all of them.
PlainTable settings_table(const FrictionMap& friction) {
  PlainTable table;
  table.name = "friction_settings";
  table.fields = {{"property", FieldType::kText},   {"unit", FieldType::kText},
                  {"least", FieldType::kReal},      {"most", FieldType::kReal},
                  {"spacing_m", FieldType::kReal},  {"kernel_width_m", FieldType::kReal},
                  {"date_ns", FieldType::kInteger}, {"sessions", FieldType::kText},
                  {"options", FieldType::kText},    {"paths", FieldType::kText},
                  {"config", FieldType::kText}};
  for (const PropertyPrior& about : friction.map.prior().properties)
    table.rows.push_back({about.name, about.unit, about.min, about.max, friction.spacing_m,
                          friction.kernel_width_m, friction.date_ns,
                          joined_sessions(friction.sessions), options_json(friction.map.options()),
                          friction.paths, friction.config});
  return table;
}

}  // namespace

const std::vector<std::string>& measured_tables() {
  static const std::vector<std::string> names{
      "friction_settings", "friction_knots", "property_classes", "sighting_sessions",
      "detections",        "looks",          "person_examples",  "person_answers",
      "person_instants",   "box_examples",   kSpeedConfigTable,  "occupancy_patches",
      "occupancy_settings"};
  return names;
}

const std::vector<std::string>& learning_tables() {
  static const std::vector<std::string> names{"people_learning", "label_learning",
                                              "label_sightings"};
  return names;
}

std::size_t property_of(const PropertyMap& map, const std::string& name, const char* option) {
  std::string known;
  const auto& properties = map.prior().properties;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == name) return i;
    known += (known.empty() ? "" : ", ") + properties[i].name;
  }
  throw InvalidOption(option, name, known);
}

void write_friction_layers(MapUpdate& update, const FrictionMap& friction) {
  update.write_layer(knot_layer(friction));
  update.write_table(class_table(friction.map));
  update.write_table(knot_table(friction));
  update.write_table(settings_table(friction));
  write_property_rasters(update, friction);
}

}  // namespace roadbook
