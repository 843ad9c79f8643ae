#include "apps/summaries/merge_summary.hpp"

#include <nlohmann/json.hpp>

#include "apps/summaries/map_summary.hpp"
#include "base/format.hpp"

namespace roadbook {

void print_split(const Console& console,
                 const SplitResult& result,
                 const std::filesystem::path& output) {
  console.say("session " + result.session + ": " + std::to_string(result.keyframes) +
              " keyframes, " + std::to_string(result.landmarks) + " landmarks and " +
              std::to_string(result.labels) + " labels");
  if (result.pieces > 1)
    console.say(std::to_string(result.pieces) +
                " pieces, which only other sessions join: other commands refuse this map");
  console.say("map: " + output.string());
  console.result({{"session", result.session},
                  {"keyframes", result.keyframes},
                  {"landmarks", result.landmarks},
                  {"observations", result.observations},
                  {"labels", result.labels},
                  {"pieces", result.pieces},
                  {"map", output.string()},
                  {"digest", result.digest}});
}

void print_merge(const Console& console,
                 const MergeResult& result,
                 const std::filesystem::path& map) {
  auto came = nlohmann::ordered_json::array();
  for (const MergeRow& row : result.came) {
    console.say("session " + row.name + ": " + fixed(100.0 * row.localised_share, 0) + " % of " +
                std::to_string(row.keyframes) + " keyframes localised in the map");
    came.push_back({{"session", row.name},
                    {"keyframes", row.keyframes},
                    {"localised_share", row.localised_share}});
  }
  console.warn(dropped_warnings(result.dropped, map));
  console.say(std::to_string(result.sessions) + " sessions, " + std::to_string(result.keyframes) +
              " keyframes, " + std::to_string(result.landmarks) + " landmarks; " +
              std::to_string(result.labels) + " labels copied");
  console.say("map: " + map.string());
  console.result({{"came", came},
                  {"sessions", result.sessions},
                  {"keyframes", result.keyframes},
                  {"landmarks", result.landmarks},
                  {"labels", result.labels},
                  {"dropped", dropped_json(result.dropped)},
                  {"digest", result.digest}});
}

}  // namespace roadbook
