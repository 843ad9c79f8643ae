#include "workflows/settings/speeds_config.hpp"

#include <charconv>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.hpp"
#include "base/yaml.hpp"
#include "workflows/settings/config_check.hpp"

// The configuration as a file: one list of keys for reading and for writing.

namespace roadbook {
namespace {

using nlohmann::ordered_json;

template <typename Config, typename Visit>
void for_each_speeds_key(Config& config, const Visit& visit) {
  auto& presence = config.presence;
  visit("cell_m", presence.cell_m, Range{0.05, 10.0});
  visit("beside_m", presence.beside_m, Range{0.0, 100.0});
  visit("reach_m", presence.reach_m, Range{0.0, 100.0});
  visit("visit_sigma", presence.visit_sigma, Range{1e-3, 100.0});
  visit("literal", presence.literal);
  auto& sight = config.sight;
  visit("range_m", sight.range_m, Range{0.1, 1000.0});
  visit("person_m", sight.person_m, Range{0.01, 10.0});
  visit("look_s", sight.look_s, Range{1e-3, 1e6});
  auto& speed = config.speed;
  visit("min_speed_mps", speed.min_speed, Range{0.1, 100.0});
  visit("max_speed_mps", speed.max_speed, Range{0.1, 100.0});
  visit("caution", speed.caution, Range{0.0, 10.0});
  visit("grip_quantile", speed.grip_quantile, Range{1e-6, 0.5});
  visit("grip_share", speed.grip_share, Range{0.01, 1.0});
  visit("unknown_grip", speed.unknown_grip, Range{0.0, 1.5});
  visit("sight_m", speed.sight_m, Range{0.1, 1e4});
  visit("reaction_s", speed.reaction_s, Range{0.0, 60.0});
  visit("vehicle_width_m", speed.vehicle_width_m, Range{0.1, 20.0});
  visit("step_m", speed.step_m, Range{0.01, 2.0});
  const Range motion{1e-3, 100.0};
  visit("acceleration_mps2", speed.motion.acceleration, motion);
  visit("braking_mps2", speed.motion.braking, motion);
  visit("lateral_mps2", speed.motion.lateral, motion);
  visit("jerk_mps3", speed.motion.jerk, motion);
  visit("visit_half_life_days", config.visit_half_life_days, Range{0.0, 1e6});
  visit("friction_half_life_days", config.friction_half_life_days, Range{0.0, 1e6});
}

void read_priors(YamlMap& yaml, PresenceOptions& presence) {
  auto priors = yaml.map("priors");
  if (!priors) return;
  for (std::size_t i = 0; i < kPlaceClasses; ++i)
    if (auto prior = priors->map(to_text(static_cast<PlaceClass>(i)))) {
      prior->read("presence", presence.priors[i].presence, Range{0.0, 1.0});
      prior->read("sigma", presence.priors[i].sigma, Range{1e-3, 100.0});
    }
}

void read_limits(YamlMap& yaml, std::map<std::uint64_t, double>& limits) {
  auto list = yaml.map("limits_mps");
  if (!list) return;
  for (const std::string& key : list->keys()) {
    std::uint64_t lane = 0;
    double limit = 0.0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), lane);
    if (error != std::errc{} || end != key.data() + key.size())
      list->report(key, key, "the id of a lane");
    if (list->read(key, limit, Range{0.1, 100.0})) limits[lane] = limit;
  }
}

SpeedsConfig speeds_from_yaml(YamlMap yaml, SpeedsConfig config) {
  for_each_speeds_key(config, [&](const char* key, auto& value, const auto&... range) {
    yaml.read(key, value, range...);
  });
  read_priors(yaml, config.presence);
  read_limits(yaml, config.limits);
  yaml.finish();
  check_config(yaml, [&] { config.check(); });
  return config;
}

}  // namespace

void SpeedsConfig::check() const {
  presence.check();
  sight.check();
  speed.check();
}

double SpeedsConfig::limit_of(std::uint64_t lane) const {
  const auto found = limits.find(lane);
  return found == limits.end() ? speed.max_speed : found->second;
}

SpeedsConfig SpeedsConfig::load(const std::filesystem::path& file, const SpeedsConfig& defaults) {
  return speeds_from_yaml(YamlMap::load(file), defaults);
}

SpeedsConfig SpeedsConfig::parse(const std::string& text,
                                 const std::string& name,
                                 const SpeedsConfig& defaults) {
  return speeds_from_yaml(YamlMap::parse(text, name), defaults);
}

std::string SpeedsConfig::text() const {
  ordered_json json = ordered_json::object();
  for_each_speeds_key(
      *this, [&](const char* key, const auto& value, const auto&...) { json[key] = value; });
  ordered_json priors = ordered_json::object();
  for (std::size_t i = 0; i < kPlaceClasses; ++i)
    priors[to_text(static_cast<PlaceClass>(i))] = {{"presence", presence.priors[i].presence},
                                                   {"sigma", presence.priors[i].sigma}};
  json["priors"] = priors;
  ordered_json by_lane = ordered_json::object();
  for (const auto& [lane, limit] : limits) by_lane[std::to_string(lane)] = limit;
  json["limits_mps"] = by_lane;
  return json.dump();
}

}  // namespace roadbook
