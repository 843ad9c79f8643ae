#include "sim/streams/detector_stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/random.hpp"
#include "sim/render/ray_scene.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kSectors = 72;  // of a look, as `roadbook detect` has them
constexpr double kPersonM = 1.7;
constexpr double kBodyM = 0.9;  // height at which things hide people

// Computes which part of the place the cameras of a vehicle see from one pose.
class Sight {
 public:
  Sight(const RayScene& place,
        const Rig& rig,
        const Eigen::Isometry3d& T_world_vehicle,
        const DetectorModel& model)
      : rig_(rig), model_(model) {
    for (const MountedCamera& camera : rig.cameras)
      free_.push_back(cast(place, camera, T_world_vehicle));
  }

  /// The nearest camera that sees a person with the feet at `foot`, vehicle frame.
  [[nodiscard]] std::optional<std::size_t> camera(const Eigen::Vector3d& foot,
                                                  double height_m) const {
    std::optional<std::size_t> best;
    double nearest = model_.max_range_m;
    for (std::size_t c = 0; c < rig_.cameras.size(); ++c) {
      const Eigen::Vector3d eye = rig_.cameras[c].T_vehicle_camera.translation();
      const Eigen::Vector2d to = (foot - eye).head<2>();
      const double range = to.norm();
      if (range < model_.min_range_m || range > nearest || range > free_m(c, to)) continue;
      if (!in_image(c, foot) || !in_image(c, foot + height_m * Eigen::Vector3d::UnitZ())) continue;
      best = c;
      nearest = range;
    }
    return best;
  }

  /// How far the ground is seen from the vehicle's origin, by sector [m]; objects too near the own
  /// car are ignored.
  [[nodiscard]] double reach_m(std::size_t sector) const {
    const double angle = azimuth(sector);
    const Eigen::Vector3d along(std::cos(angle), std::sin(angle), 0.0);
    constexpr double kStep = 0.25;
    double reach = 0.0;
    for (double r = kStep; r < model_.max_range_m + 5.0; r += kStep) {
      if (too_near(r * along)) continue;
      const bool seen = camera(r * along, kPersonM).has_value();
      if (seen) reach = r;
      if (!seen && reach > 0.0) break;
    }
    return reach;
  }

  static double azimuth(std::size_t sector) {
    return 2.0 * std::numbers::pi * (static_cast<double>(sector) + 0.5) /
           static_cast<double>(kSectors);
  }

 private:
  // Horizontal distance to the nearest object, by azimuth about the camera.
  [[nodiscard]] std::array<double, kSectors> cast(const RayScene& place,
                                                  const MountedCamera& camera,
                                                  const Eigen::Isometry3d& T_world_vehicle) const {
    Eigen::Vector3d from = camera.T_vehicle_camera.translation();
    from.z() = kBodyM;
    const Eigen::Vector3f origin = (T_world_vehicle * from).cast<float>();
    RayBatch rays;
    rays.count = kSectors;
    rays.origin = {origin.x(), origin.y(), origin.z()};
    for (std::size_t k = 0; k < kSectors; ++k) {
      const Eigen::Vector3d along(std::cos(azimuth(k)), std::sin(azimuth(k)), 0.0);
      rays.set_direction(k, (T_world_vehicle.linear() * along).cast<float>());
    }
    rays.clear_ends();
    place.intersect(rays);
    std::array<double, kSectors> free{};
    for (std::size_t k = 0; k < kSectors; ++k)
      free[k] = rays.triangle[k] != nullptr ? static_cast<double>(rays.range_m[k]) : 1e9;
    return free;
  }

  [[nodiscard]] double free_m(std::size_t camera, const Eigen::Vector2d& to) const {
    const double turn = std::atan2(to.y(), to.x()) / (2.0 * std::numbers::pi);
    const auto sector = static_cast<std::size_t>((turn - std::floor(turn)) * kSectors);
    return free_[camera][std::min(sector, kSectors - 1)];
  }

  [[nodiscard]] bool too_near(const Eigen::Vector3d& foot) const {
    return std::any_of(rig_.cameras.begin(), rig_.cameras.end(), [&](const MountedCamera& c) {
      return (foot - c.T_vehicle_camera.translation()).head<2>().norm() < model_.min_range_m;
    });
  }

  [[nodiscard]] bool in_image(std::size_t c, const Eigen::Vector3d& p_vehicle) const {
    const MountedCamera& mounted = rig_.cameras[c];
    const auto pixel = mounted.camera.project(mounted.T_vehicle_camera.inverse() * p_vehicle);
    return pixel && mounted.camera.contains(*pixel);
  }

  const Rig& rig_;
  const DetectorModel& model_;
  std::vector<std::array<double, kSectors>> free_;
};

double logit(double p) { return std::log(p / (1.0 - p)); }

// Detection of a person at `foot` (vehicle frame) from `eye`, with the noise of the feet.
Detection found_at(const DetectorModel& model,
                   const Eigen::Vector2d& eye,
                   const Eigen::Vector2d& foot,
                   double noise,
                   Random& random) {
  const Eigen::Vector2d to = foot - eye;
  const Eigen::Vector2d along = to.normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  const double sigma_along = std::hypot(model.sigma_along * to.norm(), model.sigma_least_m);
  const Eigen::Vector2d read = foot + noise * sigma_along * random.normal() * along +
                               noise * model.sigma_across_m * random.normal() * across;
  const Eigen::Matrix2d C =
      sigma_along * sigma_along * along * along.transpose() +
      model.sigma_across_m * model.sigma_across_m * across * across.transpose();
  Detection d;
  d.x_m = read.x();
  d.y_m = read.y();
  d.sigma_m = std::sqrt(0.5 * C.trace());
  d.covariance = {C(0, 0), C(0, 1), C(1, 1)};
  return d;
}

// How many false alarms a look has: Poisson.
int count_of(double mean, Random& random) {
  int count = 0;
  for (double left = std::exp(-mean), u = random.uniform(); u > left; u *= random.uniform())
    ++count;
  return count;
}

}  // namespace

SimulatedDetections simulate_detections(const World& world,
                                        const VehicleMotion& drive,
                                        const Pedestrians& people,
                                        const Rig& rig,
                                        const DetectorModel& model,
                                        std::int64_t start_ns,
                                        double end_s,
                                        const StreamOptions& options) {
  const auto off = detector_imperfections(options.effects);
  const double recall = options.noise ? model.recall : 1.0 - 1e-6;
  RayScene place;
  place.set(world.mesh.triangles, true);
  SimulatedDetections made;
  for (std::uint64_t k = 0; model.every_s * static_cast<double>(k) <= end_s; ++k) {
    // A separate random stream for each look: the people in sight do not change later looks.
    Random random(options.seed, "detector", k);
    const double t = model.every_s * static_cast<double>(k);
    const std::int64_t t_ns = start_ns + std::llround(1e9 * t);
    const Eigen::Isometry3d T = drive.T_world_vehicle(t);
    const Sight sight(place, rig, T, model);
    Look look{t_ns, {}};
    for (std::size_t s = 0; s < kSectors; ++s)
      look.reach_dm.push_back(static_cast<std::uint8_t>(std::lround(10.0 * sight.reach_m(s))));
    const auto add = [&](const Eigen::Vector3d& foot, std::size_t camera, double probability) {
      const Eigen::Vector2d eye = rig.cameras[camera].T_vehicle_camera.translation().head<2>();
      Detection d = found_at(model, eye, predict_foot(off, eye, foot.head<2>()),
                             options.noise ? 1.0 : 0.0, random);
      d.t_ns = t_ns;
      d.probability = probability;
      d.eye_m = {eye.x(), eye.y()};
      made.detections.push_back(d);
    };
    for (std::size_t i = 0; i < people.count(); ++i) {
      const PersonState s = people.at(i, t);
      const Eigen::Vector3d foot =
          T.inverse() * Eigen::Vector3d(s.x, s.y, world.ground.height(s.x, s.y));
      const auto camera = sight.camera(foot, people.height_m(i));
      const double u = random.uniform();
      if (!camera) continue;
      const double range =
          (foot - rig.cameras[*camera].T_vehicle_camera.translation()).head<2>().norm();
      if (logit(std::max(u, 1e-12)) < predict_found(off, logit(recall), range))
        add(foot, *camera, random.uniform(0.6, 1.0));
    }
    for (int n = options.noise ? count_of(model.false_alarms_a_look, random) : 0; n > 0; --n) {
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double range = model.max_range_m * std::sqrt(random.uniform());
      const Eigen::Vector3d foot(range * std::cos(angle), range * std::sin(angle), 0.0);
      if (const auto camera = sight.camera(foot, kPersonM))
        add(foot, *camera, random.uniform(0.5, 0.8));
    }
    made.looks.push_back(std::move(look));
  }
  return made;
}

}  // namespace roadbook
