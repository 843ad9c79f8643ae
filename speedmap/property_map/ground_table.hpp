#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "sensors/rig.hpp"
#include "speedmap/property_map/ipm.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

// Adds class images to a property map. The ground point of each pixel is computed once for each
// camera. For each frame, only the labels in each cell of ground are counted, and each cell is
// added as one position.
//
// Weight of a frame: neighbouring pixels and successive frames repeat the errors of the
// segmentation, so that pixels are not independent labels. Labels are therefore counted by ground,
// not by pixels: `labels_per_m2` independent labels for a square metre seen over a metre of travel.
// This does not depend on resolution, frame rate or speed. A value of 0.6 gives a calibrated class
// uncertainty for errors that persist over 3 x 1 m of ground and 10 m of travel
// (docs/results/friction.md; `roadbook evaluate spm` repeats the measurement).

struct GroundTableOptions {
  double cell_m = 0.5;  ///< of ground, in the vehicle frame; half the knot spacing
  double ahead_min_m = -60.0;
  double ahead_max_m = 60.0;
  double aside_max_m = 15.0;
  int pixel_step = 1;          ///< uses every n-th pixel in both directions
  GroundPlane plane;           ///< in the vehicle frame
  double labels_per_m2 = 0.6;  ///< per metre travelled

  /// Throws InvalidOption.
  void check() const;
};

class GroundTable {
 public:
  /// Throws InvalidOption.
  GroundTable(const MountedCamera& camera, const GroundTableOptions& options);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Mean ground point [m, vehicle frame] of the pixels of each cell.
  [[nodiscard]] const std::vector<Eigen::Vector2d>& centres() const { return centres_; }
  /// Pixels that meet the ground within the limits.
  [[nodiscard]] std::size_t pixels() const { return cell_of_.size(); }
  [[nodiscard]] const GroundTableOptions& options() const { return options_; }

  /// Counts the labels in each cell; `counts`: cells x classes. `classes`: the class image, rows
  /// `row_bytes` apart. Values from `num_classes` on (no class, ego vehicle) are left out; returns
  /// their number.
  std::size_t count(const std::uint8_t* classes,
                    std::size_t row_bytes,
                    std::size_t num_classes,
                    std::vector<std::uint32_t>& counts) const;

 private:
  GroundTableOptions options_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> pixel_;    ///< row * width + column, in the order of the image
  std::vector<std::uint32_t> cell_of_;  ///< of each of them
  std::vector<Eigen::Vector2d> centres_;
};

/// Vehicle frame to path coordinates; empty outside the map.
using GroundToPath = std::function<std::optional<PathPlace>(const Eigen::Vector2d&)>;

/// Adds the counts of a frame to the map. `travelled_m`: distance since the last frame, to which
/// the weight of the labels is proportional. Returns the number of cells used.
std::size_t add_frame(PropertyMap& map,
                      const GroundTable& table,
                      std::span<const std::uint32_t> counts,
                      const GroundToPath& to_path,
                      double travelled_m);

}  // namespace roadbook
