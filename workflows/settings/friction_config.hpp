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
  std::string unit;          ///< as the table's header has it
  std::string table;         ///< in the drive's folder of streams
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
  /// Values of class images that mean each class; all others are no ground and left out.
  std::vector<std::vector<std::uint8_t>> image_values = {{1}, {2, 3}, {4}, {5}};
  std::vector<double> prior_counts = {5.0, 1.0, 1.0, 1.0};
  std::vector<double> friction_mean = {0.8, 0.7, 0.6, 0.5};
  std::vector<double> friction_sigma = {0.1, 0.1, 0.1, 0.1};  ///< within a class
  std::vector<MeasuredProperty> further;                      ///< in addition to friction
  double spacing_m = 1.0;                                     ///< of the knots
  double kernel_width_m = 2.0;                                ///< D
  double range_m = 25.0;  ///< pixels farther away than this are not used
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

  /// Friction, then the further ones.
  [[nodiscard]] std::vector<MeasuredProperty> properties() const;
  [[nodiscard]] PropertyMapPrior prior() const;
  /// Class of every value of a class image; `classes.size()` where it is no ground.
  [[nodiscard]] std::vector<std::uint8_t> class_of_value() const;
};

/// Throws BadInput at the first key of `yaml`'s text whose value `now` is not that of `before`: a
/// map is not extended by other rules than it was begun with.
void refuse_other_rules(const FrictionConfig& now,
                        const FrictionConfig& before,
                        const std::filesystem::path& file);

}  // namespace roadbook
