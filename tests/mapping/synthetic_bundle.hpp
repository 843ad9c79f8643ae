#pragma once

#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"
#include "tests/support/fisheye_rig.hpp"

namespace roadbook::test {

/// A bundle problem made from known truth: four fisheyes on a car that drives a closed loop.
struct SyntheticBundle {
  BundleProblem problem;  ///< measurements with noise, start values disturbed
  std::vector<Eigen::Isometry3d> poses;
  std::vector<Eigen::Vector3d> points;
};

struct SyntheticOptions {
  double length_m = 200.0;
  double spacing_m = 1.0;
  int point_count = 3000;
  double reach_m = 15.0;  ///< landmarks farther away are not seen
  double sigma_px = 0.5;
  double wheel_error = 0.0;  ///< relative error of measured distances, with a free scale
  double start_sigma_m = 0.05;
  double start_sigma_rad = 0.005;
  double ground_share = 0.3;  ///< of landmarks on the ground z = 0
  double laps = 1.0;
};

/// Least squares of all observations, on one thread.
inline BundleOptions exact_options() {
  BundleOptions options;
  options.loss = RobustLoss::kNone;
  options.outlier_rounds = 0;
  options.num_threads = 1;
  return options;
}

inline Eigen::Isometry3d small_motion(double m, double rad, Random& random) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi(i) = (i < 3 ? m : rad) * random.normal();
  return se3_exp(xi);
}

inline SyntheticBundle synthetic_bundle(const SyntheticOptions& options, std::uint64_t seed) {
  Random random(seed, "synthetic bundle");
  SyntheticBundle s;
  s.problem.cameras = fisheye_rig().cameras;
  const double radius = options.length_m / (2.0 * std::numbers::pi);
  const auto count = static_cast<std::size_t>(options.laps * options.length_m / options.spacing_m);
  for (std::size_t i = 0; i < count; ++i) {
    const double a = static_cast<double>(i) * options.spacing_m / radius;
    s.poses.push_back(pose_from_planar(radius * std::sin(a), radius * (1.0 - std::cos(a)), a));
  }
  for (int p = 0; p < options.point_count; ++p) {
    const double a = random.uniform(0.0, 2.0 * std::numbers::pi);
    const double r = radius + random.uniform(-8.0, 8.0);
    const bool ground = random.uniform() < options.ground_share;
    s.points.emplace_back(r * std::sin(a), radius - r * std::cos(a),
                          ground ? 0.0 : random.uniform(0.2, 3.0));
    BundlePoint point;
    point.ground = ground;
    s.problem.points.push_back(point);
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t p = 0; p < s.points.size(); ++p) {
      const double distance = (s.points[p] - s.poses[i].translation()).norm();
      if (distance > options.reach_m || distance < 1.5) continue;
      for (std::size_t c = 0; c < 4; ++c) {
        const MountedCamera& m = s.problem.cameras[c];
        const Eigen::Vector3d p_camera = (s.poses[i] * m.T_vehicle_camera).inverse() * s.points[p];
        const auto pixel = m.camera.project(p_camera);
        if (!pixel || !m.camera.contains(*pixel) || p_camera.z() < 0.05 * p_camera.norm()) continue;
        BundleObservation o{static_cast<int>(i), static_cast<int>(p), static_cast<int>(c), *pixel,
                            options.sigma_px};
        o.pixel += options.sigma_px * Eigen::Vector2d(random.normal(), random.normal());
        s.problem.observations.push_back(o);
        if (s.problem.points[p].ground && s.problem.points[p].ground_pose < 0)
          s.problem.points[p].ground_pose = static_cast<int>(i);
      }
    }
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Constant(0.003);
  const Matrix6d information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  if (options.wheel_error != 0.0) s.problem.scales.push_back({1.0, 1.0, 0.05, false});
  for (std::size_t i = 0; i + 1 < count; ++i) {
    MotionConstraint m;
    m.from = static_cast<int>(i);
    m.to = static_cast<int>(i) + 1;
    m.T_from_to = s.poses[i].inverse() * s.poses[i + 1] * small_motion(0.01, 0.003, random);
    m.T_from_to.translation() /= 1.0 + options.wheel_error;
    m.information = information;
    m.scale = s.problem.scales.empty() ? -1 : 0;
    s.problem.motions.push_back(m);
  }
  for (std::size_t i = 0; i < count; ++i)
    s.problem.poses.push_back(
        {i == 0 ? s.poses[i]
                : s.poses[i] * small_motion(options.start_sigma_m, options.start_sigma_rad, random),
         false});
  for (std::size_t p = 0; p < s.points.size(); ++p)
    s.problem.points[p].p_map =
        s.points[p] + 0.1 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  return s;
}

}  // namespace roadbook::test
