#pragma once

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/random.hpp"
#include "mapping/map.hpp"

namespace roadbook::test {

/// A temporary folder that the destructor removes.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "roadbook-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

struct SmallMapSize {
  int sessions = 2;
  int keyframes = 12;  ///< a session
  int cameras = 2;
  int observations = 10;  ///< a keyframe and camera
  int landmarks = 40;
};

template <int N>
Eigen::Matrix<double, N, N> random_covariance(Random& random) {
  Eigen::Matrix<double, N, N> a;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) a(i, j) = 0.1 * random.normal();
  return a * a.transpose();
}

inline Eigen::Isometry3d random_pose(Random& random) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = random.normal();
  return se3_exp(xi);
}

inline Session small_session(int index, int cameras, Random& random) {
  Session s;
  s.name = "drive " + std::to_string(index);
  s.drive_path = "../drives/" + std::to_string(index);
  s.drive_digest = "digest of " + s.name;
  for (int c = 0; c < cameras; ++c) {
    MountedCamera mounted;
    mounted.name = "cam" + std::to_string(c);
    mounted.camera.model = c % 2 == 0 ? CameraModel::kKannalaBrandt : CameraModel::kOmni;
    for (double& p : mounted.camera.parameters) p = random.uniform(0.0, 400.0);
    mounted.camera.width = 1280;
    mounted.camera.height = 960;
    mounted.camera.max_angle_rad = 1.6;
    mounted.T_vehicle_camera = random_pose(random);
    mounted.time_offset_s = random.normal();
    mounted.exposed_after_s = 0.01 * (c + 1);
    mounted.rolling_shutter_s = -0.02 * (c + 1);
    s.rig.cameras.push_back(mounted);
  }
  if (index % 2 == 0) {
    s.wheels = WheelModel{.radius_left_m = random.uniform(0.2, 0.4)};
    s.wheels->ticks_per_turn = random.uniform(100.0, 200.0);
    s.wheels->time_offset_s = random.uniform(-0.1, 0.1);
    s.wheels->sigma_distance_per_sqrt_m = random.uniform(0.01, 0.02);
    s.wheels->sigma_heading_per_sqrt_m = random.uniform(0.003, 0.004);
    s.wheels->sigma_lateral_per_sqrt_m = random.uniform(0.005, 0.006);
    s.wheels->sigma_angle_rad = random.uniform(0.001, 0.002);
  }
  s.wheel_scale = random.uniform(0.9, 1.1);
  s.scale_source = index % 2 == 0 ? ScaleSource::kWheels : ScaleSource::kCameraHeight;
  s.scale_sigma = random.uniform();
  if (index % 2 == 0) {
    s.vehicle.length_m = 4.2 + index;
    s.vehicle.rear_overhang_m = 1.0 / 3.0;
    s.vehicle.track_width_m = 1.5;
    s.vehicle_source = VehicleSource::kOption;
  }
  // Nineteen digits; a double would lose the last three of them.
  s.t_begin_ns = 1'403'636'579'763'555'584 + index * 3'600'000'000'000;
  return s;
}

/// A consistent map of random numbers: all fields are set, but the values have no meaning.
inline Map small_map(std::uint64_t seed, const SmallMapSize& size = {}) {
  Random random(seed, "small map");
  Map map;
  for (int s = 0; s < size.sessions; ++s) {
    map.sessions.push_back(small_session(s, size.cameras, random));
    for (int i = 0; i < size.keyframes; ++i) {
      Keyframe k;
      k.session = s;
      k.t_ns = map.sessions.back().t_begin_ns + i * std::int64_t{80'000'001};
      k.drive_frame = 3 * i;
      k.map_frame = static_cast<int>(map.map_frames.size());
      k.T_frame_vehicle = random_pose(random);
      k.covariance = random_covariance<6>(random);
      k.travelled_m = 0.2 * i;
      k.reversing = i % 5 == 4;
      k.after_gap = i == 7;
      map.map_frames.push_back({random_pose(random)});
      map.keyframes.push_back(k);
    }
    map.sessions.back().t_end_ns = map.keyframes.back().t_ns;
  }
  const auto frames = map.map_frames.size();
  for (int i = 0; i < size.landmarks; ++i) {
    Landmark l;
    l.map_frame = static_cast<int>(random.below(frames));
    l.p_frame = {random.normal(), random.normal(), random.normal()};
    l.covariance = random_covariance<3>(random);
    for (std::uint8_t& byte : l.descriptor) byte = static_cast<std::uint8_t>(random.below(256));
    l.ground = i % 3 == 0;
    map.landmarks.push_back(l);
  }
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    for (int c = 0; c < size.cameras; ++c)
      for (int i = 0; i < size.observations; ++i) {
        Observation o;
        o.landmark = static_cast<int>(random.below(static_cast<std::uint64_t>(size.landmarks)));
        o.keyframe = static_cast<int>(k);
        o.camera = c;
        o.pixel = {static_cast<float>(random.uniform(0.0, 1280.0)),
                   static_cast<float>(random.uniform(0.0, 960.0))};
        o.sigma_px = static_cast<float>(random.uniform(0.5, 2.0));
        map.observations.push_back(o);
      }
  for (std::size_t k = 1; k < map.keyframes.size(); k += 2) {
    map.keyframes[k].wheels = PlanarMotion{{random.normal(), random.normal(), random.normal()},
                                           random_covariance<3>(random),
                                           random.uniform(),
                                           true};
    LoneCorner corner;
    corner.keyframe = static_cast<int>(k);
    corner.camera = static_cast<int>(k) % size.cameras;
    for (int i = 0; i < 2; ++i) {
      corner.pixel = {static_cast<float>(random.uniform(0.0, 1280.0)), 7.25F};
      for (std::uint8_t& byte : corner.descriptor)
        byte = static_cast<std::uint8_t>(random.below(256));
      map.corners.push_back(corner);
    }
  }
  if (size.sessions > 1) {
    map.sessions.back().localised_share = 0.875;
    map.landmark_sessions.push_back({2, 1, 5, 3, map.keyframes.back().t_ns});
    map.landmark_sessions.push_back({4, 1, 6, 0, std::nullopt});
  }
  LoopEdge loop;
  loop.from = 1;
  loop.to = static_cast<int>(map.keyframes.size()) - 1;
  loop.T_from_to = random_pose(random);
  loop.information = random_covariance<6>(random);
  loop.inliers = 37;
  loop.accepted = true;
  loop.weight = 0.75;
  loop.reason = "37 inliers of 61; \"kept\"";
  map.loops.push_back(loop);
  return map;
}

}  // namespace roadbook::test
