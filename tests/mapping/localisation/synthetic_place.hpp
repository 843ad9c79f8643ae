#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "base/random.hpp"
#include "mapping/localisation/localiser.hpp"
#include "tests/support/fisheye_rig.hpp"
#include "vo/track_options.hpp"

namespace roadbook::test {

/// A place without images: landmarks around a ring road, a map of it with known errors, and drives
/// through it whose corners and wheels have the stated noise.
struct SyntheticPlace {
  Rig half_rig;
  std::vector<Eigen::Vector3d> points;  ///< true places of the landmarks
  std::vector<Descriptor> descriptors;
  Map map;
};

struct SyntheticPlaceOptions {
  double radius_m = 16.0;
  int point_count = 2500;
  double reach_m = 18.0;   ///< landmarks farther away are not seen
  double sigma_m = 0.01;   ///< of each coordinate of a landmark in the map
  double spacing_m = 0.5;  ///< between the map's poses
};

/// Pose on the ring, `travelled_m` along it, `left_m` to the left of it.
inline Eigen::Isometry3d ring_pose(double radius_m, double travelled_m, double left_m = 0.0) {
  const double a = travelled_m / radius_m;
  return pose_from_planar((radius_m - left_m) * std::sin(a),
                          radius_m - (radius_m - left_m) * std::cos(a), a);
}

inline Descriptor random_descriptor(Random& random) {
  Descriptor d;
  for (auto& byte : d) byte = static_cast<std::uint8_t>(random.below(256));
  return d;
}

inline Descriptor with_flipped_bits(Descriptor d, int bits, Random& random) {
  for (int i = 0; i < bits; ++i) {
    const auto bit = random.below(512);
    d[bit / 8] = static_cast<std::uint8_t>(d[bit / 8] ^ (1U << (bit % 8)));
  }
  return d;
}

/// Pixel of a point in a camera of the rig, if it is seen.
inline std::optional<Eigen::Vector2d> seen_at(const Rig& rig,
                                              std::size_t camera,
                                              const Eigen::Isometry3d& T_world_vehicle,
                                              const Eigen::Vector3d& p_world,
                                              double reach_m) {
  const MountedCamera& mounted = rig.cameras[camera];
  const Eigen::Vector3d p = (T_world_vehicle * mounted.T_vehicle_camera).inverse() * p_world;
  if (p.norm() > reach_m) return std::nullopt;
  const auto pixel = mounted.camera.project(p);
  if (!pixel || !mounted.camera.contains(*pixel, 2.0)) return std::nullopt;
  return pixel;
}

inline SyntheticPlace synthetic_place(std::uint64_t seed,
                                      const SyntheticPlaceOptions& options = {}) {
  Random random(seed, "synthetic place");
  SyntheticPlace place;
  const Rig full = fisheye_rig();
  place.half_rig = half_size(full);
  for (int i = 0; i < options.point_count; ++i) {
    const double a = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double r = options.radius_m + random.uniform(-10.0, 10.0);
    const double z = random.uniform() < 0.3 ? 0.0 : random.uniform(0.2, 3.0);
    place.points.emplace_back(r * std::sin(a), options.radius_m - r * std::cos(a), z);
    place.descriptors.push_back(random_descriptor(random));
  }
  Session session;
  session.name = "visit0";
  session.rig = full;
  place.map.sessions.push_back(session);
  const double round_m = 2.0 * std::numbers::pi * options.radius_m;
  std::vector<int> first_frame(place.points.size(), -1);
  std::vector<Observation> observations;
  for (int k = 0; k * options.spacing_m < round_m; ++k) {
    const Eigen::Isometry3d T = ring_pose(options.radius_m, k * options.spacing_m);
    place.map.map_frames.push_back({T});
    Keyframe keyframe;
    keyframe.map_frame = k;
    keyframe.t_ns = k * 200'000'000LL;
    place.map.keyframes.push_back(keyframe);
    for (std::size_t c = 0; c < full.cameras.size(); ++c)
      for (std::size_t p = 0; p < place.points.size(); ++p) {
        const auto pixel = seen_at(full, c, T, place.points[p], options.reach_m);
        if (!pixel) continue;
        if (first_frame[p] < 0) first_frame[p] = k;
        observations.push_back({static_cast<int>(p), k, static_cast<int>(c), pixel->cast<float>()});
      }
  }
  for (std::size_t p = 0; p < place.points.size(); ++p) {
    Landmark landmark;
    landmark.map_frame = std::max(0, first_frame[p]);
    Eigen::Vector3d off;
    for (int i = 0; i < 3; ++i) off(i) = options.sigma_m * random.normal();
    landmark.p_frame = place.map.map_frames[at(landmark.map_frame)].T_map_frame.inverse() *
                       (place.points[p] + off);
    landmark.covariance = options.sigma_m * options.sigma_m * Eigen::Matrix3d::Identity();
    landmark.descriptor = place.descriptors[p];
    place.map.landmarks.push_back(landmark);
  }
  place.map.observations = std::move(observations);
  return place;
}

struct SyntheticFrameOptions {
  double sigma_px = 0.6;  ///< of a corner, half-size image
  int flipped_bits = 40;  ///< of a descriptor
  int clutter = 60;       ///< corners of each camera that the map does not have
  double reach_m = 18.0;
  double gone_share = 0.0;  ///< of the landmarks that are no longer there
};

/// Corners that the rig sees from a pose. A removed landmark is missing in all frames.
inline std::vector<Features> synthetic_features(const SyntheticPlace& place,
                                                const Eigen::Isometry3d& T_world_vehicle,
                                                Random& random,
                                                const SyntheticFrameOptions& options = {}) {
  std::vector<Features> all(place.half_rig.cameras.size());
  for (std::size_t c = 0; c < all.size(); ++c) {
    const Camera& camera = place.half_rig.cameras[c].camera;
    for (std::size_t p = 0; p < place.points.size(); ++p) {
      if (Random(p, "gone").uniform() < options.gone_share) continue;
      const auto pixel =
          seen_at(place.half_rig, c, T_world_vehicle, place.points[p], options.reach_m);
      if (!pixel || random.uniform() < 0.4) continue;  // a detector misses many
      const Eigen::Vector2d noise(random.normal(), random.normal());
      all[c].pixels.push_back((*pixel + options.sigma_px * noise).cast<float>());
      all[c].descriptors.push_back(
          with_flipped_bits(place.descriptors[p], options.flipped_bits, random));
    }
    for (int i = 0; i < options.clutter; ++i) {
      all[c].pixels.emplace_back(static_cast<float>(random.uniform(0.0, camera.width - 1.0)),
                                 static_cast<float>(random.uniform(0.0, camera.height - 1.0)));
      all[c].descriptors.push_back(random_descriptor(random));
    }
  }
  return all;
}

/// Wheels' motion between two poses with the noise of `WheelModel`; `scale`: error of the radii.
inline PlanarMotion synthetic_wheels(const Eigen::Isometry3d& T_world_a,
                                     const Eigen::Isometry3d& T_world_b,
                                     Random& random,
                                     double scale = 1.0) {
  const WheelModel model;
  const Eigen::Isometry3d T = T_world_a.inverse() * T_world_b;
  PlanarMotion motion;
  motion.distance_m = T.translation().norm();
  const double root = std::sqrt(motion.distance_m);
  const Eigen::Vector3d sigma(model.sigma_distance_per_sqrt_m * root,
                              model.sigma_lateral_per_sqrt_m * root,
                              model.sigma_heading_per_sqrt_m * root);
  motion.covariance = sigma.cwiseAbs2().asDiagonal();
  motion.motion = scale * Eigen::Vector3d(T.translation().x(), T.translation().y(), heading_of(T));
  for (int i = 0; i < 3; ++i) motion.motion(i) += sigma(i) * random.normal();
  motion.reversing = T.translation().x() < 0.0;
  return motion;
}

}  // namespace roadbook::test
