#include <algorithm>

#include "vo/odometry_state.hpp"
#include "vo/track_matching.hpp"

namespace roadbook {

namespace {
constexpr double kUnknownRadiusPx = 60.0;  // search for the first motion of all
}

std::vector<FeatureGrid> make_grids(const std::vector<Features>& features, const Rig& rig) {
  std::vector<FeatureGrid> grids;
  grids.reserve(features.size());
  for (std::size_t c = 0; c < features.size(); ++c)
    grids.emplace_back(features[c].pixels, rig.cameras[c].camera.width,
                       rig.cameras[c].camera.height);
  return grids;
}

VisualOdometry::State::Matches VisualOdometry::State::search(const VoFrame& frame,
                                                             const std::vector<FeatureGrid>& grids,
                                                             const Eigen::Isometry3d& T_odom_new,
                                                             double radius_px,
                                                             Searched searched) const {
  const Eigen::Isometry3d T_new_odom = T_odom_new.inverse();
  Matches matches;
  matches.tracks = active;
  if (searched == Searched::kKnownPlaces)
    for (auto& tracks : matches.tracks)
      std::erase_if(tracks, [&](int id) {
        return !result.tracks[static_cast<std::size_t>(id)].p_odom.has_value();
      });
  matches.features.resize(active.size());
  for (std::size_t c = 0; c < active.size(); ++c) {
    // Tracks last seen in the same keyframe share one relative motion.
    std::vector<MatchQuery> queries;
    std::vector<int> seen_in;
    for (const int id : matches.tracks[c]) {
      const Track& track = result.tracks[static_cast<std::size_t>(id)];
      const TrackObservation& o = track.observations.back();
      const Features& features = result.keyframes[static_cast<std::size_t>(o.keyframe)].features[c];
      MatchQuery query;
      query.bearing = bearing_of(static_cast<int>(c), o);
      query.pixel = features.pixels[static_cast<std::size_t>(o.feature)];
      query.descriptor = &features.descriptors[static_cast<std::size_t>(o.feature)];
      if (track.p_odom) query.p_vehicle = T_new_odom * *track.p_odom;
      queries.push_back(query);
      seen_in.push_back(o.keyframe);
    }
    matches.features[c].assign(queries.size(), -1);
    std::vector<int> owner(frame.features[c].size(), -1);
    for (int k = static_cast<int>(result.keyframes.size()) - 1;
         k >= 0 && k >= static_cast<int>(result.keyframes.size()) - 1 - options.max_skipped; --k) {
      std::vector<MatchQuery> some;
      std::vector<std::size_t> place;
      for (std::size_t q = 0; q < queries.size(); ++q)
        if (seen_in[q] == k) {
          some.push_back(queries[q]);
          place.push_back(q);
        }
      const Eigen::Isometry3d T_new_old =
          T_new_odom * result.keyframes[static_cast<std::size_t>(k)].T_odom_vehicle;
      const auto found =
          match_queries(rig.cameras[c], T_new_old, some, frame.features[c], grids[c], radius_px);
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (found[i] < 0 || owner[static_cast<std::size_t>(found[i])] >= 0) continue;
        owner[static_cast<std::size_t>(found[i])] = static_cast<int>(place[i]);
        matches.features[c][place[i]] = found[i];
      }
    }
  }
  return matches;
}

std::vector<RigObservation> VisualOdometry::State::known_points(const VoFrame& frame,
                                                                const Matches& matches) const {
  std::vector<RigObservation> points;
  for (std::size_t c = 0; c < matches.tracks.size(); ++c)
    for (std::size_t i = 0; i < matches.tracks[c].size(); ++i) {
      const Track& track = result.tracks[static_cast<std::size_t>(matches.tracks[c][i])];
      const int feature = matches.features[c][i];
      if (feature < 0 || !track.p_odom) continue;
      points.push_back({static_cast<int>(c),
                        frame.features[c].pixels[static_cast<std::size_t>(feature)].cast<double>(),
                        *track.p_odom});
    }
  return points;
}

// Corners of the last keyframe found again near their place, all cameras.
std::vector<BearingPair> VisualOdometry::State::pairs_with(const VoFrame& frame,
                                                           double& median_flow_px) const {
  const auto grids = make_grids(frame.features, rig);
  std::vector<BearingPair> pairs;
  std::vector<double> flows;
  for (std::size_t c = 0; c < active.size(); ++c) {
    std::vector<MatchQuery> queries;
    for (const int id : active[c]) {
      const TrackObservation& o = result.tracks[static_cast<std::size_t>(id)].observations.back();
      if (o.keyframe + 1 != static_cast<int>(result.keyframes.size())) continue;
      const Features& features = last().features[c];
      MatchQuery query;
      query.bearing = bearing_of(static_cast<int>(c), o);
      query.pixel = features.pixels[static_cast<std::size_t>(o.feature)];
      query.descriptor = &features.descriptors[static_cast<std::size_t>(o.feature)];
      queries.push_back(query);
    }
    const auto found = match_near(queries, frame.features[c], grids[c], kUnknownRadiusPx);
    for (std::size_t q = 0; q < found.size(); ++q) {
      if (found[q] < 0) continue;
      const Eigen::Vector2f& pixel = frame.features[c].pixels[static_cast<std::size_t>(found[q])];
      const auto bearing = rig.cameras[c].camera.bearing(pixel.cast<double>());
      if (!bearing) continue;
      pairs.push_back({static_cast<int>(c), queries[q].bearing, *bearing});
      flows.push_back(static_cast<double>((pixel - queries[q].pixel).norm()));
    }
  }
  median_flow_px = 0.0;
  if (flows.empty()) return pairs;
  const auto middle = flows.begin() + static_cast<std::ptrdiff_t>(flows.size() / 2);
  std::nth_element(flows.begin(), middle, flows.end());
  median_flow_px = *middle;
  return pairs;
}

}  // namespace roadbook
