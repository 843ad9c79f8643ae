#include "apps/summaries/edit_summary.hpp"

#include <nlohmann/json.hpp>

#include "base/format.hpp"
#include "workflows/edits/edit_file.hpp"

namespace roadbook {

void print_edits(const Console& console, const EditResult& result, bool only_lists) {
  nlohmann::ordered_json edits = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < result.edits.size(); ++i) {
    console.say(std::to_string(i + 1) + ": " + text_of(result.edits[i]));
    edits.push_back({{"edit", i + 1}, {"text", edit_yaml(result.edits[i])}});
  }
  if (result.edits.empty()) console.say("no edits");
  if (result.undone_later)
    console.say("the map keeps its shape until it is built again (map --batch)");
  else if (!only_lists)
    console.say("poses moved by " + fixed(result.moved_median_m, 3) + " m median, " +
                fixed(result.moved_max_m, 3) + " m at most");
  for (const std::string& layer : result.dropped)
    console.say("layer " + layer + " was removed: it no longer fits the poses");
  console.result({{"edits", edits},
                  {"moved_m", {{"median", result.moved_median_m}, {"max", result.moved_max_m}}},
                  {"undone_later", result.undone_later},
                  {"dropped", result.dropped},
                  {"digest", result.digest}});
}

}  // namespace roadbook
