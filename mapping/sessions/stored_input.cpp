#include "mapping/sessions/stored_input.hpp"

#include <algorithm>
#include <tuple>

#include "base/index.hpp"
#include "vo/track_options.hpp"

namespace roadbook {
namespace {

Eigen::Vector2f half_size_pixel(const Eigen::Vector2f& full_size_pixel) {
  return ((full_size_pixel.cast<double>() - Eigen::Vector2d::Constant(0.5)) / kFullPerHalfPixel)
      .cast<float>();
}

VoKeyframe keyframe_of(const Map& map, std::size_t k) {
  const Keyframe& stored = map.keyframes[k];
  VoKeyframe keyframe;
  keyframe.frame = at(stored.drive_frame);
  keyframe.t_ns = stored.t_ns;
  keyframe.T_odom_vehicle = map.T_map_vehicle(static_cast<int>(k));
  keyframe.wheels = stored.wheels;
  keyframe.travelled_m = stored.travelled_m;
  keyframe.reversing = stored.reversing;
  keyframe.after_gap =
      stored.after_gap || (k > 0 && map.keyframes[k - 1].session != stored.session);
  const std::size_t cameras = map.sessions[at(stored.session)].rig.cameras.size();
  keyframe.features.resize(cameras);
  keyframe.tracks.resize(cameras);
  return keyframe;
}

}  // namespace

StoredInput stored_input(const Map& map) {
  StoredInput stored;
  MappingInput& input = stored.input;
  for (const Session& session : map.sessions) {
    input.half_rigs.push_back(half_size(session.rig));
    input.has_wheels.push_back(session.wheels.has_value() &&
                               session.scale_source == ScaleSource::kWheels);
  }
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    input.odometry.keyframes.push_back(keyframe_of(map, k));
    input.session.push_back(map.keyframes[k].session);
  }
  struct View {
    int landmark;
    int session;
    int camera;
    int keyframe;
    int feature;
  };
  std::vector<View> views;
  views.reserve(map.observations.size());
  for (const Observation& seen : map.observations) {
    VoKeyframe& keyframe = input.odometry.keyframes[at(seen.keyframe)];
    Features& features = keyframe.features[at(seen.camera)];
    views.push_back({seen.landmark, map.keyframes[at(seen.keyframe)].session, seen.camera,
                     seen.keyframe, static_cast<int>(features.size())});
    features.pixels.push_back(half_size_pixel(seen.pixel));
    features.descriptors.push_back(map.landmarks[at(seen.landmark)].descriptor);
    keyframe.tracks[at(seen.camera)].push_back(-1);
  }
  for (const LoneCorner& corner : map.corners) {
    VoKeyframe& keyframe = input.odometry.keyframes[at(corner.keyframe)];
    keyframe.features[at(corner.camera)].pixels.push_back(half_size_pixel(corner.pixel));
    keyframe.features[at(corner.camera)].descriptors.push_back(corner.descriptor);
    keyframe.tracks[at(corner.camera)].push_back(-1);
  }
  std::sort(views.begin(), views.end(), [](const View& a, const View& b) {
    return std::tie(a.landmark, a.session, a.camera, a.keyframe, a.feature) <
           std::tie(b.landmark, b.session, b.camera, b.keyframe, b.feature);
  });
  const auto is_one_track = [](const View& a, const View& b) {
    return a.landmark == b.landmark && a.session == b.session && a.camera == b.camera;
  };
  for (std::size_t begin = 0, end = 0; begin < views.size(); begin = end) {
    const int id = static_cast<int>(input.odometry.tracks.size());
    Track track;
    track.camera = views[begin].camera;
    track.p_odom = map.p_map(map.landmarks[at(views[begin].landmark)]);
    for (end = begin; end < views.size() && is_one_track(views[begin], views[end]); ++end) {
      const View& view = views[end];
      // A damaged map may show a landmark twice in one image: the first key point stays.
      if (end > begin && views[end - 1].keyframe == view.keyframe) continue;
      track.observations.push_back({view.keyframe, view.feature});
      input.odometry.keyframes[at(view.keyframe)].tracks[at(view.camera)][at(view.feature)] = id;
    }
    if (begin > 0 && views[begin - 1].landmark == views[begin].landmark)
      stored.same.push_back(
          {id - 1, {views[begin].keyframe, views[begin].camera, views[begin].feature}});
    input.odometry.tracks.push_back(std::move(track));
    stored.landmark_of_track.push_back(views[begin].landmark);
  }
  return stored;
}

}  // namespace roadbook
