#include "mapping/sessions/curate_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/se3.hpp"
#include "mapping/landmark_weights.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_lock.hpp"

namespace roadbook {
namespace {

using Place = std::tuple<int, int, int, int>;  // x and y [m], eighth of the headings, camera

// Indices of the places of each landmark, ascending, and the number of places.
struct Places {
  std::vector<std::vector<int>> of_landmark;
  std::size_t count = 0;
};

Places places_of(const Map& map) {
  std::vector<std::array<int, 3>> of_keyframe;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(k));
    const double eighths = heading_of(T) / (2.0 * std::numbers::pi) * 8.0;
    of_keyframe.push_back({static_cast<int>(std::floor(T.translation().x())),
                           static_cast<int>(std::floor(T.translation().y())),
                           (static_cast<int>(std::floor(eighths + 0.5)) + 8) % 8});
  }
  Places places;
  places.of_landmark.resize(map.landmarks.size());
  std::map<Place, int> ids;
  for (const Observation& o : map.observations) {
    const auto& [x, y, heading] = of_keyframe[at(o.keyframe)];
    // Cameras of different rigs with the same index share a place: they look the same way.
    const int id =
        ids.try_emplace({x, y, heading, o.camera}, static_cast<int>(ids.size())).first->second;
    places.of_landmark[at(o.landmark)].push_back(id);
  }
  places.count = ids.size();
  for (std::vector<int>& list : places.of_landmark) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return places;
}

// Landmarks that were seen, the best first.
std::vector<int> best_first(const Map& map) {
  const std::vector<double> weights = landmark_weights(map);
  std::vector<std::set<int>> seen_by(map.landmarks.size());
  std::vector<int> views(map.landmarks.size(), 0);
  for (const Observation& o : map.observations) {
    seen_by[at(o.landmark)].insert(map.keyframes[at(o.keyframe)].session);
    ++views[at(o.landmark)];
  }
  std::vector<std::set<int>> passed_by = seen_by;
  for (const LandmarkSession& row : map.landmark_sessions)
    if (row.expected > 0) passed_by[at(row.landmark)].insert(row.session);
  // Of few sessions, little is known: one half of one more counts to each.
  const auto value = [&](int l) {
    return weights[at(l)] * (static_cast<double>(seen_by[at(l)].size()) + 0.5) /
           (static_cast<double>(passed_by[at(l)].size()) + 1.0);
  };
  const auto sigma = [&](int l) {
    const Eigen::Matrix3d& covariance = map.landmarks[at(l)].covariance;
    return is_known(covariance) ? covariance.trace() : 1.0;
  };
  std::vector<std::tuple<double, int, double, int>> ranks;
  for (int l = 0; l < static_cast<int>(map.landmarks.size()); ++l)
    if (views[at(l)] > 0) ranks.emplace_back(-value(l), -views[at(l)], sigma(l), l);
  std::sort(ranks.begin(), ranks.end());
  std::vector<int> best;
  for (const auto& rank : ranks) best.push_back(std::get<3>(rank));
  return best;
}

Curation cover_of(const Places& places, const std::vector<int>& best, int per_place) {
  Curation curation;
  curation.per_place = per_place;
  curation.places = places.count;
  curation.keeps.assign(places.of_landmark.size(), 0);
  std::vector<int> count(places.count, 0);
  for (const int l : best) {
    const std::vector<int>& of_landmark = places.of_landmark[at(l)];
    const bool is_needed = std::any_of(of_landmark.begin(), of_landmark.end(),
                                       [&](int place) { return count[at(place)] < per_place; });
    if (!is_needed) continue;
    curation.keeps[at(l)] = 1;
    ++curation.kept;
    for (const int place : of_landmark) ++count[at(place)];
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
  const std::vector<int> best = best_first(map);
  Curation curation = cover_of(places, best, options.per_place);
  if (!options.most || curation.kept <= *options.most) return curation;
  // The largest number a place that keeps no more than `most`.
  int enough = 0;
  int too_many = options.per_place;
  while (too_many - enough > 1) {
    const int middle = (enough + too_many) / 2;
    (cover_of(places, best, middle).kept <= *options.most ? enough : too_many) = middle;
  }
  if (enough == 0)
    throw InvalidOption(
        "--most", std::to_string(*options.most),
        ">= " + std::to_string(cover_of(places, best, 1).kept) + ", one landmark for each place");
  return cover_of(places, best, enough);
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
