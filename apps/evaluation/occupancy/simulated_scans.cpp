#include "apps/evaluation/occupancy/simulated_scans.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "drive/drive.hpp"
#include "sim/simulate.hpp"
#include "workflows/localisation/localisation_figures.hpp"
#include "workflows/occupancy/drive_scans.hpp"

namespace roadbook {
namespace {

// Distance along a ray to a segment; infinity if the ray misses it.
double to_segment(const Eigen::Vector2d& o,
                  const Eigen::Vector2d& along,
                  const std::pair<Eigen::Vector2d, Eigen::Vector2d>& segment) {
  const Eigen::Vector2d side = segment.second - segment.first;
  const double cross = along.x() * side.y() - along.y() * side.x();
  if (std::abs(cross) < 1e-12) return INFINITY;
  const Eigen::Vector2d to = segment.first - o;
  const double r = (to.x() * side.y() - to.y() * side.x()) / cross;
  const double s = (to.x() * along.y() - to.y() * along.x()) / cross;
  return r >= 0.0 && s >= 0.0 && s <= 1.0 ? r : INFINITY;
}

double nearest_in_cone(
    const Surfaces& near, const Eigen::Vector2d& o, double azimuth, double cone_rad, double max_m) {
  constexpr int kRays = 17;
  double nearest = max_m;
  for (int i = 0; i < kRays; ++i) {
    const double a = azimuth + cone_rad * (static_cast<double>(i) / (kRays - 1) - 0.5);
    const Eigen::Vector2d along(std::cos(a), std::sin(a));
    for (const auto& segment : near) nearest = std::min(nearest, to_segment(o, along, segment));
  }
  return nearest;
}

}  // namespace

SimulatedScans simulate_scans(const std::filesystem::path& folder,
                              const SimulatedScansOptions& options,
                              const Progress& progress) {
  ScenarioOptions variant;
  variant.size = options.size;
  variant.visit = options.visit;
  const Scenario scenario = load_scenario(options.place, variant);
  SimulateOptions simulation;
  simulation.seed = options.seed;
  simulation.noise = options.noise;
  simulation.effects = options.effects;
  simulation.images = false;
  simulation.ranges = true;
  simulation.num_threads = options.num_threads;
  simulation.overwrite = true;
  simulate(scenario, folder, simulation, progress);
  const Drive drive = Drive::open(folder);
  const auto truth = drive.truth();
  const DriveScans read =
      read_drive_scans(drive, [&](std::int64_t t_ns) { return true_pose_at(truth, t_ns); });
  SimulatedScans result;
  result.scans = read.scans;
  result.max_m = read.model.max_m;
  const World world = make_world(scenario, {}, options.num_threads, progress);
  result.surfaces = surfaces_at_height(world, read.model.T_vehicle_sensor.translation().z());
  result.walked = places_walked(folder);
  return result;
}

std::vector<RangeScan> wide_scans(const SimulatedScans& drive,
                                  double cone_rad,
                                  double max_m,
                                  double sigma_m,
                                  const BeamMixture& shares,
                                  std::uint64_t seed,
                                  int num_threads) {
  constexpr std::uint32_t kSensors = 12;
  RangeModel model;
  model.max_m = max_m;
  model.sigma_m = sigma_m;
  std::vector<RangeScan> wide(drive.scans.size());
  parallel_for(wide.size(), num_threads, [&](std::size_t s) {
    Random random(seed, "wide beams", s);
    const RangeScan& scan = drive.scans[s];
    Surfaces near;
    for (const auto& segment : drive.surfaces) {
      const double reach = max_m + (segment.second - segment.first).norm();
      if ((segment.first - scan.origin).norm() < reach) near.push_back(segment);
    }
    const Eigen::Vector2f ahead = scan.beams[scan.beams.size() / 2].along;
    const double heading = std::atan2(ahead.y(), ahead.x());
    wide[s].t_ns = scan.t_ns;
    wide[s].origin = scan.origin;
    for (std::uint32_t b = 0; b < kSensors; ++b) {
      const double a = heading + 2.0 * std::numbers::pi * b / kSensors;
      const double expected = nearest_in_cone(near, scan.origin, a, cone_rad, max_m);
      const double part = random.uniform(), within = random.uniform();
      const double read = predict_range(model, shares, expected, part, within, random.normal());
      wide[s].beams.push_back({b, Eigen::Vector2d(std::cos(a), std::sin(a)).cast<float>(), read});
    }
  });
  return wide;
}

std::vector<RangeScan> with_failures(const std::vector<RangeScan>& scans,
                                     double max_m,
                                     std::uint64_t seed) {
  Random random(seed, "failing scanner");
  std::vector<RangeScan> failing = scans;
  for (RangeScan& scan : failing) {
    std::erase_if(scan.beams, [](const ScanBeam& b) { return b.beam % 3 == 1; });
    for (ScanBeam& b : scan.beams) {
      const double chance = random.uniform(), within = random.uniform();
      if (chance < 0.20)
        b.read_m = max_m;
      else if (chance < 0.25)
        b.read_m *= within;
    }
  }
  return failing;
}

}  // namespace roadbook
