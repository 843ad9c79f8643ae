#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"
#include "exchange/layers/friction_carry.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/table_row.hpp"
#include "speedmap/property_map/interpolation.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr const char* kWantFriction = "a friction map (roadbook friction writes it)";

PropertyMapOptions options_from(const TableRow& row) {
  PropertyMapOptions options;
  try {
    const Json json = Json::parse(row.get<std::string>("options"));
    options.semantics = static_cast<SemanticModel>(json.at("semantics").get<int>());
    options.normal_gamma = static_cast<NormalGammaProjection>(json.at("normal_gamma").get<int>());
    options.dirichlet = static_cast<DirichletProjection>(json.at("dirichlet").get<int>());
    options.literal_root = json.at("literal_root");
    options.literal_counts = json.at("literal_counts");
    options.confusion = json.at("confusion").get<std::vector<double>>();
    options.outlier_weight = json.at("outlier_weight");
    options.gate_counts = json.at("gate_counts");
    options.half_life_values = json.at("half_life_values");
    options.half_life_s = json.at("half_life_s");
    options.knot_half_life_s = json.at("knot_half_life_s");
  } catch (const Json::exception& error) {
    row.fail("options", error.what());
  }
  options.prior_mean_sigma = 0.0;  // stored values were learned: believe them unchanged
  return options;
}

PropertyMapPrior prior_from(const std::string& file,
                            const PlainTable& settings,
                            const PlainTable& table) {
  PropertyMapPrior prior;
  for (const auto& settings_values : settings.rows) {
    const TableRow row(file, settings.name, settings.fields, settings_values, kWantFriction);
    PropertyPrior property{row.get<std::string>("property"),
                           row.get<std::string>("unit"),
                           row.get<double>("least"),
                           row.get<double>("most"),
                           {}};
    for (const auto& values : table.rows) {
      const TableRow of(file, table.name, table.fields, values, kWantFriction);
      if (of.get<std::string>("property") != property.name) continue;
      if (prior.properties.empty()) {
        prior.classes.push_back(of.get<std::string>("class"));
        prior.counts.push_back(of.get<double>("prior_count"));
      }
      property.classes.push_back({of.get<double>("mu"), of.get<double>("lambda"),
                                  of.get<double>("alpha"), of.get<double>("beta")});
    }
    prior.properties.push_back(std::move(property));
  }
  return prior;
}

std::vector<StoredKnot> stored_knots(const std::string& file,
                                     const PlainTable& table,
                                     std::size_t classes) {
  std::vector<StoredKnot> knots;
  for (const auto& values : table.rows) {
    const TableRow row(file, table.name, table.fields, values, kWantFriction);
    const auto& bytes = row.get<Bytes>("belief");
    if (bytes.size() != classes * sizeof(double))
      row.fail("belief", std::to_string(bytes.size()) + " bytes");
    StoredKnot knot{row.id("lane"),
                    row.get<double>("s_share"),
                    row.get<double>("e_m"),
                    {row.get<std::string>("session"),
                     row.get<std::int64_t>("t_ns"),
                     {row.get<double>("ahead_m"), row.get<double>("left_m")}},
                    std::vector<double>(classes),
                    row.get<double>("evidence")};
    std::memcpy(knot.belief.data(), bytes.data(), bytes.size());
    knots.push_back(std::move(knot));
  }
  return knots;
}

// Knots on the current paths, each with its place.
struct PlacedKnots {
  std::vector<StoredKnot> knots;
  std::vector<PathPlace> places;
  FrictionCarry carry;
};

PlacedKnots on_the_same_paths(std::vector<StoredKnot> stored,
                              const LaneStrips& strips,
                              const std::string& file) {
  PlacedKnots placed;
  for (StoredKnot& knot : stored) {
    const LaneStrips::Strip* const strip = strips.find(knot.lane);
    if (strip == nullptr)
      throw BadInput(Problem{Severity::kError, file, 0, "friction_knots.lane",
                             std::to_string(knot.lane), kWantFriction});
    placed.places.push_back({strip->begin_m + knot.s_share * strip->length_m(), knot.e_m});
    placed.carry.evidence += knot.evidence;
    placed.knots.push_back(std::move(knot));
  }
  return placed;
}

PlacedKnots on_moved_paths(std::vector<StoredKnot> stored,
                           const LaneStrips& strips,
                           const Map& map,
                           double spacing_m,
                           double kernel_width_m) {
  PlacedKnots placed;
  placed.carry.moved = true;
  const KnotCarrier carrier(map, strips, kernel_width_m);
  for (StoredKnot& knot : stored) {
    const auto place = carrier.place_of(knot);
    (place ? placed.carry.evidence : placed.carry.evidence_dropped) += knot.evidence;
    if (!place) {
      ++placed.carry.dropped;
      continue;
    }
    placed.places.push_back(*place);
    placed.knots.push_back(std::move(knot));
  }
  // Ground that no knot is near to (0.71 spacings within a grid): new, and nothing known of it.
  std::vector<PathPlace> fresh;
  if (placed.places.empty()) {
    fresh = strips.knots().places();
  } else {
    const Knots near = strips.knots_at(placed.places, {0.8 * spacing_m, 0.8 * spacing_m});
    Interpolation found;
    for (const PathPlace& place : strips.knots().places()) {
      interpolate(near, place, found);
      if (!found.covered()) fresh.push_back(place);
    }
  }
  placed.places.insert(placed.places.end(), fresh.begin(), fresh.end());
  return placed;
}

}  // namespace

std::optional<FrictionMap> read_friction_layers(const MapLayers& layers,
                                                const std::vector<LanePath>& lanes) {
  if (!layers.has("friction_settings")) return std::nullopt;
  const std::string file = layers.file().string();
  const PlainTable settings = layers.read_table("friction_settings");
  if (settings.rows.empty())
    throw BadInput(
        Problem{Severity::kError, file, 0, "friction_settings", "no rows", kWantFriction});
  const TableRow row(file, settings.name, settings.fields, settings.rows.front(), kWantFriction);
  const double spacing = row.get<double>("spacing_m");
  const double width = row.get<double>("kernel_width_m");
  const PropertyMapPrior prior = prior_from(file, settings, layers.read_table("property_classes"));
  std::vector<StoredKnot> stored =
      stored_knots(file, layers.read_table("friction_knots"), prior.classes.size());
  LaneStrips strips(lanes, spacing, width);
  const std::string paths = paths_digest(lanes);
  PlacedKnots placed =
      row.get<std::string>("paths") == paths
          ? on_the_same_paths(std::move(stored), strips, file)
          : on_moved_paths(std::move(stored), strips, load_map(layers.file()), spacing, width);
  PropertyMap map(strips.knots_at(std::move(placed.places)), prior, options_from(row));
  for (std::size_t l = 0; l < placed.knots.size(); ++l)
    map.set_belief(l, placed.knots[l].belief, placed.knots[l].evidence);
  FrictionMap friction{std::move(strips),
                       std::move(map),
                       spacing,
                       width,
                       row.get<std::int64_t>("date_ns"),
                       {},
                       placed.carry,
                       paths,
                       {},
                       row.get<std::string>("config")};
  if (!placed.carry.moved)
    for (const StoredKnot& knot : placed.knots) friction.anchors.push_back(knot.anchor);
  for (const std::string_view name : split(row.get<std::string>("sessions"), kBetweenSessions))
    friction.sessions.emplace_back(name);
  return friction;
}

}  // namespace roadbook
