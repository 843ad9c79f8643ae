#include "apps/summaries/overhead_summary.hpp"

#include <nlohmann/json.hpp>

#include "apps/summary_json.hpp"
#include "apps/vehicle_option.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

// Returns the share of each camera's image that shows the own vehicle, by session.
nlohmann::ordered_json masked_json(const Map& map, const OverheadSummary& made) {
  nlohmann::ordered_json sessions = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < made.vehicles.size(); ++s) {
    nlohmann::ordered_json cameras = nlohmann::ordered_json::object();
    const auto& share = made.vehicles[s].masked_share;
    for (std::size_t c = 0; c < share.size(); ++c)
      cameras[map.sessions[s].rig.cameras[c].name] = share[c];
    sessions.push_back(std::move(cameras));
  }
  return sessions;
}

std::string exposure_line(const OverheadExposure& exposure) {
  const auto percent = [](double share) { return fixed(100.0 * share, 1) + " %"; };
  if (!exposure.balanced)
    return "exposure as recorded: " + percent(exposure.saturated_recorded) +
           " of the ground saturated";
  return "exposure balanced by gains of " + fixed(exposure.least_gain, 2) + " to " +
         fixed(exposure.most_gain, 2) + ": " + percent(exposure.saturated) +
         " of the ground saturated, " + percent(exposure.saturated_recorded) + " without";
}

}  // namespace

void print_overhead(const Console& console,
                    const OverheadResult& result,
                    const std::filesystem::path& map) {
  const OverheadSummary& made = result.summary;
  console.warn(made.warnings);
  console.say(std::to_string(made.columns) + " x " + std::to_string(made.rows) + " pixels of " +
              fixed(made.resolution_m, 3) + " m, " + fixed(made.covered_m2, 0) + " m^2 seen, " +
              std::to_string(made.images_used) + " images");
  say_vehicle(console, result.vehicles);
  console.say(exposure_line(made.exposure));
  console.say("overhead image: layer overhead of " + map.string() + "; " + made.image.string());
  console.result({{"columns", made.columns},
                  {"rows", made.rows},
                  {"resolution_m", made.resolution_m},
                  {"west_m", made.west_m},
                  {"north_m", made.north_m},
                  {"covered_m2", made.covered_m2},
                  {"coverage", made.coverage},
                  {"sigma_grey", made.sigma_grey},
                  {"exposure",
                   {{"balanced", made.exposure.balanced},
                    {"least_gain", made.exposure.least_gain},
                    {"most_gain", made.exposure.most_gain},
                    {"saturated", made.exposure.saturated},
                    {"saturated_recorded", made.exposure.saturated_recorded}}},
                  {"warnings", to_json(made.warnings)},
                  {"views", made.views},
                  {"images_used", made.images_used},
                  {"images_missing", made.images_missing},
                  {"max_range_m", made.max_range_m},
                  {"vehicle", vehicle_json(result.vehicles)},
                  {"masked_share", masked_json(result.map, made)},
                  {"image", made.image.string()},
                  {"count", made.count.string()},
                  {"variance", made.variance.string()},
                  {"frames", made.frames.string()}});
}

}  // namespace roadbook
