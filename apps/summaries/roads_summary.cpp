#include "apps/summaries/roads_summary.hpp"

#include <nlohmann/json.hpp>

#include "base/format.hpp"
#include "workflows/network_coverage.hpp"

namespace roadbook {
namespace {

void say_carry(const Console& console, const FrictionCarry& carry) {
  const double all = carry.evidence + carry.evidence_dropped;
  console.say("friction map carried over to these paths: " +
              fixed(all > 0.0 ? 100.0 * carry.evidence / all : 100.0, 2) +
              " % of its labels kept, " + std::to_string(carry.dropped) +
              " knots lie on no path any more");
}

}  // namespace

void print_roads(const Console& console, const RoadsResult& result, double max_deviation_m) {
  const RoadNetwork& network = result.network;
  const PathSummary& worst = result.paths;
  const std::optional<FrictionCarry>& carry = result.friction;
  console.say(std::to_string(network.lanes.size()) + " lanes, " +
              std::to_string(network.intersections.size()) + " intersections, " +
              fixed(network.length_m, 1) + " m; " + fixed(100.0 * network.coverage, 1) +
              " % of the driven positions within " + fixed(network.reach_m, 2) + " m");
  console.say("paths: at most " + fixed(worst.deviation_m, 3) + " m from what was driven, " +
              "tightest bend " + fixed(worst.max_curvature, 3) + " 1/m; " +
              std::to_string(worst.deviating) + " farther off than " + fixed(max_deviation_m, 2) +
              " m");
  if (result.spaces > 0)
    console.say(std::to_string(result.spaces_linked) + " of " + std::to_string(result.spaces) +
                " parking spaces have a lane before them");
  if (carry) say_carry(console, *carry);
  if (result.speeds_stale)
    console.note("the speed map was made on other paths: run `roadbook speeds` again");
  console.result({{"lanes", network.lanes.size()},
                  {"intersections", network.intersections.size()},
                  {"length_m", network.length_m},
                  {"coverage", network.coverage},
                  {"uncovered", uncovered_json(network)},
                  {"reach_m", network.reach_m},
                  {"cycle_rank", network.cycle_rank},
                  {"components", network.components},
                  {"paths",
                   {{"deviation_m", worst.deviation_m},
                    {"max_curvature", worst.max_curvature},
                    {"deviating", worst.deviating}}},
                  {"spaces", {{"linked", result.spaces_linked}, {"total", result.spaces}}},
                  {"friction_carried", carry.has_value()},
                  {"friction_evidence_kept", carry ? carry->evidence : 0.0},
                  {"friction_evidence_dropped", carry ? carry->evidence_dropped : 0.0},
                  {"speeds_stale", result.speeds_stale}});
}

}  // namespace roadbook
