#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "workflows/settings/friction_config.hpp"

namespace roadbook {

/// One measurement of a property of the ground under the vehicle.
struct PropertyReading {
  std::int64_t t_ns = 0;
  std::size_t property = 0;
  double value = 0.0;
  double sigma = 0.0;  ///< of the sensor
};

/// Returns the path of a property's table in a drive.
[[nodiscard]] std::filesystem::path property_file(const std::filesystem::path& drive,
                                                  const MeasuredProperty& property);

/// Reads all measurements of `properties` in a drive, ordered by time. A file sensor.yaml next to a
/// table gives the `time_offset` to add to its stamps. A missing table has no measurements. Throws
/// BadInput with all errors of the tables, including values outside the plausible range of the
/// property.
[[nodiscard]] std::vector<PropertyReading> read_properties(
    const std::filesystem::path& drive, const std::vector<MeasuredProperty>& properties);

}  // namespace roadbook
