#include "diagnosis/range/range_readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/streams/pose_motion.hpp"

namespace roadbook {
namespace {

// The surface is the line normal * (p - q) = 0; the beam meets it at origin + range * along.
Eigen::Vector3d by_pose(const RangeBeam& beam, const ExpectedSurface& met) {
  const Eigen::Vector2d turned(-beam.along.y(), beam.along.x());
  Eigen::Vector3d change;
  change << met.normal, met.range_m * met.normal.dot(turned);
  return -change / met.normal.dot(beam.along);
}

}  // namespace

RangeReadings expect_ranges(const std::vector<RangeBeam>& beams, double max_m) {
  RangeReadings readings;
  readings.max_m = max_m;
  readings.beams = {beams};
  const RangeMap map(beams, max_m);
  for (const RangeBeam& b : beams) {
    if (const auto met = map.surface(b))
      readings.samples.push_back({b.t_s, b.beam, std::min(b.range_m, max_m), met->range_m, b.speed,
                                  b.yaw_rate, by_pose(b, *met)});
    else
      ++readings.left_out;
  }
  double longest = 0.0;
  std::size_t beyond = 0;
  for (const RangeBeam& b : beams) {
    longest = std::max(longest, b.range_m);
    beyond += b.range_m > 1.001 * max_m;
  }
  if (beyond > 0) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "contradictory calibration: range0 reads up to %.5g m; %zu readings exceed its "
                  "stated maximum range of %.5g m",
                  longest, beyond, max_m);
    readings.notes.emplace_back(text);
  }
  if (readings.samples.size() < 500) {
    readings.notes.push_back("range0 not diagnosed: " + std::to_string(readings.samples.size()) +
                             " beams hit a surface that other beams hit too, want at least 500");
    readings.samples.clear();
  }
  return readings;
}

RangeReadings range_readings(const Drive& drive,
                             const std::vector<PoseSample>& poses,
                             double late_s) {
  RangeReadings none;
  const auto truth = drive.truth();
  if (truth.empty()) return none;
  bool any = false;
  const std::int64_t origin = truth.front().t_ns;
  const auto& model = drive.range_model();
  std::vector<RangeBeam> beams;
  PoseSmoother smoother(poses, 0.35);
  std::size_t at = 0;  // index of the reference pose nearest in time
  drive.for_each_range_reading([&](const RangeReading& r) {
    any = true;
    if (!model || static_cast<std::size_t>(r.beam) >= model->azimuth_rad.size()) return;
    const double t = 1e-9 * static_cast<double>(r.t_ns - origin) + model->time_offset_s + late_s;
    const auto pose = smoother.at(t);
    if (!pose) return;
    const double c = std::cos(pose->heading);
    const double s = std::sin(pose->heading);
    const double azimuth = model->azimuth_rad[static_cast<std::size_t>(r.beam)];
    const Eigen::Vector3d direction = model->T_vehicle_sensor.linear() *
                                      Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Eigen::Vector3d mount = model->T_vehicle_sensor.translation();
    const auto stamp = r.t_ns + std::llround(1e9 * (model->time_offset_s + late_s));
    if (truth[at].t_ns > stamp) at = 0;
    while (at + 1 < truth.size() && truth[at + 1].t_ns - stamp <= stamp - truth[at].t_ns) ++at;
    const Eigen::Isometry3d& T = truth[at].T_world_vehicle;
    const Eigen::Vector3d level = T.linear() * direction;
    RangeBeam beam;
    beam.t_s = t;
    beam.height_m = (T * mount).z();
    beam.climb = level.z() / std::max(level.head<2>().norm(), 1e-9);
    beam.beam = static_cast<std::size_t>(r.beam);
    beam.origin = {pose->x + c * mount.x() - s * mount.y(),
                   pose->y + s * mount.x() + c * mount.y()};
    beam.along = Eigen::Vector2d(c * direction.x() - s * direction.y(),
                                 s * direction.x() + c * direction.y())
                     .normalized();
    beam.range_m = r.range_m;
    beam.speed = pose->speed;
    beam.yaw_rate = pose->yaw_rate;
    beams.push_back(beam);
  });
  if (any && !model)
    none.notes.emplace_back("range0 not diagnosed: its sensor.yaml has no `beam_azimuths`");
  return beams.empty() ? none : expect_ranges(beams, model->max_m);
}

}  // namespace roadbook
