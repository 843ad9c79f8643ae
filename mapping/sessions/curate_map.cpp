#include "mapping/sessions/curate_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>
#include <set>
#include <utility>

#include "base/cell_grid.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/se3.hpp"
#include "mapping/landmark_weights.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_lock.hpp"

namespace roadbook {
namespace {

// A place reaches so far along and across the way from the keyframe that made it.
constexpr double kAlongM = 0.5;
constexpr double kAcrossM = 1.5;
constexpr double kTurnRad = std::numbers::pi / 8.0;

// Indices of the places of each landmark, ascending, and the number of places.
struct Places {
  std::vector<std::vector<int>> of_landmark;
  std::size_t count = 0;
};

// The stretch of way of each keyframe: the nearest that an earlier keyframe made, or a new one. So
// sessions that drive side by side share their places.
std::vector<int> stretches_of(const Map& map) {
  struct Stretch {
    int id;
    Eigen::Isometry3d T_map_vehicle;
  };
  CellGrid<Stretch> grid(2.0 * kAcrossM);
  std::vector<int> of_keyframe;
  int count = 0;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(k));
    int nearest = -1;
    double least = kAlongM;
    grid.visit_near(T.translation().head<2>(), [&](const Stretch& stretch) {
      const Eigen::Isometry3d off = stretch.T_map_vehicle.inverse() * T;
      const double along = std::abs(off.translation().x());
      if (std::abs(off.translation().y()) > kAcrossM ||
          std::abs(off.translation().z()) > kAcrossM || std::abs(heading_of(off)) > kTurnRad ||
          !(along < least))
        return;
      least = along;
      nearest = stretch.id;
    });
    if (nearest < 0) {
      nearest = count++;
      grid.insert(T.translation().head<2>(), {nearest, T});
    }
    of_keyframe.push_back(nearest);
  }
  return of_keyframe;
}

Places places_of(const Map& map) {
  const std::vector<int> stretches = stretches_of(map);
  Places places;
  places.of_landmark.resize(map.landmarks.size());
  std::map<std::pair<int, int>, int> ids;  // stretch, camera
  for (const Observation& o : map.observations) {
    // Cameras of different rigs with the same index share a place: they look the same way.
    const int id =
        ids.try_emplace({stretches[at(o.keyframe)], o.camera}, static_cast<int>(ids.size()))
            .first->second;
    places.of_landmark[at(o.landmark)].push_back(id);
  }
  places.count = ids.size();
  for (std::vector<int>& list : places.of_landmark) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return places;
}

// How much each landmark is worth to localisation; 0: it was never seen.
std::vector<double> values_of(const Map& map) {
  const std::vector<double> weights = landmark_weights(map);
  std::vector<std::set<int>> seen_by(map.landmarks.size());
  for (const Observation& o : map.observations)
    seen_by[at(o.landmark)].insert(map.keyframes[at(o.keyframe)].session);
  std::vector<std::set<int>> passed_by = seen_by;
  for (const LandmarkSession& row : map.landmark_sessions)
    if (row.expected > 0) passed_by[at(row.landmark)].insert(row.session);
  std::vector<double> values;
  for (std::size_t l = 0; l < weights.size(); ++l)
    // Of few sessions, little is known: one half of one more counts to each.
    values.push_back(seen_by[l].empty()
                         ? 0.0
                         : weights[l] * (static_cast<double>(seen_by[l].size()) + 0.5) /
                               (static_cast<double>(passed_by[l].size()) + 1.0));
  return values;
}

// The greedy cover: next comes the landmark with the largest value times number of places that need
// it. The number only falls, so that only the first landmark must be counted again.
Curation cover_of(const Places& places, const std::vector<double>& values, int per_place) {
  Curation curation;
  curation.per_place = per_place;
  curation.places = places.count;
  curation.keeps.assign(places.of_landmark.size(), 0);
  std::vector<int> count(places.count, 0);
  const auto gain_of = [&](int l) {
    const auto& of_landmark = places.of_landmark[at(l)];
    return values[at(l)] * static_cast<double>(std::count_if(
                               of_landmark.begin(), of_landmark.end(),
                               [&](int place) { return count[at(place)] < per_place; }));
  };
  // Largest gain first, then smallest index.
  std::priority_queue<std::pair<double, int>> next;
  for (std::size_t l = 0; l < values.size(); ++l)
    if (const double gain = gain_of(static_cast<int>(l)); gain > 0.0)
      next.emplace(gain, -static_cast<int>(l));
  while (!next.empty()) {
    const auto [gain, negative] = next.top();
    next.pop();
    const int l = -negative;
    const double now = gain_of(l);
    if (now <= 0.0) continue;
    if (now < gain) {
      next.emplace(now, negative);
      continue;
    }
    curation.keeps[at(l)] = 1;
    ++curation.kept;
    for (const int place : places.of_landmark[at(l)]) ++count[at(place)];
  }
  curation.full_places = static_cast<std::size_t>(
      std::count_if(count.begin(), count.end(), [&](int n) { return n >= per_place; }));
  return curation;
}

}  // namespace

void CurateOptions::check() const {
  if (per_place < 1) throw InvalidOption("--per-place", std::to_string(per_place), ">= 1");
  if (most && *most < 1) throw InvalidOption("--most", std::to_string(*most), ">= 1");
}

Curation curation_of(const Map& map, const CurateOptions& options) {
  options.check();
  const Places places = places_of(map);
  const std::vector<double> values = values_of(map);
  Curation curation = cover_of(places, values, options.per_place);
  if (!options.most || curation.kept <= *options.most) return curation;
  // The largest number a place that keeps no more than `most`.
  int enough = 0;
  int too_many = options.per_place;
  while (too_many - enough > 1) {
    const int middle = (enough + too_many) / 2;
    (cover_of(places, values, middle).kept <= *options.most ? enough : too_many) = middle;
  }
  if (enough == 0)
    throw InvalidOption(
        "--most", std::to_string(*options.most),
        ">= " + std::to_string(cover_of(places, values, 1).kept) + ", one landmark for each place");
  return cover_of(places, values, enough);
}

Map curated_map(const Map& map, const Curation& curation) {
  Map curated = map;
  std::vector<int> id(map.landmarks.size(), -1);
  curated.landmarks.clear();
  for (std::size_t l = 0; l < map.landmarks.size(); ++l)
    if (curation.keeps[l] != 0) {
      id[l] = static_cast<int>(curated.landmarks.size());
      curated.landmarks.push_back(map.landmarks[l]);
    }
  curated.observations.clear();
  for (Observation o : map.observations)
    if ((o.landmark = id[at(o.landmark)]) >= 0) curated.observations.push_back(o);
  curated.landmark_sessions.clear();
  for (LandmarkSession row : map.landmark_sessions)
    if ((row.landmark = id[at(row.landmark)]) >= 0) curated.landmark_sessions.push_back(row);
  return curated;
}

CurateSummary curate_map(const std::filesystem::path& path,
                         const CurateOptions& options,
                         bool dry_run) {
  options.check();
  const MapHold hold(path);
  const Map map = load_map_with_corners(path);
  CurateSummary summary;
  summary.landmarks_before = map.landmarks.size();
  summary.observations_before = map.observations.size();
  summary.bytes_before = std::filesystem::file_size(path);
  summary.curation = curation_of(map, options);
  const Map curated = curated_map(map, summary.curation);
  summary.observations = curated.observations.size();
  if (!dry_run && curated.landmarks.size() < map.landmarks.size()) {
    MapUpdate update(path);
    update.write_map(curated);
    update.note("curate", std::to_string(curated.landmarks.size()) + " of " +
                              std::to_string(map.landmarks.size()) + " landmarks, " +
                              std::to_string(summary.curation.per_place) + " a place");
    update.commit();
  }
  summary.bytes = std::filesystem::file_size(path);
  summary.digest = load_meta(path).digest;
  return summary;
}

}  // namespace roadbook
