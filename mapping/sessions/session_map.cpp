#include "mapping/sessions/session_map.hpp"

#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/pipeline/map_stages.hpp"
#include "mapping/sessions/join_session.hpp"
#include "mapping/sessions/map_part.hpp"
#include "mapping/sessions/stored_input.hpp"

namespace roadbook {
namespace {

void require_enough(const Map& part, const std::string& name, const MapOptions& options) {
  const auto refuse = [&](std::size_t count, const char* what, int least) {
    throw Refused("error: part of session " + name + ": got " + std::to_string(count) + " " + what +
                  ", want at least " + std::to_string(least));
  };
  if (part.keyframes.size() < at(options.min_keyframes))
    refuse(part.keyframes.size(), "keyframes", options.min_keyframes);
  if (part.landmarks.size() < at(options.gate.min_landmarks))
    refuse(part.landmarks.size(), "landmarks", options.gate.min_landmarks);
}

// The drive begins with its first keyframe.
void begin_anew(Map& part) {
  Session& session = part.sessions.front();
  session.localised_share = std::numeric_limits<double>::quiet_NaN();
  session.t_begin_ns = part.keyframes.front().t_ns;
  session.t_end_ns = part.keyframes.back().t_ns;
  const double before_m = part.keyframes.front().travelled_m;
  for (Keyframe& keyframe : part.keyframes) keyframe.travelled_m -= before_m;
  part.keyframes.front().wheels.reset();
  part.keyframes.front().after_gap = false;
  part.landmark_sessions.clear();
}

void renew_covariances(const MapOptions& options, Map& part) {
  const StoredInput stored = stored_input(part);
  Relaxed relaxed;
  Adjusted adjusted;
  for (std::size_t k = 0; k < part.keyframes.size(); ++k) {
    adjusted.T_map_vehicle.push_back(part.T_map_vehicle(static_cast<int>(k)));
    relaxed.component.push_back(part.keyframes[k].piece);
  }
  relaxed.T_map_vehicle = adjusted.T_map_vehicle;
  adjusted.tracks = join_tracks(stored.input.odometry, stored.same);
  const std::vector<int> landmarks = landmarks_of_tracks(part, adjusted.tracks);
  for (std::size_t t = 0; t < landmarks.size(); ++t)
    if (landmarks[t] >= 0) adjusted.tracks[t].p_map = part.p_map(part.landmarks[at(landmarks[t])]);
  adjusted.stage =
      make_bundle(stored.input, adjusted.T_map_vehicle, adjusted.tracks, options.bundle);
  if (const int scale = adjusted.stage.scale_of_session.front(); scale >= 0)
    adjusted.stage.problem.scales[at(scale)].value = part.sessions.front().wheel_scale;
  add_covariances(stored.input, relaxed, {}, options, adjusted);
  if (adjusted.covariance.usable)
    for (std::size_t k = 0; k < part.keyframes.size(); ++k)
      part.keyframes[k].covariance = adjusted.covariance.poses[k];
  const auto& of_track = adjusted.landmark_covariance.of_track;
  for (std::size_t t = 0; t < of_track.size(); ++t)
    if (landmarks[t] >= 0 && is_known(of_track[t]))
      part.landmarks[at(landmarks[t])].covariance = of_track[t];
}

}  // namespace

Map map_of_session(const Map& map, int session, const TimeSpan& span, const MapOptions& options) {
  std::vector<char> keeps;
  std::size_t count = 0;
  for (const Keyframe& keyframe : map.keyframes) {
    const bool stays = keyframe.session == session && span.contains(keyframe.t_ns);
    keeps.push_back(stays ? 1 : 0);
    count += stays ? 1 : 0;
  }
  Map part;
  if (count > 0) part = part_of_map(map, keeps);
  require_enough(part, map.sessions[at(session)].name, options);
  begin_anew(part);
  renew_covariances(options, part);
  return part;
}

}  // namespace roadbook
