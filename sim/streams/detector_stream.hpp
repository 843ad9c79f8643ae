#pragma once

#include <cstdint>
#include <vector>

#include "drive/detections.hpp"
#include "sensors/detector.hpp"
#include "sensors/rig.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/moving.hpp"

namespace roadbook {

/// What a detector of people would say of a drive, without images: tables as `roadbook detect`
/// makes them, imperfections "detector.X" included.
struct SimulatedDetections {
  std::vector<Detection> detections;  ///< by time
  std::vector<Look> looks;
};

/// Somebody is in sight of a camera whose image has their feet and crown and before whom nothing of
/// the place stands (other people hide nobody). Of several cameras the nearest sees them. False
/// alarms lie anywhere in sight. Without noise nobody is missed, feet are exact and there are no
/// false alarms, but for the effects.
[[nodiscard]] SimulatedDetections simulate_detections(const World& world,
                                                      const VehicleMotion& drive,
                                                      const Pedestrians& people,
                                                      const Rig& rig,
                                                      const DetectorModel& model,
                                                      std::int64_t start_ns,
                                                      double end_s,
                                                      const StreamOptions& options);

}  // namespace roadbook
