#include "workflows/merge_maps.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/pieces.hpp"
#include "mapping/pipeline/map_inputs.hpp"
#include "mapping/pipeline/map_paths.hpp"
#include "mapping/sessions/adjust_session.hpp"
#include "mapping/sessions/merge_map.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "mapping/store/map_reading.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/edits/edit_map.hpp"
#include "workflows/edits/edit_record.hpp"
#include "workflows/map_copy.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

constexpr const char* kMerger = "map --merge";

// Sessions are known by their names, and drives are in a map once.
void require_other_sessions(const Map& map, const Map& other, const MergeRequest& request) {
  for (const Session& theirs : other.sessions)
    for (const Session& ours : map.sessions) {
      if (theirs.name != ours.name && theirs.drive_digest != ours.drive_digest) continue;
      throw BadInput(
          {Severity::kError, request.other.string(), 0, "sessions",
           theirs.name + (theirs.name == ours.name
                              ? ", a name that " + request.map.string() + " has too"
                              : ", which is session " + ours.name + " of " + request.map.string()),
           "sessions that the map lacks"});
    }
}

// The new index of each session of the other map.
std::vector<int> indices_in_merged(const MergedMap& merged) {
  std::vector<int> index(merged.sessions.size());
  for (const MergedSession& session : merged.sessions) index[at(session.session)] = session.merged;
  return index;
}

std::vector<Label> labels_that_come(const MergeRequest& request, const MergedMap& merged) {
  const std::vector<int> index = indices_in_merged(merged);
  std::vector<Label> labels = read_labels(request.other);
  const auto in_images = read_image_labels(request.other);
  labels.insert(labels.end(), in_images.begin(), in_images.end());
  for (Label& label : labels) {
    label.anchor.session = index[at(label.anchor.session)];
    for (LabelSighting& sighting : label.sightings)
      sighting.anchor.session = index[at(sighting.anchor.session)];
    label.seen.reset();  // it is a place in the other map
  }
  return labels;
}

// Writes the merged map over the copy; layers go as after an extension.
void write_merged(const std::filesystem::path& file,
                  const MergedMap& merged,
                  const MergeRequest& request,
                  MergeResult& result) {
  std::vector<std::string> gone;
  const std::vector<MapEdit> edits = stored_edits(file);
  MapUpdate update(file);
  update.write_map(merged.map);
  if (!edits.empty()) write_edits(update, edits, nullptr);
  if (request.adjust != SessionAdjust::kNone)
    for (const std::string& name : layer_names(file))
      if (!stays_when_poses_move(name) && update.remove(name)) gone.push_back(name);
  for (const auto& [key, value] : meta_after(file, "merge " + load_meta(request.other).digest))
    update.set_meta(key, value);
  update.set_meta("gauge", gauge_of(request.adjust));
  update.note("merge", load_meta(request.other).digest);
  update.commit();
  result.dropped = dropped_work(gone, request.map);
}

void add_labels(const std::filesystem::path& file, const std::vector<Label>& labels) {
  if (!labels.empty()) {
    LabelStore store(file);
    (void)store.create_all(labels, kMerger);
  }
  renew_label_layers(file);
}

}  // namespace

MergeResult merge_maps(const MergeRequest& request, Messages& messages) {
  const MapHold hold(request.map);
  require_one_piece(request.map);
  require_one_piece(request.other);
  const MapReading reading(request.other);
  const Map map = load_map_with_corners(request.map);
  Map other = load_map_with_corners(request.other);
  require_other_sessions(map, other, request);
  for (Session& session : other.sessions)
    session.drive_path = path_from_map(session_folder(request.other, session), request.map);
  MapOptions options;
  options.adjust = request.adjust;
  options.num_threads = request.num_threads;
  const MergedMap merged = merged_map(map, other, options, messages.progress());
  const std::vector<Label> labels = labels_that_come(request, merged);
  reading.require_same_map();

  MergeResult result;
  MapCopy copy(request.map, ".merge");
  copy.begin_with_map();
  write_merged(copy.file(), merged, request, result);
  add_labels(copy.file(), labels);
  copy.put_in_place();

  for (const MergedSession& session : merged.sessions)
    result.came.push_back(
        {other.sessions[at(session.session)].name, session.keyframes, session.localised_share});
  result.sessions = merged.map.sessions.size();
  result.keyframes = merged.map.keyframes.size();
  result.landmarks = merged.map.landmarks.size();
  result.labels = labels.size();
  result.digest = load_meta(request.map).digest;
  return result;
}

}  // namespace roadbook
