#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "base/error.hpp"
#include "workflows/settings/config_check.hpp"
#include "workflows/settings/friction_config.hpp"

// The configuration as a file: one list of keys for reading and for writing.

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr std::array kSemantics{std::pair{"linear_pool", SemanticModel::kLinearPool},
                                std::pair{"geometric_pool", SemanticModel::kGeometricPool},
                                std::pair{"discrete", SemanticModel::kDiscrete}};
constexpr std::array kNormalGamma{std::pair{"predictive", NormalGammaProjection::kPredictive},
                                  std::pair{"natural", NormalGammaProjection::kNatural},
                                  std::pair{"kl", NormalGammaProjection::kKl},
                                  std::pair{"printed", NormalGammaProjection::kPrinted}};
constexpr std::array kDirichlet{std::pair{"trace", DirichletProjection::kTrace},
                                std::pair{"fractional", DirichletProjection::kFractional},
                                std::pair{"printed", DirichletProjection::kPrinted}};

class Reader {
 public:
  explicit Reader(YamlMap& yaml) : yaml_(yaml) {}
  template <typename Value, typename... Rest>
  void operator()(const char* key, Value& value, const Rest&... rest) const {
    yaml_.read(key, value, rest...);
  }
  template <typename Names, typename Value>
  void one_of(const char* key, const Names& names, Value& value) const {
    std::string text;
    if (!yaml_.read(key, text)) return;
    std::string known;
    for (const auto& [name, one] : names) {
      if (text == name) {
        value = one;
        return;
      }
      known += (known.empty() ? "" : ", ") + std::string(name);
    }
    yaml_.report(key, text, "one of " + known);
  }

 private:
  YamlMap& yaml_;
};

class Writer {
 public:
  explicit Writer(ordered_json& json) : json_(json) {}
  template <typename Value, typename... Rest>
  void operator()(const char* key, const Value& value, const Rest&...) const {
    json_[key] = value;
  }
  template <typename Names, typename Value>
  void one_of(const char* key, const Names& names, const Value& value) const {
    for (const auto& [name, one] : names)
      if (one == value) json_[key] = name;
  }

 private:
  ordered_json& json_;
};

template <typename Config, typename Visit>
void for_each_friction_key(Config& config, const Visit& visit) {
  auto& map = config.map;
  auto& refresh = config.refresh;
  const Range share{0.0, 0.5};
  const Range seconds{0.0, 1e12};
  visit("classes", config.classes);
  visit("prior_counts", config.prior_counts);
  visit("friction_mean", config.friction_mean);
  visit("friction_sigma", config.friction_sigma);
  visit("spacing_m", config.spacing_m, Range{0.05, 100.0});
  visit("kernel_width_m", config.kernel_width_m, Range{0.05, 200.0});
  visit("range_m", config.range_m, Range{1.0, 500.0});
  visit("labels_per_m2", config.labels_per_m2, Range{1e-6, 1e6});
  visit.one_of("semantics", kSemantics, map.semantics);
  visit.one_of("normal_gamma", kNormalGamma, map.normal_gamma);
  visit.one_of("dirichlet", kDirichlet, map.dirichlet);
  visit("literal_root", map.literal_root);
  visit("literal_counts", map.literal_counts);
  visit("confusion", map.confusion);
  visit("prior_mean_sigma", map.prior_mean_sigma, Range{0.0, 1e3});
  visit("prior_alpha", map.prior_alpha, Range{1.0, 1e6});
  visit("outlier_weight", map.outlier_weight, share);
  visit("gate_counts", map.gate_counts, Range{0.0, 1e6});
  visit("half_life_values", map.half_life_values, Range{0.0, 1e12});
  visit("half_life_s", map.half_life_s, seconds);
  visit("knot_half_life_s", map.knot_half_life_s, seconds);
  visit("refresh", refresh.enabled);
  visit("refresh_every_m", refresh.every_m, Range{0.1, 1e6});
  visit("refresh_drop_nat", refresh.drop_nat, Range{0.0, 1e3});
}

void read_image_values(YamlMap& yaml, FrictionConfig& config) {
  std::vector<std::vector<double>> values;
  if (!yaml.read("image_values", values)) return;
  config.image_values.clear();
  for (const auto& list : values) {
    config.image_values.emplace_back();
    for (const double value : list) {
      if (!(value >= 0.0 && value <= 255.0 && value == std::floor(value)))
        yaml.report("image_values", std::to_string(value), "whole numbers from 0 to 255");
      else
        config.image_values.back().push_back(static_cast<std::uint8_t>(value));
    }
  }
}

void read_properties(YamlMap& yaml, std::vector<MeasuredProperty>& further) {
  auto list = yaml.map("properties");
  if (!list) return;
  for (const std::string& name : list->keys()) {
    auto entry = list->map(name);
    if (!entry) continue;
    MeasuredProperty property;
    property.name = property.column = name;
    property.table = "friction0/data.csv";
    property.unit = "-";
    entry->read("unit", property.unit);
    entry->read("table", property.table);
    entry->read("column", property.column);
    entry->read("sigma_column", property.sigma_column);
    entry->read("sensor_sigma", property.sensor_sigma, Range{0.0, 1e12});
    std::vector<double> range;
    if (entry->read_list("range", 2, range)) property.range = {range[0], range[1]};
    entry->require("mean", property.mean);
    entry->require("spread", property.spread);
    further.push_back(std::move(property));
  }
}

FrictionConfig friction_from_yaml(YamlMap yaml) {
  FrictionConfig config;
  for_each_friction_key(config, Reader(yaml));
  read_image_values(yaml, config);
  read_properties(yaml, config.further);
  yaml.finish();
  check_config(yaml, [&] { config.check(); });
  return config;
}

ordered_json config_json(const FrictionConfig& config) {
  ordered_json json;
  for_each_friction_key(config, Writer(json));
  json["image_values"] = config.image_values;
  ordered_json further = ordered_json::object();
  for (const MeasuredProperty& property : config.further)
    further[property.name] = {{"unit", property.unit},
                              {"table", property.table},
                              {"column", property.column},
                              {"sigma_column", property.sigma_column},
                              {"sensor_sigma", property.sensor_sigma},
                              {"range", {property.range.min, property.range.max}},
                              {"mean", property.mean},
                              {"spread", property.spread}};
  json["properties"] = further;
  return json;
}

}  // namespace

FrictionConfig FrictionConfig::load(const std::filesystem::path& file) {
  return friction_from_yaml(YamlMap::load(file));
}

FrictionConfig FrictionConfig::parse(const std::string& text, const std::string& name) {
  return friction_from_yaml(YamlMap::parse(text, name));
}

std::string FrictionConfig::text() const { return config_json(*this).dump(); }

void refuse_other_rules(const FrictionConfig& now,
                        const FrictionConfig& before,
                        const std::filesystem::path& file) {
  const ordered_json a = config_json(now);
  const ordered_json b = config_json(before);
  for (const auto& [key, value] : a.items())
    if (value != b.at(key))
      throw BadInput(Problem{Severity::kError, file.string(), YamlMap::load(file).line(key), key,
                             value.dump(),
                             b.at(key).dump() + " as the friction map was begun, or --replace"});
}

}  // namespace roadbook
