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

/// Where the table of a property stands in a drive.
[[nodiscard]] std::filesystem::path property_file(const std::filesystem::path& drive,
                                                  const MeasuredProperty& property);

/// All measurements of `properties` in a drive, by time; a sensor.yaml beside a table tells what to
/// add to its stamps (`time_offset`). A table that is not there has none. Throws
/// BadInput with every fault of the tables, values outside the property's plausible range among
/// them.
[[nodiscard]] std::vector<PropertyReading> read_properties(
    const std::filesystem::path& drive, const std::vector<MeasuredProperty>& properties);

}  // namespace roadbook
