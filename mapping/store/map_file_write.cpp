#include <cmath>
#include <cstddef>
#include <limits>

#include "base/error.hpp"
#include "mapping/store/map_file_codec.hpp"
#include "mapping/store/map_file_names.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {
namespace {

// NaN, which is unknown, as NULL.
void bind_or_null(SqlStatement& statement, int parameter, double value) {
  if (std::isnan(value))
    statement.bind_null(parameter);
  else
    statement.bind(parameter, value);
}

void write_sessions(const SqlDatabase& database, const std::vector<Session>& sessions) {
  SqlStatement session =
      database.prepare("INSERT INTO sessions VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  SqlStatement place = database.prepare("INSERT INTO session_places VALUES(?, ?)");
  std::int64_t id = 0;
  for (const Session& s : sessions) {
    session.bind(1, id).bind_text(2, s.name).bind_text(3, s.drive_digest);
    session.bind(4, s.wheel_scale).bind_text(6, scale_source_name(s.scale_source));
    bind_or_null(session, 5, s.wheel_scale_sigma);
    bind_or_null(session, 7, s.scale_sigma);
    bind_or_null(session, 10, s.localised_share);
    session.bind(8, s.t_begin_ns).bind(9, s.t_end_ns).run();
    place.bind(1, id).bind_text(2, s.drive_path).run();
    ++id;
  }
}

void write_cameras(const SqlDatabase& database, const std::vector<Session>& sessions) {
  SqlStatement insert =
      database.prepare("INSERT INTO cameras VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  std::int64_t id = 0;
  for (std::size_t s = 0; s < sessions.size(); ++s)
    for (std::size_t c = 0; c < sessions[s].rig.cameras.size(); ++c) {
      const MountedCamera& mounted = sessions[s].rig.cameras[c];
      std::string parameters;
      for (const double p : mounted.camera.parameters) pack(parameters, p);
      const std::string pose = pack_pose(mounted.T_vehicle_camera);
      insert.bind(1, id++).bind(2, static_cast<std::int64_t>(s));
      insert.bind(3, static_cast<std::int64_t>(c)).bind_text(4, mounted.name);
      insert.bind_text(5, camera_model_key(mounted.camera.model));
      insert.bind(6, mounted.camera.width).bind(7, mounted.camera.height);
      insert.bind(8, mounted.camera.max_angle_rad).bind(9, mounted.time_offset_s);
      insert.bind_blob(10, parameters).bind_blob(11, pose);
      insert.bind(12, mounted.exposed_after_s).bind(13, mounted.rolling_shutter_s).run();
    }
}

void write_wheels(const SqlDatabase& database, const std::vector<Session>& sessions) {
  SqlStatement insert =
      database.prepare("INSERT INTO wheel_models VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    if (!sessions[s].wheels) continue;
    insert.bind(1, static_cast<std::int64_t>(s));
    int parameter = 2;
    for (const double value : wheel_values(*sessions[s].wheels)) insert.bind(parameter++, value);
    insert.run();
  }
}

void write_vehicles(const SqlDatabase& database, const std::vector<Session>& sessions) {
  SqlStatement insert = database.prepare("INSERT INTO vehicles VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    insert.bind(1, static_cast<std::int64_t>(s));
    insert.bind_text(2, vehicle_source_name(sessions[s].vehicle_source));
    int parameter = 3;
    for (const auto& value : vehicle_values(sessions[s].vehicle)) {
      if (value)
        insert.bind(parameter++, *value);
      else
        insert.bind_null(parameter++);
    }
    insert.run();
  }
}

// Unknown is NULL. Returns the bytes, which must live until the statement has run.
template <typename Matrix>
[[nodiscard]] std::string bind_covariance(SqlStatement& statement,
                                          int parameter,
                                          const Matrix& covariance) {
  std::string bytes = is_known(covariance) ? pack_matrix(covariance) : std::string();
  if (bytes.empty())
    statement.bind_null(parameter);
  else
    statement.bind_blob(parameter, bytes);
  return bytes;
}

void write_poses(const SqlDatabase& database, const Map& map) {
  SqlStatement frame = database.prepare("INSERT INTO map_frames VALUES(?, ?)");
  for (std::size_t i = 0; i < map.map_frames.size(); ++i) {
    const std::string pose = pack_pose(map.map_frames[i].T_map_frame);
    frame.bind(1, static_cast<std::int64_t>(i)).bind_blob(2, pose).run();
  }
  SqlStatement keyframe =
      database.prepare("INSERT INTO keyframes VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& k = map.keyframes[i];
    const std::string pose = pack_pose(k.T_frame_vehicle);
    keyframe.bind(1, static_cast<std::int64_t>(i)).bind(2, k.session).bind(3, k.t_ns);
    keyframe.bind(4, k.drive_frame).bind(5, k.map_frame).bind_blob(6, pose);
    const std::string covariance = bind_covariance(keyframe, 7, k.covariance);
    keyframe.bind(8, k.travelled_m);
    keyframe.bind(9, k.reversing ? 1 : 0).bind(10, k.after_gap ? 1 : 0);
    keyframe.bind(11, k.piece).run();
  }
}

void write_motions(const SqlDatabase& database, const std::vector<Keyframe>& keyframes) {
  SqlStatement insert = database.prepare("INSERT INTO keyframe_motions VALUES(?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (!keyframes[i].wheels) continue;
    const PlanarMotion& wheels = *keyframes[i].wheels;
    const std::string motion = pack_matrix(wheels.motion);
    const std::string covariance = pack_matrix(wheels.covariance);
    insert.bind(1, static_cast<std::int64_t>(i)).bind_blob(2, motion).bind_blob(3, covariance);
    insert.bind(4, wheels.distance_m).bind(5, wheels.reversing ? 1 : 0).run();
  }
}

void write_corners(const SqlDatabase& database, const std::vector<LoneCorner>& corners) {
  SqlStatement insert = database.prepare("INSERT INTO keyframe_corners VALUES(?, ?, ?, ?, ?)");
  std::int64_t id = 0;
  for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
    std::string bytes;
    for (end = begin; end < corners.size() && corners[end].keyframe == corners[begin].keyframe &&
                      corners[end].camera == corners[begin].camera;
         ++end) {
      pack(bytes, corners[end].pixel.x());
      pack(bytes, corners[end].pixel.y());
      bytes.append(reinterpret_cast<const char*>(corners[end].descriptor.data()),
                   corners[end].descriptor.size());
    }
    insert.bind(1, id++).bind(2, corners[begin].keyframe).bind(3, corners[begin].camera);
    insert.bind(4, static_cast<std::int64_t>(end - begin)).bind_blob(5, bytes).run();
  }
}

void write_landmark_sessions(const SqlDatabase& database,
                             const std::vector<LandmarkSession>& sessions) {
  SqlStatement insert = database.prepare("INSERT INTO landmark_sessions VALUES(?, ?, ?, ?, ?, ?)");
  std::int64_t id = 0;
  for (const LandmarkSession& s : sessions) {
    insert.bind(1, id++).bind(2, s.landmark).bind(3, s.session);
    insert.bind(4, s.expected).bind(5, s.seen);
    if (s.last_ns)
      insert.bind(6, *s.last_ns);
    else
      insert.bind_null(6);
    insert.run();
  }
}

void write_landmarks(const SqlDatabase& database, const std::vector<Landmark>& landmarks) {
  SqlStatement landmark = database.prepare("INSERT INTO landmarks VALUES(?, ?, ?, ?, ?, ?, ?)");
  SqlStatement descriptor = database.prepare("INSERT INTO descriptors VALUES(?, ?)");
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Landmark& l = landmarks[i];
    const auto id = static_cast<std::int64_t>(i);
    std::string data;
    for (const std::uint8_t byte : l.descriptor) pack(data, byte);
    landmark.bind(1, id).bind(2, l.map_frame).bind(3, l.p_frame.x()).bind(4, l.p_frame.y());
    const std::string covariance = bind_covariance(landmark, 6, l.covariance);
    landmark.bind(5, l.p_frame.z()).bind(7, l.ground ? 1 : 0).run();
    descriptor.bind(1, id).bind_blob(2, data).run();
  }
}

/// Indices of the observations, keyframe by keyframe, in the given order within each.
std::vector<std::size_t> by_keyframe(const Map& map, std::vector<std::size_t>& begin) {
  begin.assign(map.keyframes.size() + 1, 0);
  for (const Observation& o : map.observations) ++begin[static_cast<std::size_t>(o.keyframe) + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  std::vector<std::size_t> order(map.observations.size());
  for (std::size_t i = 0; i < map.observations.size(); ++i)
    order[next[static_cast<std::size_t>(map.observations[i].keyframe)]++] = i;
  return order;
}

void write_observations(const SqlDatabase& database, const Map& map) {
  std::vector<std::size_t> begin;
  const std::vector<std::size_t> order = by_keyframe(map, begin);
  SqlStatement insert = database.prepare("INSERT INTO observations VALUES(?, ?, ?, ?, ?)");
  std::int64_t id = 0;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    std::map<int, std::string> packed;  // by camera
    for (std::size_t i = begin[k]; i < begin[k + 1]; ++i) {
      const Observation& o = map.observations[order[i]];
      std::string& bytes = packed[o.camera];
      pack(bytes, static_cast<std::int32_t>(o.landmark));
      pack(bytes, o.pixel.x());
      pack(bytes, o.pixel.y());
      pack(bytes, o.sigma_px);
    }
    for (const auto& [camera, bytes] : packed) {
      insert.bind(1, id++).bind(2, static_cast<std::int64_t>(k)).bind(3, camera);
      insert.bind(4, static_cast<std::int64_t>(bytes.size() / kObservationBytes));
      insert.bind_blob(5, bytes).run();
    }
  }
}

void write_loops(const SqlDatabase& database, const std::vector<LoopEdge>& loops) {
  SqlStatement insert = database.prepare("INSERT INTO loops VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  std::int64_t id = 0;
  for (const LoopEdge& loop : loops) {
    const std::string pose = pack_pose(loop.T_from_to);
    const std::string information = pack_matrix(loop.information);
    insert.bind(1, id++).bind(2, loop.from).bind(3, loop.to).bind_blob(4, pose);
    insert.bind_blob(5, information).bind(6, loop.inliers).bind(7, loop.accepted ? 1 : 0);
    insert.bind(8, loop.weight).bind_text(9, loop.reason).run();
  }
}

}  // namespace

void write_map_tables(const SqlDatabase& database, const Map& map) {
  write_sessions(database, map.sessions);
  write_cameras(database, map.sessions);
  write_wheels(database, map.sessions);
  write_vehicles(database, map.sessions);
  write_poses(database, map);
  write_motions(database, map.keyframes);
  write_corners(database, map.corners);
  write_landmarks(database, map.landmarks);
  write_observations(database, map);
  write_landmark_sessions(database, map.landmark_sessions);
  write_loops(database, map.loops);
}

}  // namespace roadbook
