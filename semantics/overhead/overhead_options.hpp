#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "semantics/overhead/exposure.hpp"
#include "semantics/overhead/ground_model.hpp"
#include "sensors/vehicle.hpp"

namespace roadbook {

enum class OverheadMode {
  kWeighted,  ///< mean weighted by ground resolution; saturated pixels have 2 % of the weight
  kMean,      ///< plain mean, as in the paper
};

struct OverheadOptions {
  double resolution_m = 0.02;  ///< side of a pixel on the ground
  /// Largest horizontal distance from a camera to ground taken from it. Empty: `range_of_rigs`.
  std::optional<double> max_range_m;
  double min_depression_rad = 0.10;  ///< ground seen at a flatter angle is left out
  double border_px =
      12.0;  ///< weight rises from 0 to full over this distance from the image border
  OverheadMode mode = OverheadMode::kWeighted;
  bool balance_exposure = true;  ///< one gain per image, from overlaps
  GainOptions gains;             ///< of the exposure balance
  /// Moves each view vertically so that its origin lies on the ground model. Height errors of
  /// single poses then do not displace the image.
  bool stand_on_ground = true;
  /// For a Map: vehicle measures that replace those of the map.
  std::optional<VehicleMeasures> vehicle;
  GroundModelOptions ground;  ///< for a Map; reach_m is raised to max_range_m if smaller
  int memory_mb = 512;        ///< for tiles, and for images that a second pass reads
  int num_threads = 0;        ///< 0: all cores; the result does not depend on it
  /// Part of the map to make (x, y); empty: everything in range of the views.
  std::optional<Eigen::AlignedBox2d> area;

  /// Throws InvalidOption.
  void check() const;
};

}  // namespace roadbook
