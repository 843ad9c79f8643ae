#include "apps/summaries/speeds_summary.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/summaries/layers_summary.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

ordered_json lanes_json(const SpeedMap& speeds) {
  ordered_json lanes = ordered_json::array();
  for (const LaneProfile& profile : speeds.profiles) {
    double slowest = INFINITY;
    double time = 0.0;
    for (const LaneSpeed& place : profile.places) {
      slowest = std::min(slowest, place.speed);
      time += profile.step_m / place.speed;
    }
    const double length =
        profile.step_m * static_cast<double>(profile.places.size() - (profile.closed ? 0 : 1));
    lanes.push_back({{"lane", std::to_string(profile.lane)},
                     {"length_m", length},
                     {"seconds", time},
                     {"slowest_mps", slowest}});
  }
  return lanes;
}

ordered_json visits_json(const std::vector<VisitSummary>& visits) {
  ordered_json list = ordered_json::array();
  for (const VisitSummary& visit : visits)
    list.push_back({{"session", visit.session},
                    {"frames", visit.frames},
                    {"people", visit.people},
                    {"people_off_map", visit.off_map},
                    {"people_without_pose", visit.without_pose},
                    {"weight", visit.weight}});
  return list;
}

std::string counted(std::size_t n, const char* of) { return std::to_string(n) + " " + of; }

// Prints the inputs that were not used, one line each.
void say_people_left_out(const Console& console,
                         const DetectionsTaken& taken,
                         const std::vector<VisitSummary>& visits) {
  for (const std::string& file : taken.empty_tables)
    console.note(file + ": no rows; a session in which nobody was found is named with --observed");
  if (taken.without_session > 0)
    console.note(counted(taken.without_session,
                         "detections lie outside the time of every session and are left out"));
  if (taken.tables.known > 0)
    console.note(counted(taken.tables.known, "detections are in the map already: counted once"));
  if (taken.tables.replaced > 0)
    console.note(counted(taken.tables.replaced, "older detections replaced"));
  if (taken.truth.replaced > 0)
    console.note(counted(taken.truth.replaced, "older detections replaced by the truth"));
  for (const VisitSummary& visit : visits) {
    if (visit.off_map > 0)
      console.note(visit.session + ": " +
                   counted(visit.off_map,
                           "people where the map has no place (off lanes and what "
                           "lies beside them) are left out"));
    if (visit.without_pose > 0)
      console.note(
          visit.session + ": " +
          counted(visit.without_pose, "people at times when the map has no pose are left out"));
  }
}

void say_speeds(const Console& console, const SpeedMap& speeds, std::size_t visits, double most) {
  console.say(std::to_string(speeds.cells.size()) + " places, " +
              fixed(100.0 * speeds.coverage(), 1) + " % of them seen in " + std::to_string(visits) +
              " visits; presence at most " + fixed(most, 3));
  for (const LaneProfile& profile : speeds.profiles) {
    const auto slowest =
        std::min_element(profile.places.begin(), profile.places.end(),
                         [](const LaneSpeed& a, const LaneSpeed& b) { return a.speed < b.speed; });
    console.say("lane " + std::to_string(profile.lane) + ": slowest " + fixed(slowest->speed, 2) +
                " m/s at " + fixed(slowest->s_m, 1) + " m");
  }
}

}  // namespace

void print_speeds(const Console& console, const SpeedsResult& result) {
  const SpeedMap& speeds = result.speeds;
  const DetectionsTaken& taken = result.taken;
  if (result.config_kept)
    console.say("by the configuration that the map keeps; --config replaces it");
  for (const std::uint64_t lane : result.limits_lost)
    console.note("limits_mps: lane " + std::to_string(lane) +
                 " is no more; its limit holds nowhere (--config tells limits anew)");
  say_people_left_out(console, taken, result.visits);
  say_stale_items(console, result.items, speeds.now_ns);
  say_speeds(console, speeds, result.visits.size(), result.presence_max);
  if (result.places_solved)
    console.say("solved for " + std::to_string(*result.places_solved) +
                " places around what is new");
  console.result({{"places", speeds.cells.size()},
                  {"places_solved", result.places_solved.value_or(speeds.cells.size())},
                  {"coverage", speeds.coverage()},
                  {"presence_max", result.presence_max},
                  {"detections_added", taken.tables.added + taken.truth.added},
                  {"detections_known", taken.tables.known + taken.truth.known},
                  {"detections_replaced", taken.tables.replaced + taken.truth.replaced},
                  {"detections_without_session", taken.without_session},
                  {"tables_without_rows", taken.empty_tables},
                  {"visits", visits_json(result.visits)},
                  {"lanes", lanes_json(speeds)},
                  {"items", items_json(result.items, speeds.now_ns)},
                  {"config_kept", result.config_kept},
                  {"digest", result.digest}});
}

}  // namespace roadbook
