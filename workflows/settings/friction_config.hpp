#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/yaml.hpp"
#include "speedmap/property_map/ground_table.hpp"
#include "speedmap/property_map/property_mapper.hpp"

namespace roadbook {

/// A property of the ground that is measured under the vehicle: the table of its values in a drive,
/// and the prior distribution before the first measurement.
struct MeasuredProperty {
  std::string name;
  std::string unit;          ///< as in the table's header
  std::string table;         ///< path in the drive's folder of streams
  std::string column;        ///< of `table`; a column `sigma` is the sensor's, if `sigma_column`
  std::string sigma_column;  ///< standard deviation of each value; empty: `sensor_sigma` of all
  double sensor_sigma = 0.0;
  Range range;                 ///< plausible values
  std::vector<double> mean;    ///< by class
  std::vector<double> spread;  ///< standard deviation within each class
};

/// The settings of `roadbook friction`: the classes of the ground, their values in class images,
/// and the prior distributions of the ground's properties.
struct FrictionConfig {
  std::vector<std::string> classes = {"asphalt", "paint", "gravel", "wet"};
  /// The values of class images that mean each class. All other values are not ground and are left
  /// out.
  std::vector<std::vector<std::uint8_t>> image_values = {{1}, {2, 3}, {4}, {5}};
  std::vector<double> prior_counts = {5.0, 1.0, 1.0, 1.0};
  std::vector<double> friction_mean = {0.8, 0.7, 0.6, 0.5};
  std::vector<double> friction_sigma = {0.1, 0.1, 0.1, 0.1};  ///< within a class
  std::vector<MeasuredProperty> further;                      ///< in addition to friction
  double spacing_m = 1.0;                                     ///< between knots
  double kernel_width_m = 2.0;                                ///< D
  double range_m = 25.0;  ///< the update ignores pixels farther away than this
  PropertyMapOptions map;
  RefreshOptions refresh;
  double labels_per_m2 = GroundTableOptions{}.labels_per_m2;

  /// Reads the settings from a file. Throws BadInput with file and line for unreadable text and for
  /// values outside their range.
  static FrictionConfig load(const std::filesystem::path& file);
  /// Reads the settings from text. `name` is the file name for messages.
  static FrictionConfig parse(const std::string& text, const std::string& name);
  /// Returns all settings, including defaults, as text that `parse` reads back unchanged.
  [[nodiscard]] std::string text() const;
  /// Throws InvalidOption.
  void check() const;

  /// Returns friction, then the other properties.
  [[nodiscard]] std::vector<MeasuredProperty> properties() const;
  [[nodiscard]] PropertyMapPrior prior() const;
  /// Returns the class of each value of a class image. It is `classes.size()` for a value that is
  /// not ground.
  [[nodiscard]] std::vector<std::uint8_t> class_of_value() const;
};

/// Throws BadInput at the first key of `yaml`'s text whose value in `now` differs from `before`. A
/// map must be extended with the settings with which it was begun.
void refuse_other_rules(const FrictionConfig& now,
                        const FrictionConfig& before,
                        const std::filesystem::path& file);

}  // namespace roadbook
