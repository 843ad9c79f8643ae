#include "workflows/report/report_data.hpp"

#include <nlohmann/json.hpp>

#include "drive/drive.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_reading.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/drive_images.hpp"
#include "workflows/driven_passes.hpp"
#include "workflows/session_drives.hpp"
#include "workflows/session_worth.hpp"
#include "workflows/stored_network.hpp"

namespace roadbook {
namespace {

// Reads the notes that the `map` verb stored about its run.
void read_run(ReportData& data) {
  const auto note = data.meta.values.find("place.summary");
  if (note == data.meta.values.end()) return;
  const auto run = nlohmann::json::parse(note->second, nullptr, false);
  if (!run.is_object()) return;
  for (const auto& stage : run.value("stages", nlohmann::json::array()))
    data.stages.push_back(
        {stage.value("name", ""), stage.value("seconds", 0.0), stage.value("peak_rss_mb", 0.0)});
  for (const auto& warning : run.value("warnings", nlohmann::json::array()))
    data.warnings.push_back(to_line(
        {Severity::kWarning, warning.value("file", ""), warning.value("line", std::int64_t{0}),
         warning.value("field", ""), warning.value("got", ""), warning.value("want", "")}));
}

// Opens the available drives.
std::vector<std::optional<Drive>> drives_of(const ReportData& data) {
  std::vector<std::optional<Drive>> drives;
  for (const Session& session : data.map.sessions) {
    try {
      drives.emplace_back(Drive::open(session_folder(data.file, session)));
    } catch (const Error&) {
      drives.emplace_back();
    }
  }
  return drives;
}

}  // namespace

ReportData collect_report(const std::filesystem::path& map_file,
                          const std::filesystem::path& before,
                          bool look_again) {
  const MapReading reading(map_file);
  ReportData data;
  data.file = map_file;
  data.map = load_map(map_file);
  data.meta = load_meta(map_file);
  data.quality = measure_quality(data.map);
  read_run(data);
  data.truth = compare_with_truth(map_file, data.map);
  const MapLayers layers(map_file);
  data.overhead = overhead_picture(layers);
  data.network = stored_network(layers);
  data.speeds = collect_speeds(layers);
  data.occupancy = demands_of_map(map_file, load_joined_map(map_file));
  const auto drives = look_again ? drives_of(data) : std::vector<std::optional<Drive>>();
  const auto images = look_again ? images_of_drives(&data.map, &drives) : KeyframeImages();
  data.labels = collect_labels(map_file, data.map, before, images);
  const std::vector<Label> labels = read_labels(map_file);
  reading.require_same_map();
  data.value = worth_of_sessions(data.map, labels);
  if (data.network)
    (void)build_road_network(driven_passes(data.map), {}, nullptr, &data.stages_of_network);
  return data;
}

}  // namespace roadbook
