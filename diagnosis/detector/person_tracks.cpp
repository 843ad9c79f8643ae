#include "diagnosis/detector/person_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "diagnosis/detector/person_filter.hpp"

namespace roadbook {
namespace {

constexpr double kTrackGate = 13.8;  // chi-squared of 2 degrees of freedom, 99.9 %

struct Open {
  PersonTrack track;
  PersonFilter filter;
  double t_s = 0.0;
  std::size_t look = 0;
};

}  // namespace

std::optional<Eigen::Vector2d> place_at(const SightingReadings& readings,
                                        const PersonTrack& track,
                                        std::size_t look) {
  const auto& s = track.sightings;
  const auto after = std::lower_bound(s.begin(), s.end(), look, [&](std::size_t i, std::size_t l) {
    return readings.sightings[i].look < l;
  });
  if (after == s.end() || after == s.begin()) return std::nullopt;
  const Sighting& a = readings.sightings[*(after - 1)];
  const Sighting& b = readings.sightings[*after];
  const double part = (readings.looks[look].t_s - a.t_s) / (b.t_s - a.t_s);
  return Eigen::Vector2d(a.foot + part * (b.foot - a.foot));
}

std::vector<PersonTrack> person_tracks(const SightingReadings& readings) {
  std::vector<Open> open;
  std::vector<PersonTrack> done;
  const auto close = [&](const Open& o) {
    if (o.track.sightings.size() > 1) done.push_back(o.track);
  };
  const auto& all = readings.sightings;
  for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
    const std::size_t look = all[first].look;
    while (last < all.size() && all[last].look == look) ++last;
    std::erase_if(open, [&](const Open& o) {
      const bool gone = look - o.look > kTrackGap;
      if (gone) close(o);
      return gone;
    });
    std::vector<std::tuple<double, std::size_t, std::size_t>>
        pairs;  // -2 log likelihood, track, detection
    for (std::size_t o = 0; o < open.size(); ++o) {
      open[o].filter.predict(all[first].t_s - open[o].t_s);
      open[o].t_s = all[first].t_s;
      for (std::size_t s = first; s < last; ++s) {
        double width = 0.0;
        const double d2 = open[o].filter.distance2(all[s].foot, all[s].covariance, width);
        if (d2 < kTrackGate) pairs.emplace_back(d2 + width, o, s);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<bool> taken(last - first, false), fed(open.size(), false);
    for (const auto& [prior_cost, o, s] : pairs) {
      if (fed[o] || taken[s - first]) continue;
      fed[o] = taken[s - first] = true;
      open[o].filter.update(all[s].foot, all[s].covariance);
      open[o].track.sightings.push_back(s);
      open[o].look = look;
    }
    for (std::size_t s = first; s < last; ++s)
      if (!taken[s - first])
        open.push_back({{{s}}, PersonFilter(all[s].foot, all[s].covariance), all[s].t_s, look});
  }
  for (const Open& o : open) close(o);
  std::stable_sort(done.begin(), done.end(), [](const PersonTrack& a, const PersonTrack& b) {
    return a.sightings.front() < b.sightings.front();
  });
  return done;
}

}  // namespace roadbook
