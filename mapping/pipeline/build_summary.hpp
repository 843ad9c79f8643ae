#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "drive/drive.hpp"
#include "mapping/cameras/camera_figures.hpp"
#include "mapping/map.hpp"
#include "mapping/pipeline/parking_row_prior.hpp"
#include "mapping/pipeline/truth_error.hpp"

namespace roadbook {

// What a build or an extension of a map reports.

/// Where the measures of a session's vehicle came from.
struct SessionVehicle {
  std::string session;
  VehicleSource source = VehicleSource::kNone;
};

/// The sources without the session names.
[[nodiscard]] std::vector<VehicleSource> sources_of(const std::vector<SessionVehicle>& vehicles);

/// Comparison of a session with the truth of its drive.
struct SessionTruth {
  std::string session;
  std::optional<double> ate_median_m;  ///< after its own best alignment; empty without truth
  std::optional<double> ate_p95_m;
  std::optional<SessionOffset> offset;  ///< against all sessions; empty if they are not comparable
};

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
  /// Length of the residual, full-size image; empty without observations.
  std::optional<double> reprojection_median_px;
  std::optional<double> reprojection_rms_px;  ///< per coordinate, full-size image
  ScaleSource scale_source = ScaleSource::kFree;
  std::optional<double> scale_sigma;   ///< relative; empty where it is not known
  std::optional<double> ate_median_m;  ///< of all sessions together (TruthErrors::together)
  std::optional<double> ate_p95_m;
  std::vector<SessionTruth> truth_sessions;  ///< by session; empty if none has truth
  std::string truth_apart;                   ///< why sessions with truth are not compared together
  double drive_seconds = 0.0;                ///< recorded time, for the real-time factor
  std::size_t components = 1;                ///< parts of the drives that nothing joins
  std::vector<CameraFigures> cameras;        ///< of each drive in turn
  std::optional<EqualRowsUsed> rows;         ///< empty without MapOptions::equal_rows
  std::vector<SessionVehicle> vehicles;      ///< by session
  std::vector<StageTime> stages;
  std::string digest;
  /// Nothing was done, because the map was made from the same inputs. Only values that the map file
  /// stores are filled in.
  bool is_unchanged = false;
  /// Of the drive's keyframes, localised in the map that it extended; empty after a build.
  std::optional<double> localised_share;
  /// Layers and tables of the previous map that the new one does not have, ascending.
  std::vector<std::string> dropped;
  std::vector<Problem> warnings;
};

/// Counts what the map holds.
void count_contents(const Map& map, MapSummary& summary);

/// Adds what the readers of the drives doubt.
void add_warnings_of(const std::vector<Drive>& drives, MapSummary& summary);

/// Compares the map with the truths of its sessions, in their order.
void add_truth_errors(const std::vector<DriveTruth>& truths, const Map& map, MapSummary& summary);

/// Names the layers and tables in `names_before` that the map in `file` lacks, and its digest.
void add_dropped(const std::vector<std::string>& names_before,
                 const std::filesystem::path& file,
                 MapSummary& summary);

/// The error of the key points that fit, of the full-size images.
void add_reprojection(const BundleResult& result, MapSummary& summary);

}  // namespace roadbook
