#include "exchange/layers/dropped_work.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace roadbook {
namespace {

struct Work {
  const char* name;
  const char* verb;  // null: none
  std::vector<std::string_view> layers;
};

// In the order of the commands: a work is made from those before it. The friction map's knots stay
// in the map; `roads` draws its layers again on the new lanes.
const std::vector<Work>& all_work() {
  static const std::vector<Work> work{
      {"overhead image",
       "overhead",
       {"overhead", "overhead_count", "overhead_variance", "overhead_sources", "overhead_frames",
        "overhead_blocks"}},
      {"learning",
       "label",
       {"label_learning", "people_learning", "label_sightings", "box_examples", "person_examples",
        "person_answers", "person_instants"}},
      {"labels without a place", "label", {"parking_spaces", "crossings", "other_labels"}},
      {"road network",
       "roads",
       {"lanes", "lane_paths", "intersections", "lane_path_segments", "road_network",
        "space_links"}},
      {"friction map",
       "roads",
       {"friction", "friction_settings", "friction_knots", "property_classes"}},
      {"occupancy grid",
       "occupancy",
       {"occupancy", "occupancy_sigma", "occupancy_age", "occupancy_coverage", "occupancy_sessions",
        "occupancy_colours"}},
      {"items of layers", "layers --put ITEMS.geojson", {"layer_items"}},
      {"people", "detect", {"people"}},
      {"speed map",
       "speeds",
       {"dynamic_map", "speed_profile", "speed_settings", "speed_config", "speed_map",
        "speed_sigma", "speed_colours", "sighting_sessions", "sight_blockers", "detections",
        "looks"}}};
  return work;
}

// Rasters of a property of the ground: NAME_mean, NAME_sigma, NAME_colours.
bool is_property_raster(const std::string& layer, const std::vector<std::string>& all) {
  for (const std::string_view suffix : {"_mean", "_sigma", "_colours"}) {
    if (!layer.ends_with(suffix)) continue;
    const std::string mean = layer.substr(0, layer.size() - suffix.size()) + "_mean";
    if (std::find(all.begin(), all.end(), mean) != all.end()) return true;
  }
  return false;
}

// Place in `all_work`; its size for layers of other programs.
std::size_t work_of(const std::string& layer, const std::vector<std::string>& all) {
  const auto& work = all_work();
  for (std::size_t i = 0; i < work.size(); ++i)
    if (std::find(work[i].layers.begin(), work[i].layers.end(), layer) != work[i].layers.end())
      return i;
  if (!is_property_raster(layer, all)) return work.size();
  return work_of("friction", all);
}

// As a shell takes it.
std::string shell_quoted(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-+,:@%=";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::vector<DroppedWork> dropped_work(const std::vector<std::string>& layers,
                                      const std::filesystem::path& map) {
  // Landmarks drawn as points are the map's own; they are left out where there are too many. Ages
  // go and come with their layers.
  std::vector<DroppedWork> dropped;
  for (const Work& work : all_work())
    dropped.push_back({work.name,
                       {},
                       std::string("roadbook ") + work.verb + " -m " + shell_quoted(map.string())});
  dropped.push_back({"layers of other programs", {}, ""});
  for (const std::string& layer : layers)
    if (layer != "landmark_points" && layer != "layer_ages")
      dropped[work_of(layer, layers)].layers.push_back(layer);
  std::erase_if(dropped, [](const DroppedWork& work) { return work.layers.empty(); });
  return dropped;
}

std::vector<Problem> dropped_warnings(const std::vector<DroppedWork>& dropped,
                                      const std::filesystem::path& map) {
  std::vector<Problem> warnings;
  for (const DroppedWork& work : dropped)
    warnings.push_back(
        {Severity::kWarning, map.string(), 0, work.name,
         "poses other than those it was made with (" + joined(work.layers) + " left out)",
         work.command.empty() ? "the program that wrote it, to write it again"
                              : "`" + work.command + "`, which makes it again"});
  return warnings;
}

}  // namespace roadbook
