#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/messages.hpp"
#include "exchange/layers/occupancy_layers.hpp"
#include "workflows/occupancy/occupancy_demands.hpp"

namespace roadbook {

/// The origin of the readings: a range scanner, or landmarks of the map that cameras saw.
enum class OccupancySensor { kRange, kCameras };

/// The arguments of `make_occupancy`.
struct OccupancyRequest {
  std::vector<std::filesystem::path> drives;  ///< empty: the stored patches are placed again
  std::filesystem::path map;
  OccupancySensor sensor = OccupancySensor::kRange;
  OccupancyUpdate update = OccupancyUpdate::kLogOdds;
  std::string model = "fitted";  ///< fitted, nominal, or a YAML file of the mixture
  std::optional<double> temper;  ///< weight of one reading; empty: by the dependence of readings
  double cell_m = 0.1;
  double patch_m = 6.0;        ///< distance driven within one patch
  double wide_beam_rad = 0.0;  ///< full angle of a beam; 0: a ray
  bool replace = false;        ///< starts a new grid
  int num_threads = 0;
};

/// What one drive added.
struct OccupancyOfDrive {
  OccupancyDrive drive;
  std::size_t without_pose = 0;         ///< scans
  std::size_t fitted_samples = 0;       ///< readings with an expected distance
  std::vector<double> autocorrelation;  ///< of a cell's innovations, from lag 1
  std::size_t patches = 0;
  std::size_t updates = 0;    ///< changes of cells
  double seconds = 0.0;       ///< processor time of the changes of cells
  std::size_t on_ground = 0;  ///< landmarks that cameras saw on the ground
  std::size_t raised = 0;     ///< raised landmarks that cameras saw
};

struct OccupancyResult {
  StoredOccupancy stored;
  OccupancyGrid grid;
  std::vector<OccupancyOfDrive> drives;
  OccupancyDemands demands;  ///< with truth where the last drive is simulated
};

/// Adds drives to the occupancy grid of a map. A drive that is a session of the map takes the poses
/// of the session; another is localised first (cameras: only sessions have landmarks). A drive that
/// the grid has already replaces its earlier readings of the same sensor. The result in the map
/// does not depend on the number of threads.
///
/// Throws BadInput (drive_scans.hpp; a drive twice), InvalidOption (another cell size or rule than
/// the stored grid's without `replace`; options of a scanner with cameras), Refused (no pose for
/// more than 20 % of the scans; no stored grid and no drive), StorageError, Interrupted.
[[nodiscard]] OccupancyResult make_occupancy(const OccupancyRequest& request, Messages& messages);

}  // namespace roadbook
