#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "mapping/map.hpp"

namespace roadbook::test {

/// A straight road of 60 m, driven there and back in each of two sessions a day apart.
inline Map driven_road() {
  Map map;
  for (int session = 0; session < 2; ++session) {
    Session s;
    s.name = "visit" + std::to_string(session);
    s.drive_path = s.name;
    s.drive_digest = s.name;
    const std::int64_t begin =
        std::int64_t{1'600'000'000'000'000'000} + session * std::int64_t{86'400'000'000'000};
    s.t_begin_ns = begin;
    for (int i = 0; i <= 300; ++i) {
      MapFrame frame;
      frame.T_map_frame.translation() = Eigen::Vector3d(0.2 * i, 0.05 * session, 0.0);
      Keyframe keyframe;
      keyframe.session = session;
      keyframe.t_ns = begin + i * std::int64_t{100'000'000};
      keyframe.drive_frame = i;
      keyframe.map_frame = static_cast<int>(map.map_frames.size());
      keyframe.travelled_m = 0.2 * i;
      keyframe.covariance.setZero();  // exact
      map.map_frames.push_back(frame);
      map.keyframes.push_back(keyframe);
      s.t_end_ns = keyframe.t_ns;
    }
    map.sessions.push_back(s);
  }
  return map;
}

/// Two sessions drive the same 60 m. The second session then drives `alone_m` further.
inline Map road_with_a_part_driven_once(double alone_m) {
  Map map = driven_road();
  Keyframe last = map.keyframes.back();
  for (double x = 60.2; x < 60.0 + alone_m; x += 0.2) {
    MapFrame frame;
    frame.T_map_frame.translation() = Eigen::Vector3d(x, 0.05, 0.0);
    last.t_ns += 100'000'000;
    ++last.drive_frame;
    last.travelled_m += 0.2;
    last.map_frame = static_cast<int>(map.map_frames.size());
    map.map_frames.push_back(frame);
    map.keyframes.push_back(last);
  }
  map.sessions.back().t_end_ns = last.t_ns;
  return map;
}

}  // namespace roadbook::test
