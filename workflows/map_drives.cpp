#include "workflows/map_drives.hpp"

#include <algorithm>
#include <utility>

#include "drive/vehicle_yaml.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "mapping/pipeline/map_inputs.hpp"
#include "mapping/sessions/extend_map.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "semantics/labels/label_drives.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "semantics/labels/space_rows.hpp"
#include "workflows/diagnosis/motion_doubts.hpp"
#include "workflows/edits/edit_map.hpp"
#include "workflows/edits/edit_record.hpp"
#include "workflows/further_drives.hpp"
#include "workflows/settings/effect_model.hpp"

namespace roadbook {
namespace {

std::vector<Label> labels_there(const std::filesystem::path& map) {
  return std::filesystem::exists(map) ? read_labels(map) : std::vector<Label>();
}

// Returns the digest of the label events. It is an input of the map, because labelled rows
// straighten the map.
std::string digest_of_labels(const std::filesystem::path& map) {
  if (!std::filesystem::exists(map)) return {};
  const auto digests = load_meta(map).table_digests;
  const auto found = digests.find("label_events");
  return found == digests.end() ? std::string() : found->second;
}

// Adds what further extensions report to what the first ones did.
void add_summary(MapSummary next, MapSummary& summary) {
  const auto put_before = [](auto& list, const auto& earlier) {
    list.insert(list.begin(), earlier.begin(), earlier.end());
  };
  put_before(next.stages, summary.stages);
  put_before(next.warnings, summary.warnings);
  put_before(next.dropped, summary.dropped);
  put_before(next.cameras, summary.cameras);
  next.drive_seconds += summary.drive_seconds;
  summary = std::move(next);
}

MapResult extended_by(const std::vector<std::filesystem::path>& drives,
                      const MapRequest& request,
                      const MapOptions& options,
                      Messages& messages) {
  MapResult result;
  result.drives = drives;
  for (const auto& drive : drives)
    add_summary(extend_map(drive, request.map, options, messages.progress()), result.summary);
  return result;
}

MapResult made_map(const MapRequest& request, const MapOptions& options, Messages& messages) {
  if (options.replace) refuse_same_drives(request.drives);
  if (!options.replace && !request.batch) {
    const FurtherDrives further = further_drives(request.map, request.drives, messages);
    if (!further.drives.empty()) return extended_by(further.drives, request, options, messages);
    // With the options of before nothing is left to do; with others the extension is refused.
    if (!further.is_new && was_extended(request.map))
      return extended_by({request.drives.back()}, request, options, messages);
  }
  const auto drives =
      options.replace ? request.drives : with_drives_of_map(request.map, request.drives, messages);
  MapResult result{build_map(drives, request.map, options, messages.progress()), {}, drives};
  if (repeat_edits(request.map, options.num_threads, messages)) {
    messages.note("the edits of the map were made again");
    result.summary.digest = load_meta(request.map).digest;
  }
  return result;
}

// Where a camera of the drive is in doubt, its errors are in the poses as well.
bool doubts_a_camera(const std::vector<Problem>& warnings, const std::filesystem::path& drive) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const Problem& p) {
    const std::filesystem::path file(p.file);
    const std::string name = file.filename().string();
    if (!name.starts_with("cam") || name.find_first_not_of("0123456789", 3) != std::string::npos)
      return false;
    const auto is_drive = [&](const std::filesystem::path& folder) {
      return (folder / "").lexically_normal() == (drive / "").lexically_normal();
    };
    return is_drive(file.parent_path()) || is_drive(file.parent_path().parent_path());
  });
}

// The map is saved already: a drive that cannot be compared is a line, no failure.
void warn_of_motion(const std::filesystem::path& file,
                    const EffectSizes& model,
                    Messages& messages,
                    MapResult& result) {
  std::vector<Problem>& warnings = result.summary.warnings;
  const std::vector<Problem> of_cameras = warnings;
  const Map map = load_map(file);
  for (const auto& folder : result.drives) try {
      if (doubts_a_camera(of_cameras, folder)) continue;
      for (Problem& doubt : motion_doubts(map, Drive::open(folder), model))
        warnings.push_back(std::move(doubt));
    } catch (const BadInput& e) {
      messages.note("the wheels were not compared with the images: " + std::string(e.what()));
    }
}

}  // namespace

MapResult map_drives(const MapRequest& request, Messages& messages) {
  const MapHold hold(request.map);  // what is read of the map stays true until it is written
  MapOptions options = request.options;
  options.keep_tables = measured_tables();
  options.keep_tables.emplace_back(kEditTable);
  options.keep_tables_of_drives = learning_tables();
  if (request.equal_rows) {
    // Rows are one prior of all poses.
    if (request.adjust && *request.adjust != SessionAdjust::kAll)
      throw InvalidOption("--equal-rows", "--adjust near or none", "--adjust all");
    options.adjust = SessionAdjust::kAll;
  } else if (request.adjust) {
    options.adjust = *request.adjust;
  }
  if (!options.session_name.empty() && (request.drives.size() > 1 || request.batch))
    throw InvalidOption("--as", options.session_name, "a name for one drive, without --batch");
  if (request.equal_rows) options.rows_digest = digest_of_labels(request.map);
  options.check_what_goes = [&](const ExistingMap& m) { check_labels_stay(request.map, m); };
  std::optional<Problem> lost_places;
  options.more_layers = [&](const Map& map) {
    const std::vector<Label> labels = labels_there(request.map);
    lost_places = warning_of_lost_places(request.map, map, labels);
    return label_layers(map, labels);
  };
  if (request.equal_rows)
    options.equal_rows = [&](const Map& map) { return space_rows(map, labels_there(request.map)); };
  if (!request.vehicle.empty()) options.vehicle = load_vehicle(request.vehicle);
  if (!request.model.empty()) options.model = read_effect_model(request.model);
  MapResult result = made_map(request, options, messages);
  if (result.summary.is_unchanged) return result;
  if (options.vehicle)
    for (const auto& drive : result.drives) {
      const auto doubts = doubts_of_given_vehicle(request.vehicle, *options.vehicle, drive);
      result.summary.warnings.insert(result.summary.warnings.end(), doubts.begin(), doubts.end());
    }
  if (lost_places) result.summary.warnings.push_back(*lost_places);
  warn_of_motion(request.map, options.model, messages, result);
  result.dropped = dropped_work(result.summary.dropped, request.map);
  return result;
}

}  // namespace roadbook
