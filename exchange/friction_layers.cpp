#include "exchange/friction_layers.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/text.hpp"
#include "exchange/table_row.hpp"
#include "exchange/value_raster.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr const char* kWant = "a friction map (roadbook friction writes it)";

constexpr char kBetweenNames = '\n';  // folders have commas in their names

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names)
    text += (text.empty() ? "" : std::string(1, kBetweenNames)) + name;
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
  options.prior_mean_sigma = 0.0;  // what is stored was learned: it is believed as it is
  return options;
}

// Every knot with what is known there: points for GIS programs.
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
  std::vector<double> shares(map.classes());
  const std::string date = utc_text(friction.date_ns);
  const std::string sessions = joined(friction.sessions);
  for (std::size_t l = 0; l < map.knots().size(); ++l) {
    const PathPlace place = map.knots().places()[l];
    const LaneStrips::Strip& strip = friction.strips.strip_of(place);
    const auto p = strip.frame.position(place.s_m - strip.begin_m, place.e_m);
    if (!p) continue;
    const PropertyMoments moments = map.knot_moments(0, l);
    map.knot_shares(l, shares);
    const auto best =
        static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
    layer.features.push_back({{{p->x(), p->y(), 0.0, 0.0}},
                              {std::to_string(strip.lane), place.s_m - strip.begin_m, place.e_m,
                               moments.mean, std::sqrt(moments.variance), map.prior().classes[best],
                               shares[best], map.knot_evidence(l), date, sessions}});
  }
  return layer;
}

PlainTable knot_table(const FrictionMap& friction) {
  PlainTable table;
  table.name = "friction_knots";
  table.fields = {{"lane", FieldType::kText},
                  {"s_share", FieldType::kReal},
                  {"e_m", FieldType::kReal},
                  {"evidence", FieldType::kReal},
                  {"belief", FieldType::kBytes}};
  for (std::size_t l = 0; l < friction.map.knots().size(); ++l) {
    const PathPlace place = friction.map.knots().places()[l];
    const LaneStrips::Strip& strip = friction.strips.strip_of(place);
    const auto belief = friction.map.belief(l);
    Bytes bytes(belief.size_bytes());
    std::memcpy(bytes.data(), belief.data(), bytes.size());
    table.rows.push_back({std::to_string(strip.lane),
                          (place.s_m - strip.begin_m) / strip.length_m(), place.e_m,
                          friction.map.knot_evidence(l), std::move(bytes)});
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

PlainTable settings_table(const FrictionMap& friction) {
  const PropertyPrior& about = friction.map.prior().properties.front();
  PlainTable table;
  table.name = "friction_settings";
  table.fields = {{"property", FieldType::kText},   {"unit", FieldType::kText},
                  {"least", FieldType::kReal},      {"most", FieldType::kReal},
                  {"spacing_m", FieldType::kReal},  {"kernel_width_m", FieldType::kReal},
                  {"date_ns", FieldType::kInteger}, {"sessions", FieldType::kText},
                  {"options", FieldType::kText}};
  table.rows.push_back({about.name, about.unit, about.min, about.max, friction.spacing_m,
                        friction.kernel_width_m, friction.date_ns, joined(friction.sessions),
                        options_json(friction.map.options())});
  return table;
}

// Mean and deviation over the ground; where two tubes overlap, the lane whose middle is nearer.
void write_rasters(MapUpdate& update, const FrictionMap& friction) {
  const double resolution = 0.5 * friction.spacing_m;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(INFINITY);
  Eigen::Vector2d high = -low;
  // Calls visit(p, place) over all strips, closely enough to meet every cell.
  const auto for_ground = [&](const auto& visit) {
    for (const LaneStrips::Strip& strip : friction.strips.strips())
      for (double s = 0.0; s < strip.length_m(); s += 0.5 * resolution)
        for (double e = -strip.half_width_m; e <= strip.half_width_m; e += 0.5 * resolution)
          if (const auto p = strip.frame.position(s, e)) visit(*p, PathPlace{strip.begin_m + s, e});
  };
  for_ground([&](const Eigen::Vector2d& p, const PathPlace&) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  });
  if (!(low.x() <= high.x())) return;
  ValueRaster mean = ValueRaster::over(low, high, resolution);
  ValueRaster sigma = mean;
  std::vector<float> offset(mean.values.size(), INFINITY);
  for_ground([&](const Eigen::Vector2d& p, const PathPlace& place) {
    const std::size_t cell = mean.index_of(p);
    const auto aside = static_cast<float>(std::abs(place.e_m));
    if (!(aside < offset[cell])) return;
    const auto moments = friction.map.moments(0, place);
    if (!moments) return;
    offset[cell] = aside;
    mean.values[cell] = static_cast<float>(moments->mean);
    sigma.values[cell] = static_cast<float>(std::sqrt(moments->variance));
  });
  write_value_raster(update, "friction_mean", "friction of the ground, mean", mean);
  write_value_raster(update, "friction_sigma", "friction of the ground, standard deviation", sigma);
  write_colour_raster(update, "friction_colours", "friction: dark at 1, yellow at 0.2", mean, 1.0,
                      0.2);
}

PropertyMapPrior prior_from(const std::string& file, const TableRow& row, const PlainTable& table) {
  PropertyMapPrior prior;
  PropertyPrior property{row.get<std::string>("property"),
                         row.get<std::string>("unit"),
                         row.get<double>("least"),
                         row.get<double>("most"),
                         {}};
  for (const auto& values : table.rows) {
    const TableRow of(file, table.name, table.fields, values, kWant);
    if (of.get<std::string>("property") != property.name) continue;
    prior.classes.push_back(of.get<std::string>("class"));
    prior.counts.push_back(of.get<double>("prior_count"));
    property.classes.push_back({of.get<double>("mu"), of.get<double>("lambda"),
                                of.get<double>("alpha"), of.get<double>("beta")});
  }
  prior.properties.push_back(std::move(property));
  return prior;
}

// A knot as stored, on the lanes of today.
struct Carried {
  PathPlace place;
  std::vector<double> belief;
  double evidence;
};

std::vector<Carried> carried_knots(const std::string& file,
                                   const PlainTable& table,
                                   const LaneStrips& strips,
                                   std::size_t classes) {
  std::vector<Carried> knots;
  for (const auto& values : table.rows) {
    const TableRow row(file, table.name, table.fields, values, kWant);
    const LaneStrips::Strip* strip = strips.find(row.id("lane"));
    const auto& bytes = row.get<Bytes>("belief");
    if (bytes.size() != classes * sizeof(double))
      row.fail("belief", std::to_string(bytes.size()) + " bytes");
    if (strip == nullptr) continue;
    Carried knot{
        {strip->begin_m + row.get<double>("s_share") * strip->length_m(), row.get<double>("e_m")},
        std::vector<double>(classes),
        row.get<double>("evidence")};
    std::memcpy(knot.belief.data(), bytes.data(), bytes.size());
    knots.push_back(std::move(knot));
  }
  return knots;
}

}  // namespace

void write_friction_layers(MapUpdate& update, const FrictionMap& friction) {
  update.write_layer(knot_layer(friction));
  update.write_table(class_table(friction.map));
  update.write_table(knot_table(friction));
  update.write_table(settings_table(friction));
  write_rasters(update, friction);
}

std::optional<FrictionMap> read_friction_layers(const MapLayers& layers,
                                                const std::vector<LanePath>& lanes) {
  if (!layers.has("friction")) return std::nullopt;
  const std::string file = layers.file().string();
  const PlainTable settings = layers.read_table("friction_settings");
  if (settings.rows.size() != 1)
    throw BadInput(Problem{Severity::kError, file, 0, "friction_settings",
                           std::to_string(settings.rows.size()) + " rows", kWant});
  const TableRow row(file, settings.name, settings.fields, settings.rows.front(), kWant);
  const double spacing = row.get<double>("spacing_m");
  const double width = row.get<double>("kernel_width_m");
  const PropertyMapPrior prior = prior_from(file, row, layers.read_table("property_classes"));
  const PlainTable table = layers.read_table("friction_knots");
  LaneStrips strips(lanes, spacing, width);
  const std::vector<Carried> carried = carried_knots(file, table, strips, prior.classes.size());
  std::vector<PathPlace> places;
  std::vector<std::uint64_t> known;
  for (const Carried& knot : carried) {
    places.push_back(knot.place);
    known.push_back(strips.strip_of(knot.place).lane);
  }
  std::sort(known.begin(), known.end());
  for (const PathPlace& place : strips.knots().places())
    if (!std::binary_search(known.begin(), known.end(), strips.strip_of(place).lane))
      places.push_back(place);
  PropertyMap map(strips.knots_at(std::move(places)), prior, options_from(row));
  for (std::size_t l = 0; l < carried.size(); ++l)
    map.set_belief(l, carried[l].belief, carried[l].evidence);
  FrictionMap friction{std::move(strips),
                       std::move(map),
                       spacing,
                       width,
                       row.get<std::int64_t>("date_ns"),
                       {},
                       table.rows.size() - carried.size()};
  for (const std::string_view name : split(row.get<std::string>("sessions"), kBetweenNames))
    friction.sessions.emplace_back(name);
  return friction;
}

}  // namespace roadbook
