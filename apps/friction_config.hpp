#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "speedmap/ground_table.hpp"
#include "speedmap/property_mapper.hpp"

namespace roadbook {

/// What `roadbook friction` needs to know beside the drive: the ground's classes, how class images
/// name them, and what is believed of their friction before the first measurement.
struct FrictionConfig {
  std::vector<std::string> classes = {"asphalt", "paint", "gravel", "wet"};
  /// Values of class images that mean each class; all others are no ground and left out.
  std::vector<std::vector<std::uint8_t>> image_values = {{1}, {2, 3}, {4}, {5}};
  std::vector<double> prior_counts = {5.0, 1.0, 1.0, 1.0};
  std::vector<double> friction_mean = {0.8, 0.7, 0.6, 0.5};
  std::vector<double> friction_sigma = {0.1, 0.1, 0.1, 0.1};  ///< within a class
  double spacing_m = 1.0;                                     ///< of the knots
  double kernel_width_m = 2.0;                                ///< D
  double range_m = 25.0;  ///< pixels farther away than this are not used
  PropertyMapOptions map;
  RefreshOptions refresh;
  double labels_per_m2 = GroundTableOptions{}.labels_per_m2;

  /// Throws BadInput.
  static FrictionConfig load(const std::filesystem::path& file);
  /// Throws InvalidOption.
  void check() const;
  [[nodiscard]] PropertyMapPrior prior() const;
  /// Class of every value of a class image; `classes.size()` where it is no ground.
  [[nodiscard]] std::vector<std::uint8_t> class_of_value() const;
};

}  // namespace roadbook
