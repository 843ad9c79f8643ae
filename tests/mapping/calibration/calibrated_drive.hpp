#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "mapping/calibration/calibrate.hpp"
#include "sensors/camera_effects.hpp"
#include "sensors/wheel_imperfections.hpp"
#include "tests/support/fisheye_rig.hpp"

namespace roadbook::test {

/// How a car drives that records without images.
struct CalibrationDriveOptions {
  double seconds = 30.0;
  double speed = 2.2;         ///< mean [m/s]
  double speed_change = 1.2;  ///< amplitude [m/s]
  double curvature = 0.17;    ///< amplitude [1/m], to both sides in turn
  int points_per_metre = 7;   ///< around the way
  double sigma_px = 0.5;      ///< of a corner
  double wrong_share = 0.01;  ///< of corners, anywhere within 20 px
};

/// A drive of four fisheyes and wheels with hidden errors, and what is known of it.
struct CalibrationDrive {
  CalibrationData data;  ///< poses and points disturbed; sensors as stated
  EffectSizes hidden;
  std::vector<Eigen::Isometry3d> poses;  ///< true, at the stamps
  std::vector<Eigen::Vector3d> points;   ///< true, of data.points
};

/// Motion of the car at time t: distance and heading follow by sums over milliseconds.
inline std::vector<Eigen::Isometry3d> driven_poses(const CalibrationDriveOptions& o) {
  std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
  for (int ms = 0; ms < static_cast<int>(1e3 * o.seconds); ++ms) {
    const double t = 1e-3 * ms;
    const double step = 1e-3 * (o.speed + o.speed_change * std::sin(1.1 * t));
    const double turn = step * o.curvature * std::sin(0.5 * t);
    poses.push_back(poses.back() * pose_from_planar(step, 0.0, turn));
  }
  return poses;
}

/// Readings every 20 ms, as the simulator makes them: slip and turn have the stated scatter.
inline std::vector<WheelReading> driven_readings(const std::vector<Eigen::Isometry3d>& poses,
                                                 const WheelModel& stated,
                                                 const EffectSizes& hidden,
                                                 Random& random) {
  const auto off = wheel_imperfections(hidden);
  std::vector<WheelReading> readings;
  double left = 0.0;
  double right = 0.0;
  for (std::size_t ms = 0; ms + 20 < poses.size(); ms += 20) {
    WheelReading reading;
    reading.t_ns = static_cast<std::int64_t>(1e6 * static_cast<double>(ms) + 1e9 * off.latency);
    reading.left_angle_rad = left + stated.sigma_angle_rad * random.normal();
    reading.right_angle_rad = right + stated.sigma_angle_rad * random.normal();
    readings.push_back(reading);
    const Eigen::Isometry3d moved = poses[ms].inverse() * poses[ms + 20];
    TrueMotion<double> motion;
    const double way = moved.translation().norm();
    motion.distance_m = way + stated.sigma_distance_per_sqrt_m * std::sqrt(way) * random.normal();
    motion.turn_rad =
        heading_of(moved) + stated.sigma_heading_per_sqrt_m * std::sqrt(way) * random.normal();
    const Eigen::Vector2d turned = predict_wheel_turns(stated, off, motion);
    left += turned.x();
    right += turned.y();
  }
  return readings;
}

inline CalibrationDrive calibration_drive(const EffectSizes& hidden,
                                          std::uint64_t seed,
                                          const CalibrationDriveOptions& o = {}) {
  constexpr std::size_t kMsPerPose = 160;
  Random random(seed, "calibration drive");
  CalibrationDrive drive;
  drive.hidden = hidden;
  const auto way = driven_poses(o);
  drive.data.rig = fisheye_rig();
  Rig real = drive.data.rig;
  for (MountedCamera& camera : real.cameras) camera = apply_camera_effects(camera, hidden);
  double travelled = 0.0;
  for (std::size_t ms = 500; ms + 500 < way.size(); ms += kMsPerPose) {
    CalibrationPose pose;
    pose.t_ns = static_cast<std::int64_t>(ms) * 1'000'000;
    pose.joined = !drive.poses.empty();
    pose.fixed = drive.poses.empty();
    drive.poses.push_back(way[ms]);
    if (pose.joined)
      travelled += (drive.poses[drive.poses.size() - 2].inverse() * way[ms]).translation().norm();
    pose.stretch = static_cast<int>(travelled / 2.0);
    pose.T_map_vehicle = way[ms];
    drive.data.poses.push_back(pose);
  }
  const auto count = static_cast<std::size_t>(o.points_per_metre * travelled);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Isometry3d& at_pose = drive.poses[random.below(drive.poses.size())];
    const bool ground = random.uniform() < 0.25;
    const double beside = ground ? random.uniform(-1.6, 1.6) : random.uniform(2.0, 9.0);
    const double side = random.below(2) == 0 ? 1.0 : -1.0;
    const Eigen::Vector3d p =
        at_pose * Eigen::Vector3d(random.uniform(-1.0, 1.0), side * beside,
                                  ground ? 0.01 * random.normal() : random.uniform(0.1, 3.0));
    for (std::size_t c = 0; c < real.cameras.size(); ++c) {
      const MountedCamera& camera = real.cameras[c];
      const double late = effect_size(hidden, camera.name, "latency");
      std::vector<BundleObservation> views;
      for (std::size_t k = 0; k < drive.poses.size(); ++k) {
        const auto ms = static_cast<std::size_t>(
            std::llround(1e-6 * static_cast<double>(drive.data.poses[k].t_ns) - 1e3 * late));
        const Eigen::Vector3d q = (way[ms] * camera.T_vehicle_camera).inverse() * p;
        if (q.norm() > 9.0 || q.norm() < 0.8 || q.z() < 0.05 * q.norm()) continue;
        const auto pixel = camera.camera.project(q);
        if (!pixel || !camera.camera.contains(*pixel, 2.0)) continue;
        const bool wrong = random.uniform() < o.wrong_share;
        const auto noise = [&] {
          return wrong ? random.uniform(-20.0, 20.0) : random.normal(0.0, o.sigma_px);
        };
        views.push_back({static_cast<int>(k), static_cast<int>(drive.points.size()),
                         static_cast<int>(c), *pixel + Eigen::Vector2d(noise(), noise()), 1.2});
      }
      if (views.size() < 4) continue;
      const std::size_t kept = std::min<std::size_t>(views.size(), 8);
      for (std::size_t v = 0; v < kept; ++v)
        drive.data.views.push_back(views[v * views.size() / kept]);
      if (ground) {
        std::size_t nearest = 0;
        for (std::size_t k = 0; k < drive.poses.size(); ++k)
          if ((drive.poses[k].translation() - p).norm() <
              (drive.poses[nearest].translation() - p).norm())
            nearest = k;
        drive.data.grounds.push_back(
            {static_cast<int>(nearest), static_cast<int>(drive.points.size())});
      }
      drive.points.push_back(p);
      drive.data.points.push_back(
          p + 0.05 * Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
    }
  }
  WheelModel stated;
  stated.radius_left_m = stated.radius_right_m = 0.31;
  const auto readings = driven_readings(way, stated, hidden, random);
  for (std::size_t k = 1; k < drive.poses.size(); ++k) {
    CalibrationMotion motion{static_cast<int>(k) - 1, static_cast<int>(k), stated, {}};
    for (const WheelReading& reading : readings)
      if (std::abs(reading.t_ns - drive.data.poses[k].t_ns) < 600'000'000)
        motion.readings.push_back(reading);
    drive.data.motions.push_back(motion);
  }
  // The map's poses follow the odometry: they drift a little.
  Eigen::Isometry3d drift = Eigen::Isometry3d::Identity();
  for (CalibrationPose& pose : drive.data.poses) {
    pose.T_map_vehicle = drift * pose.T_map_vehicle;
    drift = drift * pose_from_planar(random.normal(0.0, 0.002), random.normal(0.0, 0.002),
                                     random.normal(0.0, 0.0005));
  }
  set_twists(drive.data.poses);
  return drive;
}

}  // namespace roadbook::test
