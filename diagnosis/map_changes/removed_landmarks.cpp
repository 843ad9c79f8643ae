#include "diagnosis/map_changes/removed_landmarks.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/size_interval.hpp"

namespace roadbook {
namespace {

constexpr const char* kLandmarksGone = "map.landmarks_gone";
constexpr std::size_t kFewestLandmarks = 50;

Eigen::Vector3d middle_of_lost(const RemovedRegion& thing,
                               const std::vector<LandmarkRedetection>& chances) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const std::size_t i : thing.landmarks) {
    if (chances[i].found) continue;
    sum += chances[i].p_map;
    count += 1.0;
  }
  return sum / count;
}

FoundPlace gone_place(const RemovedRegion& thing, const std::vector<LandmarkRedetection>& chances) {
  FoundPlace place;
  const GroupCount group = count_of(thing.landmarks, chances);
  place.middle = middle_of_lost(thing, chances);
  for (const std::size_t i : thing.landmarks) {
    place.expected_sightings += chances[i].expected;
    place.sightings += static_cast<std::size_t>(chances[i].sightings);
    if (!chances[i].found)
      place.reach_m = std::max(place.reach_m, (chances[i].p_map - place.middle).head<2>().norm());
  }
  place.landmarks = thing.landmarks.size();
  place.expected = group.expected();
  place.found = static_cast<std::size_t>(group.count);
  place.p = thing.corrected;
  return place;
}

// Adds a region; the standard error of its share is binomial.
void add_place(const RemovedRegion& thing,
               const std::vector<LandmarkRedetection>& chances,
               RemovedLandmarks& all) {
  const FoundPlace place = gone_place(thing, chances);
  const auto items = static_cast<double>(place.landmarks);
  const double left = static_cast<double>(place.found) / place.expected;
  all.gone += items * (1.0 - left);
  all.sigma = std::hypot(
      all.sigma, items * std::sqrt((static_cast<double>(place.found) + 1.0)) / place.expected);
  const GroupCount group = count_of(thing.landmarks, chances);
  all.gain += fallen_log(group) - group_log(group, all.scatter);
  all.places.push_back(place);
  all.judged.insert(all.judged.end(), thing.landmarks.begin(), thing.landmarks.end());
}

FoundCause gone_cause(const RemovedLandmarks& g, double known) {
  FoundCause cause;
  const auto n = static_cast<double>(g.landmarks);
  cause.effect = kLandmarksGone;
  cause.unit = "1";
  cause.size = g.gone / n - known;
  const SizeInterval interval = interval95(kLandmarksGone, cause.size, g.sigma / n);
  cause.low = interval.low;
  cause.high = interval.high;
  cause.p = g.places.front().p;
  cause.evidence = g.gain;
  cause.gain.total = g.gain;
  cause.gain.per_sample = g.gain / n;
  // Standard error as for noise effects: z^2 / 2 has a standard deviation of z.
  const double scatter = std::sqrt(2.0 * std::max(0.0, g.gain));
  cause.gain.low = g.gain - kSigmas95 * scatter;
  cause.gain.high = g.gain + kSigmas95 * scatter;
  cause.gain.interleaved = true;
  cause.note =
      "share of the landmarks that should be visible again; a lower bound, because only the places "
      "listed count; these landmarks were removed, or new objects hide them; the gain is corrected "
      "for the choice of the places";
  cause.places = g.places;
  return cause;
}

}  // namespace

RemovedLandmarks removed_landmarks(std::vector<LandmarkRedetection> chances,
                                   const RemovedRegionOptions& options) {
  RemovedLandmarks g;
  g.landmarks = chances.size();
  if (chances.empty()) return g;
  const RemovedRegions things = removed_regions(chances, options);
  g.tests = things.tests;
  g.scatter = things.scatter;
  for (const RemovedRegion& thing : things.named) add_place(thing, chances, g);
  // The r regions were selected from n cells by the same counts. The gain is reduced by the log of
  // the number of selections, at most (e n / r)^r.
  const auto named = static_cast<double>(g.places.size());
  if (named > 0.0) g.gain -= named * (1.0 + std::log(static_cast<double>(g.tests) / named));
  std::stable_sort(g.places.begin(), g.places.end(),
                   [](const FoundPlace& a, const FoundPlace& b) { return a.p < b.p; });
  return g;
}

Diagnosis diagnose_gone(const Map& map,
                        int session,
                        const std::vector<LandmarkTwin>& twins,
                        const EffectSizes& known,
                        const std::vector<std::string>& without) {
  Diagnosis d;
  if (map.sessions.size() < 2 || holds(without, kLandmarksGone)) return d;
  d.looked_for.emplace_back(kLandmarksGone);
  const RemovedLandmarks g = removed_landmarks(landmark_redetections(map, session, twins));
  d.samples = g.landmarks;
  if (g.landmarks < kFewestLandmarks || g.tests == 0) {
    d.not_observable.emplace_back(kLandmarksGone);
    d.notes.push_back(
        "removed landmarks not diagnosed, too few landmarks of other sessions should be visible "
        "again: " +
        std::to_string(g.landmarks));
    return d;
  }
  const double already = effect_size(known, "map", "landmarks_gone");
  if (g.places.empty() || g.gone - already * static_cast<double>(g.landmarks) < 2.0 * g.sigma)
    return d;
  d.causes.push_back(gone_cause(g, already));
  d.extended[kLandmarksGone] = d.causes.back().size;
  return d;
}

}  // namespace roadbook
