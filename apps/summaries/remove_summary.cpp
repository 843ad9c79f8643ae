#include "apps/summaries/remove_summary.hpp"

#include <nlohmann/json.hpp>

namespace roadbook {

void print_removal(const Console& console, const RemoveResult& result, const std::string& session) {
  console.say("session " + session + " removed: " + std::to_string(result.sessions) +
              (result.sessions == 1 ? " session, " : " sessions, ") +
              std::to_string(result.keyframes) + " keyframes and " +
              std::to_string(result.landmarks) + " landmarks stay, " +
              std::to_string(result.landmarks_lost) + " landmarks were removed with it");
  if (result.labels_moved > 0)
    console.say(std::to_string(result.labels_moved) + " labels moved to images of other sessions");
  if (result.labels_dropped > 0)
    console.say(std::to_string(result.labels_dropped) + " labels deleted");
  if (result.edits_dropped > 0)
    console.say(std::to_string(result.edits_dropped) + " edits that name it were removed");
  if (result.pieces > result.pieces_before)
    console.say(std::to_string(result.pieces) + " pieces, " + std::to_string(result.pieces_before) +
                " before: only this session joined them, other commands refuse the map");
  for (const std::string& table : result.tables_dropped)
    console.say("table " + table + " was removed: it numbers the sessions");
  console.result({{"session", session},
                  {"sessions", result.sessions},
                  {"keyframes", result.keyframes},
                  {"landmarks", result.landmarks},
                  {"landmarks_lost", result.landmarks_lost},
                  {"labels_moved", result.labels_moved},
                  {"labels_dropped", result.labels_dropped},
                  {"edits_dropped", result.edits_dropped},
                  {"pieces", result.pieces},
                  {"tables_dropped", result.tables_dropped},
                  {"digest", result.digest}});
}

}  // namespace roadbook
