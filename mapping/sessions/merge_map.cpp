#include "mapping/sessions/merge_map.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/localisation/landmark_index.hpp"
#include "mapping/pipeline/drive_steps.hpp"
#include "mapping/sessions/adjust_session.hpp"
#include "mapping/sessions/extended_map.hpp"
#include "mapping/sessions/join_session.hpp"
#include "mapping/sessions/map_part.hpp"
#include "mapping/sessions/place_session.hpp"
#include "mapping/sessions/stored_input.hpp"
#include "mapping/step_information.hpp"

namespace roadbook {
namespace {

// A session of the other map as a drive: its poses are the odometry.
struct StoredDrive {
  int session = 0;  // in the other map
  Map part;         // the session alone
  StoredInput stored;

  [[nodiscard]] const Session& of_map() const { return part.sessions.front(); }
  [[nodiscard]] bool is_metric() const { return of_map().scale_source != ScaleSource::kFree; }
};

StoredDrive stored_drive(const Map& other, int session) {
  std::vector<char> keeps;
  for (const Keyframe& keyframe : other.keyframes)
    keeps.push_back(keyframe.session == session ? 1 : 0);
  StoredDrive drive;
  drive.session = session;
  drive.part = part_of_map(other, keeps);
  drive.stored = stored_input(drive.part);
  auto& keyframes = drive.stored.input.odometry.keyframes;
  for (std::size_t k = 1; k < keyframes.size(); ++k)
    keyframes[k].information =
        step_information(keyframes[k - 1].T_odom_vehicle.inverse() * keyframes[k].T_odom_vehicle);
  return drive;
}

// Adds the loops of the session that localisation has not found.
void add_own_loops(const Map& part, PlacedSession& placed) {
  const auto is_known_loop = [&](const LoopEdge& edge) {
    return std::any_of(placed.loops.begin(), placed.loops.end(), [&](const LoopClosure& loop) {
      return loop.edge.from == edge.from && loop.edge.to == edge.to;
    });
  };
  for (const LoopEdge& edge : part.loops)
    if (edge.accepted && !is_known_loop(edge)) placed.loops.push_back({edge, {}});
}

struct PlacedDrive {
  std::size_t pending = 0;  // index
  PlacedSession placed;
};

bool overlaps(const PlacedSession& placed) {
  return placed.localised > 0 && placed.joined == placed.keyframes.size();
}

// The session that the map knows best; empty if it knows none.
std::optional<PlacedDrive> best_placed(const Map& map,
                                       const std::vector<StoredDrive>& pending,
                                       const MapOptions& options,
                                       const Progress& progress) {
  const LandmarkIndex index(map);
  std::optional<PlacedDrive> best;
  for (std::size_t i = 0; i < pending.size(); ++i) {
    PlacedSession placed =
        place_session(pending[i].stored.input, pending[i].is_metric(), index, options, progress);
    if (!overlaps(placed)) continue;
    if (best && placed.localised_share() <= best->placed.localised_share()) continue;
    best = PlacedDrive{i, std::move(placed)};
  }
  return best;
}

Map with_session(const Map& map,
                 const StoredDrive& drive,
                 PlacedSession& placed,
                 const MapOptions& options,
                 const Progress& progress) {
  add_own_loops(drive.part, placed);
  const JoinedSession joined =
      join_session(map, drive.stored.input, placed, options, drive.stored.same);
  Adjusted adjusted = adjust_session(joined, map, options, progress);
  add_covariances_of_session(joined, {}, options, adjusted);
  return extended_map(map, drive.of_map(), joined, placed, adjusted, options);
}

std::string names_of(const std::vector<StoredDrive>& drives) {
  std::string names;
  for (const StoredDrive& drive : drives)
    names += (names.empty() ? "" : ", ") + drive.of_map().name;
  return names;
}

}  // namespace

MergedMap merged_map(const Map& map,
                     const Map& other,
                     const MapOptions& options,
                     const Progress& progress) {
  MergedMap merged;
  merged.map = map;
  std::vector<StoredDrive> pending;
  for (int s = 0; s < static_cast<int>(other.sessions.size()); ++s)
    pending.push_back(stored_drive(other, s));
  while (!pending.empty()) {
    auto best = best_placed(merged.map, pending, options, progress);
    if (!best)
      throw Refused("error: sessions " + names_of(pending) +
                    ": got no overlap with the map, want sessions of its place");
    const StoredDrive& drive = pending[best->pending];
    merged.map = with_session(merged.map, drive, best->placed, options, progress);
    merged.sessions.push_back({drive.session, static_cast<int>(merged.map.sessions.size()) - 1,
                               best->placed.keyframes.size(), best->placed.localised_share()});
    pending.erase(pending.begin() + static_cast<std::ptrdiff_t>(best->pending));
  }
  return merged;
}

}  // namespace roadbook
