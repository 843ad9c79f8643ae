#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "mapping/corner_tracks.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/loops/loop_closure.hpp"
#include "mapping/map.hpp"
#include "mapping/optimisation/pose_graph.hpp"
#include "mapping/pipeline/bundle_problem.hpp"
#include "mapping/pipeline/parking_row_prior.hpp"
#include "mapping/pipeline/revisit_matching.hpp"
#include "mapping/store/existing_map.hpp"
#include "sensors/effects.hpp"
#include "vo/track_drive.hpp"

namespace roadbook {

// The `map` verb: from recorded drives to a finished map file (document 004, section IV).

struct MapOptions {
  TrackDriveOptions tracking;
  LoopOptions loops;
  PoseGraphOptions graph;
  TriangulationOptions triangulation;
  RevisitOptions revisits;
  BundleStageOptions bundle;
  int min_views = 3;        ///< of a landmark that is stored
  bool covariances = true;  ///< of poses and landmarks, from the normal equations
  int min_keyframes = 3;    ///< fewer: the drive is refused
  /// Measures of the vehicle that go before vehicle.yaml of the drives.
  std::optional<VehicleMeasures> vehicle;
  EffectSizes model;                     ///< known imperfections, taken out of rig and readings
  bool replace = false;                  ///< overwrite a map of other drives
  std::vector<std::string> keep_tables;  ///< of the map that is there: MapFinishOptions
  /// The same of what belongs to its drives: kept where the map goes on with all of them.
  std::vector<std::string> keep_tables_of_drives;
  /// Called where it does not, before anything is built; throws where too much would go.
  std::function<void(const ExistingMap&)> check_what_goes;
  /// Layers to be stored with the map as it has become: what hangs on its poses.
  std::function<std::vector<VectorLayer>(const Map&)> more_layers;
  /// Rows of equal spaces that straighten the map in its last bundle adjustment; empty: none. Asked
  /// with keyframes and map frames as the adjustment begins.
  std::function<std::vector<EqualRow>(const Map&)> equal_rows;
  EqualRowOptions row_options;
  std::string rows_digest;  ///< of what `equal_rows` reads: where it changes, so does the map
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< 0: all cores

  /// Throws InvalidOption.
  void check() const;
};

/// How the vehicle of a session was known.
struct SessionVehicle {
  std::string session;
  VehicleSource source = VehicleSource::kNone;
};

/// The sources alone.
[[nodiscard]] std::vector<VehicleSource> sources_of(const std::vector<SessionVehicle>& vehicles);

struct StageTime {
  std::string name;
  double seconds = 0.0;
  double peak_rss_mb = 0.0;
};

struct MapSummary {
  std::size_t keyframes = 0;
  std::size_t landmarks = 0;
  std::size_t sessions = 0;
  std::size_t loops_accepted = 0;
  std::size_t loops_rejected = 0;
  double reprojection_median_px = 0.0;  ///< full-size image
  double reprojection_rms_px = 0.0;     ///< per coordinate, full-size image
  ScaleSource scale_source = ScaleSource::kFree;
  double scale_sigma = 0.0;            ///< relative
  std::optional<double> ate_median_m;  ///< against the drive's truth, SE(3) aligned
  std::optional<double> ate_p95_m;
  double drive_seconds = 0.0;            ///< recorded time, for the real-time factor
  std::size_t pieces = 1;                ///< parts of the drive that nothing joins
  std::optional<EqualRowsUsed> rows;     ///< where they were asked for
  std::vector<SessionVehicle> vehicles;  ///< by session
  std::vector<StageTime> stages;
  std::string digest;
  /// Nothing was done: the map was made from the same inputs. Only what the map file tells is
  /// filled in.
  bool is_unchanged = false;
  /// Layers and tables of the map that was there which the new one does not have, ascending.
  std::vector<std::string> dropped;
  std::vector<Problem> warnings;
};

/// Builds MAP from the drives, each a session. Works in MAP.part with a checkpoint after each
/// stage; a run that was interrupted goes on where it stood and ends with the same content.
///
/// A MAP made from the same drives, options, seed and version of the program is left as it is,
/// unless `replace`; where its drives have moved, it learns their new places. Layers and tables of
/// a MAP that is there stay where the poses come out the same bit for bit; otherwise those that
/// `keep_tables` names stay, and `MapSummary::dropped` names those that went.
///
/// Throws BadInput (drives, or a MAP that is damaged, or whose drives are not the first of these
/// and not `replace`),
/// Refused (too little to map), StorageError, Interrupted.
MapSummary build_map(const std::vector<std::filesystem::path>& drives,
                     const std::filesystem::path& map,
                     const MapOptions& options,
                     const Progress& progress = {});

}  // namespace roadbook
