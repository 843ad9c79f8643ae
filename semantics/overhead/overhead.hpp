#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "semantics/overhead/exposure.hpp"
#include "semantics/overhead/ground_model.hpp"
#include "sensors/rig.hpp"
#include "sensors/vehicle.hpp"

namespace roadbook {

// Synthetic overhead image: a top view of the ground, made from the camera images. Source:
// [metric-semantic maps, section V-A.1]. Method and files: docs/guide/overhead.md.
//
// The paper rectifies the fisheye images first. An image of 180 degrees cannot be rectified to a
// pinhole image, so each ground pixel is projected directly through the camera model.

/// Knowledge of the own vehicle used for a rig: its source, and the share of each camera's image
/// that the vehicle covers.
struct VehicleUse {
  VehicleSource source = VehicleSource::kNone;
  std::vector<double> masked_share;  ///< by camera, 0 to 1
};

/// One instant: vehicle pose and camera images.
struct OverheadView {
  /// One function per camera of the rig; returns the grey 8-bit image, empty if it is missing.
  /// Called at most twice (exposure, mosaic), from any thread.
  std::vector<std::function<cv::Mat()>> images;
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  int rig = 0;            ///< index in OverheadInput::rigs
  int session = 0;        ///< for the table of frames
  int keyframe = 0;       ///< for the table of frames
  std::int64_t t_ns = 0;  ///< for the table of frames; since 1970
};

struct OverheadInput {
  std::vector<Rig> rigs;
  /// masks[rig][camera]: 0 where the own vehicle is visible; any size; empty: no mask. May be
  /// shorter than `rigs`.
  std::vector<std::vector<cv::Mat>> masks;
  /// bodies[rig]: box of the own vehicle, vehicle frame. Ground that it covers or hides is left out
  /// (`is_hidden_by_body`). An empty box hides nothing. May be shorter than `rigs`.
  std::vector<Eigen::AlignedBox3d> bodies;
  std::vector<VehicleUse> vehicles;  ///< by rig, for the summary
  std::vector<OverheadView> views;   ///< in driving order
  GroundModel ground = GroundModel::plane();
};

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
  int memory_mb = 512;        ///< for tiles in memory; other tiles are in a scratch folder
  int num_threads = 0;        ///< 0: all cores; the result does not depend on it
  /// Part of the map to make (x, y); empty: everything in range of the views.
  std::optional<Eigen::AlignedBox2d> area;

  /// Throws InvalidOption.
  void check() const;
};

/// Instant of a frame number in the layers.
struct OverheadFrame {
  int session = 0;
  int keyframe = 0;
  std::int64_t t_ns = 0;
};

/// A block of the raster and the ranges of frames that contributed to it, such as "0-14 80-92".
struct OverheadBlock {
  int column = 0;
  int row = 0;
  std::string frames;
};

/// Effect of the exposure balance on the image.
struct OverheadExposure {
  /// False if balancing was switched off, or was dropped because it saturated more than
  /// `kMostSaturatedMore` of the ground in addition to what is saturated as recorded.
  bool balanced = false;
  double least_gain = 1.0;
  double most_gain = 1.0;
  double saturated = 0.0;           ///< share of the observed ground, with these gains
  double saturated_recorded = 0.0;  ///< the same for the recorded brightness
};
inline constexpr double kMostSaturatedMore = 0.01;

struct OverheadSummary {
  std::filesystem::path image;     ///< 8 bit, nodata 0
  std::filesystem::path count;     ///< 16 bit: images that contributed, nodata 0
  std::filesystem::path variance;  ///< float: variance of the grey values averaged, nodata -1
  std::filesystem::path
      frames;  ///< 3 bands of 32 bit: frame with most weight, first, last; nodata 2^32-1
  std::filesystem::path frame_table;  ///< CSV: frame -> session, keyframe, stamp
  std::filesystem::path tile_table;   ///< CSV: every tile's contributing frames
  int columns = 0;
  int rows = 0;
  double west_m = 0.0;   ///< map x of the left border
  double north_m = 0.0;  ///< map y of the upper border
  double resolution_m = 0.0;
  double covered_m2 = 0.0;
  double coverage = 0.0;    ///< share of the raster's rectangle that was observed
  double sigma_grey = 0.0;  ///< square root of the mean variance of the observed pixels
  OverheadExposure exposure;
  std::vector<OverheadFrame> frame_list;  ///< all views; the frame number is the index
  std::vector<OverheadBlock> blocks;      ///< blocks with content, from the north-west
  std::size_t views = 0;
  std::size_t images_used = 0;
  std::size_t images_missing = 0;
  std::size_t tiles = 0;
  std::size_t tiles_spilled = 0;     ///< number of times a tile was moved to the scratch folder
  double max_range_m = 0.0;          ///< as used
  std::vector<VehicleUse> vehicles;  ///< by rig; for a Map by session
  double exposure_seconds = 0.0;
  double mosaic_seconds = 0.0;
  double write_seconds = 0.0;
  std::vector<Problem> warnings;
};

/// How far ground is taken from cameras of these rigs: 8 m, or half as far again as the nearest
/// ground that every camera sees, where a camera looks ahead over a near blind area (at most 100).
[[nodiscard]] double range_of_rigs(const std::vector<Rig>& rigs);

/// Makes the overhead image of `input` in folder `out` (created if missing; files are replaced).
///
/// Memory is bounded by `options.memory_mb` plus one small batch of images, for any size of map.
/// Equal input and options give equal bytes for any number of threads. Throws InvalidOption;
/// BadInput for views that do not match their rig; Refused if no ground pixel is observed;
/// StorageError; Interrupted.
OverheadSummary make_overhead(const OverheadInput& input,
                              const std::filesystem::path& out,
                              const OverheadOptions& options = {},
                              const Progress& progress = {});

/// Same for a map: the ground is estimated from the map, images are read from `drives` (one per
/// session; a null pointer leaves out the session).
OverheadSummary make_overhead(const Map& map,
                              const std::vector<const Drive*>& drives,
                              const std::filesystem::path& out,
                              const OverheadOptions& options = {},
                              const Progress& progress = {});

/// Views, rigs, own-vehicle masks and ground of a map, as the second make_overhead uses them. The
/// result refers to `drives`.
[[nodiscard]] OverheadInput overhead_input(const Map& map,
                                           const std::vector<const Drive*>& drives,
                                           const OverheadOptions& options = {});

}  // namespace roadbook
