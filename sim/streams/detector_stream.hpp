#pragma once

#include <cstdint>
#include <vector>

#include "drive/detections.hpp"
#include "sensors/detector.hpp"
#include "sensors/rig.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/moving.hpp"

namespace roadbook {

/// Simulated results of a people detector, without images: tables as `roadbook detect` makes them,
/// imperfections "detector.X" included.
struct SimulatedDetections {
  std::vector<Detection> detections;  ///< by time
  std::vector<Look> looks;
};

/// A person is in sight of a camera if its image shows the feet and the crown, and no part of the
/// place hides the person (other people do not hide anyone). Among several such cameras the nearest
/// one sees the person. False alarms lie anywhere in sight. Without noise no person is missed, feet
/// are exact and there are no false alarms, except for the effects.
[[nodiscard]] SimulatedDetections simulate_detections(const World& world,
                                                      const VehicleMotion& drive,
                                                      const Pedestrians& people,
                                                      const Rig& rig,
                                                      const DetectorModel& model,
                                                      std::int64_t start_ns,
                                                      double end_s,
                                                      const StreamOptions& options);

}  // namespace roadbook
