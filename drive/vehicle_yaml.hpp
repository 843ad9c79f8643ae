#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drive/problem_list.hpp"
#include "sensors/rig.hpp"
#include "sensors/vehicle.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// vehicle.yaml: the measures of the vehicle that a drive was recorded with
// (docs/reference/drive_format.md).

/// Name of the file in the folder of the sensors.
inline constexpr const char* kVehicleFile = "vehicle.yaml";

/// Reads the file and adds every fault to `problems`: unknown and doubled keys, values outside
/// their bounds, measures that contradict each other. Empty where there was an error. A key that is
/// absent or null leaves its measure unknown.
[[nodiscard]] std::optional<VehicleMeasures> read_vehicle_yaml(const std::filesystem::path& file,
                                                               ProblemList& problems);

/// The same for a file given by the user. Throws BadInput with all faults, also if the measures do
/// not suffice for a body.
[[nodiscard]] VehicleMeasures load_vehicle(const std::filesystem::path& file);

/// Text that `read_vehicle_yaml` reads back to the same bits; unknown measures are left out.
[[nodiscard]] std::string vehicle_yaml_text(const VehicleMeasures& vehicle);

/// Warns of valid but unlikely content: measures that give no body, a camera far outside the body,
/// an axle that differs from the wheels' sensor.yaml. `sensors`: the folder of the cameras'
/// folders.
void warn_of_vehicle(const std::filesystem::path& file,
                     const std::filesystem::path& sensors,
                     const VehicleMeasures& vehicle,
                     const Rig& rig,
                     const std::optional<WheelModel>& wheels,
                     ProblemList& problems);

/// The same of measures that the user gives (--vehicle) for a recorded drive. Empty where the drive
/// cannot be read, which opening it reports.
[[nodiscard]] std::vector<Problem> doubts_of_given_vehicle(const std::filesystem::path& file,
                                                           const VehicleMeasures& vehicle,
                                                           const std::filesystem::path& drive);

}  // namespace roadbook
