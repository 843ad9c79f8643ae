#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapping/occupancy/build_patches.hpp"
#include "mapping/occupancy/place_patches.hpp"
#include "mapping/store/map_file.hpp"
#include "sensors/range/range_mixture.hpp"

namespace roadbook {

/// One drive in the occupancy grid: a row of table `occupancy_settings`.
struct OccupancyDrive {
  std::string drive;       ///< name
  std::string digest;      ///< of the drive
  std::string sensor;      ///< range0 or cameras
  std::string model;       ///< fitted, nominal, or the name of a file
  bool localised = false;  ///< the drive is no session of the map
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::int64_t scans = 0;
  double max_m = 0.0;
  double cone_rad = 0.0;
  double temper = 1.0;
  RangeMixture mixture;        ///< of a scanner
  std::int64_t updates = 0;    ///< changes of cells
  double sights_raised = NAN;  ///< cameras: share of raised landmarks in the sights of an occupied
                               ///< cell; NaN for a scanner
  double sights_raised_free = NAN;  ///< and in those of a free cell
};

/// The occupancy grid as stored: patches, and how they were made.
struct StoredOccupancy {
  double cell_m = 0.1;
  double surfaces_per_m = 0.1;  ///< density of the map along a beam
  double prior = 0.02;          ///< probability of a cell before any reading
  OccupancyUpdate update = OccupancyUpdate::kLogOdds;
  std::vector<OccupancyDrive> drives;
  std::vector<OccupancyPatch> patches;

  [[nodiscard]] double prior_log_odds() const;
  [[nodiscard]] std::map<std::string, ReadingWeight> reading_weights() const;
};

[[nodiscard]] const char* to_text(OccupancyUpdate update);
/// Empty for an unknown name.
[[nodiscard]] std::optional<OccupancyUpdate> occupancy_update(const std::string& text);

/// Writes tables `occupancy_patches` and `occupancy_settings`, and rasters `occupancy`
/// (probability), `occupancy_sigma`, `occupancy_age` [s, before the newest reading],
/// `occupancy_coverage` (readings), `occupancy_sessions` (drives) and `occupancy_colours`,
/// replacing older ones. Cells that no reading reached have no value.
void write_occupancy_layers(MapUpdate& update,
                            const StoredOccupancy& stored,
                            const OccupancyGrid& grid);

/// Reads the tables; empty if the map has no grid. Throws BadInput for tables that contradict each
/// other.
[[nodiscard]] std::optional<StoredOccupancy> read_occupancy_layers(const MapLayers& layers);

}  // namespace roadbook
