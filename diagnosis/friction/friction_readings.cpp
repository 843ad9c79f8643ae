#include "diagnosis/friction/friction_readings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/friction/inferred_surfaces.hpp"
#include "diagnosis/streams/pose_motion.hpp"
#include "sensors/friction.hpp"

namespace roadbook {

namespace {

void infer_surfaces(FrictionReadings& readings) {
  const std::vector<int> surfaces = inferred_surfaces(readings.samples);
  int groups = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    readings.samples[i].surface = kInferredSurface + surfaces[i];
    groups = std::max(groups, surfaces[i] + 1);
  }
  readings.notes.push_back(
      "friction0: no column `surface`; the surfaces were inferred from the friction of each "
      "place: " +
      std::to_string(groups) + (groups == 1 ? " surface" : " surfaces") +
      "; friction0.extra_class, friction0.spatial_bias and friction0.drying are not diagnosed");
}

// [m] distance driven, from the speeds
double driven(const std::vector<FrictionSample>& samples) {
  constexpr double kGap = 2.0;  // [s]
  double sum = 0.0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    sum += std::abs(samples[i].speed) * std::min(samples[i].t_s - samples[i - 1].t_s, kGap);
  return sum;
}

}  // namespace

FrictionReadings friction_readings(const std::vector<PoseSample>& poses,
                                   const std::vector<RawFriction>& raw) {
  FrictionReadings readings;
  if (raw.empty()) return readings;
  const auto labelled = [](const RawFriction& r) { return r.surface.has_value(); };
  readings.has_surface = std::all_of(raw.begin(), raw.end(), labelled);
  readings.has_temperature = std::all_of(
      raw.begin(), raw.end(), [](const RawFriction& r) { return r.temperature_c.has_value(); });
  PoseSmoother smoother(poses, half_window_of(poses));
  PoseSmoother wider(poses);  // fallback in gaps of the poses
  for (const RawFriction& r : raw) {
    auto motion = smoother.at(r.t_s);
    if (!motion) motion = wider.at(r.t_s);
    if (!motion) continue;
    readings.samples.push_back({r.t_s, r.friction, r.sigma, readings.has_surface ? *r.surface : 0,
                                readings.has_temperature ? *r.temperature_c : kFrictionReference,
                                motion->x, motion->y, motion->heading, motion->speed,
                                motion->acceleration, motion->lateral_acceleration,
                                motion->yaw_rate});
  }
  constexpr double kLeastWay = 10.0;  // [m]
  const double way = driven(readings.samples);
  if (const std::size_t lost = raw.size() - readings.samples.size(); lost > 0)
    readings.notes.push_back("friction0: " + std::to_string(lost) + " of " +
                             std::to_string(raw.size()) +
                             " readings left out: no reference pose at their time");
  if (readings.samples.size() < 100) {
    readings.notes.push_back("friction0 not diagnosed: " + std::to_string(readings.samples.size()) +
                             " readings with a reference pose, want at least 100");
    readings.samples.clear();
  } else if (way < kLeastWay) {
    char text[120];
    std::snprintf(text, sizeof text,
                  "friction0 not diagnosed: the car drove %.1f m, want at least %.0f m", way,
                  kLeastWay);
    readings.notes.emplace_back(text);
    readings.samples.clear();
  } else if (!readings.has_surface) {
    infer_surfaces(readings);
  }
  return readings;
}

FrictionReadings friction_readings(const Drive& drive,
                                   const std::vector<PoseSample>& poses,
                                   double late_s) {
  std::vector<RawFriction> raw;
  const auto truth = drive.truth();
  if (truth.empty()) return {};
  const std::int64_t origin = truth.front().t_ns;
  drive.for_each_friction_reading([&](const FrictionReading& r) {
    raw.push_back({1e-9 * static_cast<double>(r.t_ns - origin) + late_s, r.friction, r.sigma,
                   r.surface, r.temperature_c});
  });
  return friction_readings(poses, raw);
}

}  // namespace roadbook
