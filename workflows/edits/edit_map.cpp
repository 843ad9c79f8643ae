#include "workflows/edits/edit_map.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "mapping/edits/edited_map.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/edits/edit_file.hpp"
#include "workflows/edits/edit_record.hpp"

namespace roadbook {
namespace {

bool has_moved(const Map& before, const Map& after) {
  for (std::size_t k = 0; k < before.keyframes.size(); ++k)
    if (before.T_map_vehicle(static_cast<int>(k)).matrix() !=
        after.T_map_vehicle(static_cast<int>(k)).matrix())
      return true;
  return false;
}

void store_edited(const std::filesystem::path& file,
                  const Map& now,
                  const Map& edited,
                  const std::vector<MapEdit>& edits,
                  const Map* before,
                  EditResult& result) {
  const MapLayers layers(file);
  const std::vector<Label> labels = read_labels(file);
  MapUpdate update(file);
  update.write_map(edited);
  write_edits(update, edits, before);
  if (piece_count(edited) != piece_count(now))
    update.set_meta(kPiecesKey, std::to_string(piece_count(edited)));
  if (has_moved(now, edited)) {
    for (const std::string& name : layer_names(file))
      if (!stays_when_poses_move(name) && update.remove(name)) result.dropped.push_back(name);
    write_label_layers(update, layers, edited, labels);
  }
  update.commit();
}

void measure_moves(const Map& before, const Map& after, EditResult& result) {
  std::vector<double> moves;
  for (std::size_t k = 0; k < before.keyframes.size(); ++k)
    moves.push_back((before.T_map_vehicle(static_cast<int>(k)).translation() -
                     after.T_map_vehicle(static_cast<int>(k)).translation())
                        .norm());
  if (moves.empty()) return;
  std::sort(moves.begin(), moves.end());
  result.moved_median_m = moves[moves.size() / 2];
  result.moved_max_m = moves.back();
}

MapOptions options_with(int num_threads) {
  MapOptions options;
  options.num_threads = num_threads;
  return options;
}

// The map with its edits. Faults of places name the file of the new edits.
Map edited_by(const EditRequest& request,
              const Map& base,
              const std::vector<MapEdit>& edits,
              const Progress& progress) {
  try {
    return edited_map(base, edits, options_with(request.num_threads), progress);
  } catch (const BadInput& bad) {
    std::vector<Problem> problems = bad.problems();
    for (Problem& problem : problems)
      if (problem.file.empty()) problem.file = request.edits.string();
    throw BadInput(std::move(problems));
  }
}

}  // namespace

bool stays_when_poses_move(const std::string& table) {
  static const std::set<std::string> tables = [] {
    std::set<std::string> names{"poses",      "landmark_points", kEditTable,
                                kBeforeTable, "label_classes",   "layer_styles"};
    names.insert(measured_tables().begin(), measured_tables().end());
    names.insert(learning_tables().begin(), learning_tables().end());
    return names;
  }();
  return tables.contains(table) || is_label_layer(table) || table.ends_with("_events");
}

EditResult edit_map(const EditRequest& request, Messages& messages) {
  const MapHold hold(request.map);
  EditResult result;
  result.edits = stored_edits(request.map);
  result.digest = load_meta(request.map).digest;
  if (request.edits.empty() && request.undo == 0) return result;
  std::vector<MapEdit> edits = result.edits;
  if (!request.edits.empty()) {
    const auto more = read_edit_file(request.edits);
    edits.insert(edits.end(), more.begin(), more.end());
  }
  if (request.undo != 0) {
    if (request.undo < 1 || request.undo > static_cast<int>(result.edits.size()))
      throw InvalidOption("--undo", std::to_string(request.undo),
                          result.edits.empty()
                              ? "nothing: the map has no edits"
                              : "1 to " + std::to_string(result.edits.size()) + " (--list)");
    edits.erase(edits.begin() + request.undo - 1);
  }
  const Map now = load_map_with_corners(request.map);
  const std::optional<Map> before = stored_map_before_edits(request.map);
  const bool is_new = result.edits.empty();
  if (!before && !is_new && request.undo != 0) {
    // A session came after the edits: the map without this edit is not stored.
    MapUpdate update(request.map);
    write_edits(update, edits, nullptr);
    update.commit();
    result.undone_later = true;
  } else {
    // Without the map before the edits, those made earlier are in the poses already.
    const Map& base = before ? *before : now;
    const bool is_whole = before || is_new;
    const Map edited = edited_by(request, base, edits, messages.progress());
    measure_moves(now, edited, result);
    store_edited(request.map, now, edited, edits, is_whole ? &base : nullptr, result);
  }
  result.edits = std::move(edits);
  result.digest = load_meta(request.map).digest;
  return result;
}

bool repeat_edits(const std::filesystem::path& map, int num_threads, Messages& messages) {
  const MapHold hold(map);
  std::vector<MapEdit> edits = stored_edits(map);
  if (edits.empty() || MapLayers(map).has(kBeforeTable)) return false;
  const Map before = load_map_with_corners(map);
  const auto has = [&](const std::string& name) {
    return std::any_of(before.sessions.begin(), before.sessions.end(),
                       [&](const Session& session) { return session.name == name; });
  };
  const std::size_t lost = std::erase_if(edits, [&](const MapEdit& edit) {
    return !has(edit.a.session) || (edit.kind != EditKind::kAnchor && !has(edit.b.session));
  });
  if (lost > 0)
    messages.note(std::to_string(lost) +
                  " edits name sessions that the map lacks; they are removed");
  EditResult result;
  store_edited(map, before,
               edited_map(before, edits, options_with(num_threads), messages.progress()), edits,
               &before, result);
  return true;
}

}  // namespace roadbook
