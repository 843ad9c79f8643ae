#include "apps/summaries/friction_summary.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/format.hpp"
#include "workflows/property_table.hpp"

namespace roadbook {
namespace {

nlohmann::ordered_json say_classes(const Console& console, const PropertyMap& map, std::size_t k) {
  nlohmann::ordered_json classes = nlohmann::ordered_json::array();
  const PropertyPrior& about = map.prior().properties[k];
  const std::string unit = about.unit == "-" ? "" : " " + about.unit;
  for (std::size_t i = 0; i < map.classes(); ++i) {
    const NormalGamma& ng = map.property(k)[i];
    const std::string& name = map.prior().classes[i];
    classes.push_back({{"class", name},
                       {"mean", ng.mu},
                       {"sigma_of_mean", std::sqrt(ng.mean_variance())},
                       {"sigma_within", std::sqrt(ng.expected_variance())}});
    console.say(name + ": " + about.name + " " + fixed(ng.mu, 3) + " +- " +
                fixed(std::sqrt(ng.mean_variance()), 3) + unit);
  }
  return classes;
}

nlohmann::ordered_json say_properties(const Console& console,
                                      const PropertyMap& map,
                                      const FrictionSummary& summary) {
  nlohmann::ordered_json properties = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < map.prior().properties.size(); ++k)
    properties.push_back({{"property", map.prior().properties[k].name},
                          {"unit", map.prior().properties[k].unit},
                          {"values", summary.values[k]},
                          {"classes", say_classes(console, map, k)}});
  return properties;
}

// Prints the values that were measured but not used. A property without values may be misspelt.
void say_values_left_out(const Console& console,
                         const std::filesystem::path& drive,
                         const FrictionConfig& config,
                         const FrictionSummary& summary) {
  const auto properties = config.properties();
  for (std::size_t k = 0; k < properties.size(); ++k) {
    if (summary.values[k] > 0) continue;
    const auto file = property_file(drive, properties[k]);
    console.note(file.string() + ": " + properties[k].name + ": nothing learned, " +
                 (std::filesystem::exists(file) ? "no value on a lane whose ground has been seen"
                                                : "no such table in the drive"));
  }
  console.say("values left out: " + std::to_string(summary.without_pose) + " without a pose, " +
              std::to_string(summary.off_lanes) + " beside all lanes, " +
              std::to_string(summary.without_labels) + " where too little has been seen");
}

}  // namespace

void print_friction(const Console& console,
                    const FrictionResult& result,
                    const std::filesystem::path& drive) {
  const FrictionMap& friction = result.friction;
  const FrictionSummary& summary = result.summary;
  if (result.speeds_older)
    console.note("the speed map was made before this: `roadbook speeds` takes the new grip up");
  say_values_left_out(console, drive, result.config, summary);
  const auto properties = say_properties(console, friction.map, summary);
  console.result({{"frames", summary.frames},
                  {"cells", summary.cells},
                  {"values", summary.values.front()},
                  {"values_without_pose", summary.without_pose},
                  {"values_off_lanes", summary.off_lanes},
                  {"values_without_labels", summary.without_labels},
                  {"refreshes", summary.refreshes},
                  {"sessions", friction.sessions},
                  {"knots_dropped", friction.carry.dropped},
                  {"lanes", friction.strips.strips().size()},
                  {"knots", friction.map.knots().size()},
                  {"classes", properties.front().at("classes")},
                  {"properties", properties}});
}

}  // namespace roadbook
