#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook::test {

inline double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

// Residuals [px, full-size image] of the map's observations.
struct Residuals {
  std::vector<double> of_joined;  ///< lengths; landmarks of several sessions
  std::vector<double> of_one;     ///< lengths; landmarks of one session
  int joined = 0;                 ///< landmarks of several sessions
  int off = 0;                    ///< of them, off by more than 2 px (rms) in one session
};

inline Residuals residuals_of(const Map& map) {
  std::map<std::pair<int, int>, std::vector<double>> by_session;  // landmark, session
  for (const Observation& seen : map.observations) {
    const int session = map.keyframes[static_cast<std::size_t>(seen.keyframe)].session;
    const MountedCamera& camera = map.sessions[static_cast<std::size_t>(session)]
                                      .rig.cameras[static_cast<std::size_t>(seen.camera)];
    const Eigen::Vector3d p =
        (map.T_map_vehicle(seen.keyframe) * camera.T_vehicle_camera).inverse() *
        map.p_map(map.landmarks[static_cast<std::size_t>(seen.landmark)]);
    const auto pixel = camera.camera.project(p);
    by_session[{seen.landmark, session}].push_back(
        pixel ? (*pixel - seen.pixel.cast<double>()).norm() : 1e3);
  }
  std::map<int, std::vector<const std::vector<double>*>> by_landmark;
  for (const auto& [key, lengths] : by_session) by_landmark[key.first].push_back(&lengths);
  Residuals result;
  for (const auto& [landmark, sessions] : by_landmark) {
    bool is_off = false;
    for (const auto* lengths : sessions) {
      auto& all = sessions.size() > 1 ? result.of_joined : result.of_one;
      all.insert(all.end(), lengths->begin(), lengths->end());
      double sum = 0.0;
      for (const double length : *lengths) sum += length * length;
      is_off |= std::sqrt(sum / static_cast<double>(lengths->size())) > 2.0;
    }
    if (sessions.size() < 2) continue;
    ++result.joined;
    result.off += is_off ? 1 : 0;
  }
  return result;
}

}  // namespace roadbook::test
