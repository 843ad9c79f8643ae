#include "workflows/removed_session.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/pieces.hpp"
#include "mapping/pipeline/map_inputs.hpp"
#include "mapping/sessions/remove_session.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/edits/edit_record.hpp"

namespace roadbook {
namespace {

constexpr const char* kWho = "map --remove";

// The map of the sessions before `session`, whose numbers stay.
std::optional<Map> earlier_sessions(const Map& map, int session) {
  if (session == 0) return std::nullopt;
  Map earlier = map;
  for (int s = static_cast<int>(map.sessions.size()) - 1; s >= session; --s)
    earlier = without_session(earlier, s).map;
  return earlier;
}

// The label at the same place of the map, on an image of `earlier`; empty if none shows it.
std::optional<Label> on_other_image(const Map& map, const Map& earlier, const Label& label) {
  const std::vector<Eigen::Vector3d> corners = corners_in_map(map, label);
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector3d& corner : corners) outline.emplace_back(corner.head<2>());
  if (outline.empty()) return std::nullopt;
  const auto anchor = anchor_for(earlier, outline);
  if (!anchor) return std::nullopt;
  Label moved = label;
  const auto box = label.shape == LabelShape::kBox ? box_in_map(map, label) : std::nullopt;
  const Label placed =
      box ? label_of_box(earlier, *anchor, *box) : label_of_polygon(earlier, *anchor, outline);
  moved.anchor = placed.anchor;
  moved.T_vehicle_label = placed.T_vehicle_label;
  moved.corners_vehicle = placed.corners_vehicle;
  return moved;
}

struct LabelMoves {
  std::vector<Label> changed;
  std::vector<Label> homeless;
  std::size_t moved = 0;
};

LabelMoves label_moves(const Map& map, int session, const std::filesystem::path& file) {
  LabelMoves moves;
  const auto goes = [&](const LabelAnchor& anchor) { return anchor.session >= session; };
  const std::optional<Map> earlier = earlier_sessions(map, session);
  for (Label label : read_labels(file)) {
    const bool has_lost_sightings =
        std::erase_if(label.sightings, [&](const LabelSighting& s) { return goes(s.anchor); }) > 0;
    if (!goes(label.anchor)) {
      if (has_lost_sightings) moves.changed.push_back(label);
      continue;
    }
    const auto moved = earlier && is_on_ground(label) ? on_other_image(map, *earlier, label)
                                                      : std::optional<Label>();
    if (moved) {
      moves.changed.push_back(*moved);
      ++moves.moved;
    } else {
      moves.homeless.push_back(label);
    }
  }
  for (const Label& label : read_image_labels(file))
    if (goes(label.anchor)) moves.homeless.push_back(label);
  return moves;
}

void refuse_homeless(const LabelMoves& moves,
                     const Map& map,
                     int session,
                     const RemoveRequest& request) {
  if (moves.homeless.empty() || request.drop_labels) return;
  constexpr std::size_t kIdsInLine = 5;
  std::string ids;
  for (std::size_t i = 0; i < moves.homeless.size() && i < kIdsInLine; ++i)
    ids += (ids.empty() ? "" : ", ") + std::to_string(moves.homeless[i].id);
  if (moves.homeless.size() > kIdsInLine) ids += ", ...";
  throw Refused(
      to_line({Severity::kError, request.map.string(), 0, "labels",
               std::to_string(moves.homeless.size()) + " (" + ids + ") that no session before " +
                   map.sessions[at(session)].name + " shows",
               "--drop-labels, which deletes them"}));
}

// The table without the rows of a session, and with the new numbers of later ones. Empty where it
// does not number sessions.
std::optional<PlainTable> without_rows_of(PlainTable table, int session) {
  const auto column = std::find_if(table.fields.begin(), table.fields.end(), [](const Field& f) {
    return f.name == "session" && f.type == FieldType::kInteger;
  });
  if (column == table.fields.end()) return std::nullopt;
  const auto c = static_cast<std::size_t>(column - table.fields.begin());
  const auto number = [&](std::vector<FieldValue>& row) {
    return std::get_if<std::int64_t>(&row[c]);
  };
  std::erase_if(table.rows, [&](auto& row) {
    const auto* s = number(row);
    return s != nullptr && *s == session;
  });
  for (auto& row : table.rows)
    if (auto* s = number(row); s != nullptr && *s > session) --*s;
  return table;
}

// Tables that number the sessions. Those that are learnt with all of them go.
void renumber_tables(const std::filesystem::path& file,
                     int session,
                     MapUpdate& update,
                     RemoveResult& result) {
  for (const std::string& table : learning_tables())
    if (update.remove(table)) result.tables_dropped.push_back(table);
  const MapLayers layers(file);
  std::set<std::string> others(learning_tables().begin(), learning_tables().end());
  for (const LayerInfo& layer : layers.list()) others.insert(layer.name);
  for (const std::string& name : layers.all_names()) {
    if (others.contains(name)) continue;
    if (auto table = without_rows_of(layers.read_table(name), session)) update.write_table(*table);
  }
}

void store_moves(const LabelMoves& moves, const std::filesystem::path& file) {
  if (moves.changed.empty() && moves.homeless.empty()) return;
  LabelStore store(file);
  if (!moves.changed.empty()) (void)store.create_all({}, kWho, {}, moves.changed);
  for (const Label& label : moves.homeless) (void)store.remove(label.id, label.version, kWho);
}

}  // namespace

RemoveResult remove_session(const RemoveRequest& request) {
  const MapHold hold(request.map);
  const Map map = load_map_with_corners(request.map);
  const int session = session_named(map, request.session, "--remove");
  const RemovedSession removed = without_session(map, session);
  const LabelMoves moves = label_moves(map, session, request.map);
  refuse_homeless(moves, map, session, request);
  store_moves(moves, request.map);

  RemoveResult result;
  MapUpdate update(request.map);
  update.write_map(removed.map);
  renumber_tables(request.map, session, update, result);
  for (const auto& [key, value] : removal_meta(request.map, map.sessions[at(session)].drive_digest))
    update.set_meta(key, value);
  std::vector<MapEdit> edits = stored_edits(request.map);
  result.edits_dropped = std::erase_if(edits, [&](const MapEdit& edit) {
    return edit.a.session == request.session ||
           (edit.kind != EditKind::kAnchor && edit.b.session == request.session);
  });
  write_edits(update, edits, nullptr);
  if (removed.pieces != removed.pieces_before)
    update.set_meta(kPiecesKey, std::to_string(removed.pieces));
  update.note("remove", request.session);
  update.commit();
  renew_label_layers(request.map);

  result.sessions = removed.map.sessions.size();
  result.keyframes = removed.map.keyframes.size();
  result.landmarks = removed.map.landmarks.size();
  result.landmarks_lost = removed.landmarks_lost;
  result.labels_moved = moves.moved;
  result.labels_dropped = moves.homeless.size();
  result.pieces_before = removed.pieces_before;
  result.pieces = removed.pieces;
  result.digest = load_meta(request.map).digest;
  return result;
}

}  // namespace roadbook
