#include "apps/speeds_config.hpp"

#include <charconv>
#include <string>

#include "apps/config_check.hpp"
#include "base/error.hpp"
#include "base/yaml.hpp"

namespace roadbook {
namespace {

void read_presence(YamlMap& yaml, PresenceOptions& presence, SightOptions& sight) {
  yaml.read("cell_m", presence.cell_m, Range{0.05, 10.0});
  yaml.read("beside_m", presence.beside_m, Range{0.0, 100.0});
  yaml.read("reach_m", presence.reach_m, Range{0.0, 100.0});
  yaml.read("visit_sigma", presence.visit_sigma, Range{1e-3, 100.0});
  yaml.read("literal", presence.literal);
  yaml.read("range_m", sight.range_m, Range{0.1, 1000.0});
  yaml.read("person_m", sight.person_m, Range{0.01, 10.0});
  yaml.read("look_s", sight.look_s, Range{1e-3, 1e6});
  if (auto priors = yaml.map("priors"))
    for (std::size_t i = 0; i < kPlaceClasses; ++i)
      if (auto prior = priors->map(to_text(static_cast<PlaceClass>(i)))) {
        prior->read("presence", presence.priors[i].presence, Range{0.0, 1.0});
        prior->read("sigma", presence.priors[i].sigma, Range{1e-3, 100.0});
      }
}

void read_speed(YamlMap& yaml, LaneSpeedOptions& speed) {
  yaml.read("min_speed_mps", speed.min_speed, Range{0.1, 100.0});
  yaml.read("max_speed_mps", speed.max_speed, Range{0.1, 100.0});
  yaml.read("caution", speed.caution, Range{0.0, 10.0});
  yaml.read("grip_quantile", speed.grip_quantile, Range{1e-6, 0.5});
  yaml.read("grip_share", speed.grip_share, Range{0.01, 1.0});
  yaml.read("unknown_grip", speed.unknown_grip, Range{0.0, 1.5});
  yaml.read("sight_m", speed.sight_m, Range{0.1, 1e4});
  yaml.read("reaction_s", speed.reaction_s, Range{0.0, 60.0});
  yaml.read("vehicle_width_m", speed.vehicle_width_m, Range{0.1, 20.0});
  yaml.read("step_m", speed.step_m, Range{0.01, 2.0});
  const Range motion{1e-3, 100.0};
  yaml.read("acceleration_mps2", speed.motion.acceleration, motion);
  yaml.read("braking_mps2", speed.motion.braking, motion);
  yaml.read("lateral_mps2", speed.motion.lateral, motion);
  yaml.read("jerk_mps3", speed.motion.jerk, motion);
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

SpeedsConfig SpeedsConfig::load(const std::filesystem::path& file) {
  SpeedsConfig config;
  YamlMap yaml = YamlMap::load(file);
  read_presence(yaml, config.presence, config.sight);
  read_speed(yaml, config.speed);
  read_limits(yaml, config.limits);
  yaml.read("visit_half_life_days", config.visit_half_life_days, Range{0.0, 1e6});
  yaml.read("friction_half_life_days", config.friction_half_life_days, Range{0.0, 1e6});
  yaml.finish();
  check_config(yaml, [&] { config.check(); });
  return config;
}

}  // namespace roadbook
