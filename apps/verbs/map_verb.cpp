#include <memory>
#include <nlohmann/json.hpp>

#include "apps/further_drives.hpp"
#include "apps/summary_json.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"
#include "base/format.hpp"
#include "exchange/layers/dropped_work.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "mapping/pipeline/build_map.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_names.hpp"
#include "semantics/labels/label_drives.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "semantics/labels/space_rows.hpp"
#include "workflows/effect_model.hpp"

namespace roadbook {
namespace {

struct MapCommand {
  std::vector<std::filesystem::path> drives;
  std::filesystem::path map;
  std::filesystem::path model;
  std::filesystem::path vehicle;
  MapOptions options;
  bool equal_rows = false;
};

void say_summary(const Console& console, const MapSummary& summary) {
  console.say(std::to_string(summary.keyframes) + " keyframes, " +
              std::to_string(summary.landmarks) + " landmarks, " +
              std::to_string(summary.loops_accepted) + " loops accepted, " +
              std::to_string(summary.loops_rejected) + " rejected");
  console.say("reprojection error " + fixed(summary.reprojection_median_px, 2) + " px median, " +
              fixed(summary.reprojection_rms_px, 2) + " px rms");
  console.say("scale from " + std::string(scale_source_name(summary.scale_source)) +
              (summary.scale_sigma > 0.0 ? ", +- " + fixed(100.0 * summary.scale_sigma, 2) + " %"
                                         : std::string()));
  say_vehicle(console, sources_of(summary.vehicles));
  if (summary.ate_median_m && summary.ate_p95_m)
    console.say("against the drive's truth: " + fixed(*summary.ate_median_m, 3) + " m median, " +
                fixed(*summary.ate_p95_m, 3) + " m 95 %");
  double seconds = 0.0;
  for (const StageTime& stage : summary.stages) seconds += stage.seconds;
  console.say("built in " + fixed(seconds, 1) + " s");
}

void say_rows(const Console& console, const EqualRowsUsed& rows) {
  console.say(std::to_string(rows.rows) + " rows of equal spaces took part (" +
              std::to_string(rows.spaces) + " spaces), " + std::to_string(rows.refused) +
              " did not fit");
}

std::vector<Label> labels_there(const std::filesystem::path& map) {
  return std::filesystem::exists(map) ? read_labels(map) : std::vector<Label>();
}

// Times and warnings of this run, for `report`: of this machine, so outside the content digest.
void remember_run(const std::filesystem::path& map, const MapSummary& summary) {
  MapUpdate update(map);
  update.set_meta("place.summary", to_json(summary).dump());
  update.commit();
}

// What the run that made the map told of it; today's run did nothing and took no time.
nlohmann::ordered_json result_of_last_run(const std::filesystem::path& map,
                                          const MapSummary& summary) {
  auto result = to_json(summary);
  const auto values = load_meta(map).values;
  const auto note = values.find("place.summary");
  if (note != values.end()) {
    const auto run = nlohmann::ordered_json::parse(note->second, nullptr, false);
    for (const char* key : {"reprojection_px", "truth", "rows"})
      if (run.is_object() && run.contains(key)) result[key] = run[key];
  } else {
    result["reprojection_px"] = {{"median", nullptr}, {"rms", nullptr}};
  }
  result["unchanged"] = true;
  result["dropped"] = nlohmann::ordered_json::array();
  return result;
}

// Of what people said of the map's labels: rows of labels straighten the map.
std::string digest_of_labels(const std::filesystem::path& map) {
  if (!std::filesystem::exists(map)) return {};
  const auto digests = load_meta(map).table_digests;
  const auto found = digests.find("label_events");
  return found == digests.end() ? std::string() : found->second;
}

nlohmann::ordered_json dropped_json(const std::vector<DroppedWork>& dropped) {
  auto list = nlohmann::ordered_json::array();
  for (const DroppedWork& work : dropped)
    list.push_back({{"name", work.name},
                    {"layers", work.layers},
                    {"command", work.command.empty() ? nlohmann::ordered_json()
                                                     : nlohmann::ordered_json(work.command)}});
  return list;
}

ExitStatus run_map(const MapCommand& command, Console& console, const CommonOptions& common) {
  MapOptions options = command.options;
  options.num_threads = common.threads;
  options.keep_tables = measured_tables();
  options.keep_tables_of_drives = learning_tables();
  if (command.equal_rows) options.rows_digest = digest_of_labels(command.map);
  options.check_what_goes = [&](const ExistingMap& m) { check_labels_stay(command.map, m); };
  std::optional<Problem> lost_places;
  options.more_layers = [&](const Map& map) {
    const std::vector<Label> labels = labels_there(command.map);
    lost_places = warning_of_lost_places(command.map, map, labels);
    return label_layers(map, labels);
  };
  if (command.equal_rows)
    options.equal_rows = [&](const Map& map) { return space_rows(map, labels_there(command.map)); };
  options.vehicle = given_vehicle(command.vehicle);
  if (!command.model.empty()) options.model = read_effect_model(command.model);
  const auto drives =
      options.replace ? command.drives : with_drives_of_map(command.map, command.drives, console);
  MapSummary summary = build_map(drives, command.map, options, console.progress());
  if (summary.is_unchanged) {
    console.say(
        "nothing to do: the map was made from these drives, options and seed, by this "
        "version of roadbook");
    console.say("map: " + command.map.string());
    console.result(result_of_last_run(command.map, summary));
    return ExitStatus::kDone;
  }
  if (lost_places) summary.warnings.push_back(*lost_places);
  remember_run(command.map, summary);
  console.warn(summary.warnings);
  const auto dropped = dropped_work(summary.dropped, command.map);
  console.warn(dropped_warnings(dropped, command.map));
  say_summary(console, summary);
  if (summary.rows) say_rows(console, *summary.rows);
  console.say("map: " + command.map.string());
  auto result = to_json(summary);
  result["unchanged"] = false;
  result["dropped"] = dropped_json(dropped);
  console.result(result);
  return ExitStatus::kDone;
}

}  // namespace

Verb map_verb() {
  auto command = std::make_shared<MapCommand>();
  return {"map", "builds a map from one drive or several",
          [command](Options& options) {
            options.add("DRIVE", &command->drives, "recorded drives, oldest first").required = true;
            options.add("--map,-m", &command->map, "map file to write, or to extend").required =
                true;
            options.add("--model", &command->model, "YAML file of imperfections that are known");
            add_vehicle_option(options, &command->vehicle);
            options.add("--equal-rows", &command->equal_rows,
                        "labelled rows of equal spaces straighten the map");
            options.add("--replace", &command->options.replace,
                        "a map of these drives alone, whatever is there");
            options.add("--seed", &command->options.seed, "of everything drawn by chance");
          },
          [command](Console& console, const CommonOptions& common) {
            return run_map(*command, console, common);
          }};
}

}  // namespace roadbook
