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

// Synthetic overhead image (document 004, section V-A.1): what the cameras saw of the ground, seen
// from above. docs/guide/overhead.md tells the method and the files.
//
// The document (section V-A.1) rectifies the fisheye images first; an image of 180 degrees has no
// pinhole that holds it, so each ground pixel is projected straight through the camera model
// instead.

/// What an image was made with: how the own car of a rig was known, and how much of each camera's
/// image it takes.
struct VehicleUse {
  VehicleSource source = VehicleSource::kNone;
  std::vector<double> masked_share;  ///< by camera, 0 to 1
};

/// One instant at which the vehicle stood somewhere and its cameras saw something.
struct OverheadView {
  /// One a camera of the rig; gives the grey 8-bit image, or an empty Mat where there is none.
  /// Called at most twice (exposure, mosaic), from any thread.
  std::vector<std::function<cv::Mat()>> images;
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  int rig = 0;            ///< index in OverheadInput::rigs
  int session = 0;        ///< written to the table of frames
  int keyframe = 0;       ///< likewise
  std::int64_t t_ns = 0;  ///< likewise
};

struct OverheadInput {
  std::vector<Rig> rigs;
  /// masks[rig][camera]: 0 where the own car is seen; any size; empty: nothing masked. May be
  /// shorter than `rigs`.
  std::vector<std::vector<cv::Mat>> masks;
  /// bodies[rig]: box of the own car in the vehicle frame; what it covers or hides is left out
  /// (`is_hidden_by_body`). An empty box hides nothing. May be shorter than `rigs`.
  std::vector<Eigen::AlignedBox3d> bodies;
  std::vector<VehicleUse> vehicles;  ///< what is known of each rig's car, for the summary
  std::vector<OverheadView> views;   ///< in driving order
  GroundModel ground = GroundModel::plane();
};

enum class OverheadMode {
  kWeighted,  ///< mean weighted by ground resolution; saturated pixels hardly count
  kMean,      ///< plain running mean, as in document 004
};

struct OverheadOptions {
  double resolution_m = 0.02;  ///< side of a pixel on the ground
  /// Ground farther from the camera is not taken from it. Empty: `range_of_rigs`.
  std::optional<double> max_range_m;
  double min_depression_rad = 0.10;  ///< nor ground seen at a flatter angle than this
  double border_px =
      12.0;  ///< weight rises from 0 to full over this distance from the image border
  OverheadMode mode = OverheadMode::kWeighted;
  bool balance_exposure = true;  ///< one gain per image, from overlaps
  GainOptions gains;             ///< of the balance
  /// Views shift vertically so that their origin stands on the ground model: height errors of
  /// single poses then do not move what they show.
  bool stand_on_ground = true;
  /// For a Map: measures of the vehicle that go before those that the map knows.
  std::optional<VehicleMeasures> vehicle;
  GroundModelOptions ground;  ///< for a Map; reach_m is raised to max_range_m
  int memory_mb = 512;        ///< for tiles in work; the rest waits in a scratch folder
  int num_threads = 0;        ///< 0: all cores; the result is the same for any number
  /// Part of the map to make (xy); empty: all that the views reach.
  std::optional<Eigen::AlignedBox2d> area;

  /// Throws InvalidOption.
  void check() const;
};

/// An instant as the layers number it.
struct OverheadFrame {
  int session = 0;
  int keyframe = 0;
  std::int64_t t_ns = 0;
};

/// A block of the raster and the frames that contributed to it: "0-14 80-92".
struct OverheadBlock {
  int column = 0;
  int row = 0;
  std::string frames;
};

/// What the balance of exposure did to the image.
struct OverheadExposure {
  /// False where no balance was asked for, and where it was dropped: it saturated more than
  /// `kMostSaturatedMore` of the ground beyond what is saturated without it.
  bool balanced = false;
  double least_gain = 1.0;
  double most_gain = 1.0;
  double saturated = 0.0;           ///< share of the ground seen, with these gains
  double saturated_recorded = 0.0;  ///< the same in the brightness that was recorded
};
inline constexpr double kMostSaturatedMore = 0.01;

struct OverheadSummary {
  std::filesystem::path image;     ///< 8 bit, nodata 0
  std::filesystem::path count;     ///< 16 bit: images that contributed, nodata 0
  std::filesystem::path variance;  ///< float: of the grey values averaged, nodata -1
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
  double coverage = 0.0;    ///< share of the raster's rectangle that was seen
  double sigma_grey = 0.0;  ///< root of the mean variance of the pixels seen
  OverheadExposure exposure;
  std::vector<OverheadFrame> frame_list;  ///< all views; a frame's number is its place here
  std::vector<OverheadBlock> blocks;      ///< blocks with content, from the north-west
  std::size_t views = 0;
  std::size_t images_used = 0;
  std::size_t images_missing = 0;
  std::size_t tiles = 0;
  std::size_t tiles_spilled = 0;     ///< times a tile went to the scratch folder
  double max_range_m = 0.0;          ///< as used
  std::vector<VehicleUse> vehicles;  ///< by rig; of a Map: by session
  double exposure_seconds = 0.0;
  double mosaic_seconds = 0.0;
  double write_seconds = 0.0;
  std::vector<Problem> warnings;
};

/// How far ground is taken from cameras of these rigs: 8 m, or half as far again as the nearest
/// ground that every camera sees, where a camera looks ahead over a near blind area (at most 100).
[[nodiscard]] double range_of_rigs(const std::vector<Rig>& rigs);

/// Makes the overhead image of `input` in folder `out` (made where missing; files are replaced).
///
/// Memory is bounded by `options.memory_mb` plus one small batch of images, whatever the size of
/// the place. Same input and options, same bytes, on any number of threads. Throws InvalidOption;
/// BadInput for views that do not fit their rig; Refused if no ground pixel is seen; StorageError;
/// Interrupted.
OverheadSummary make_overhead(const OverheadInput& input,
                              const std::filesystem::path& out,
                              const OverheadOptions& options = {},
                              const Progress& progress = {});

/// The same for a map: ground estimated from it, images read from `drives` (one a session; null
/// where a session's drive is not at hand: it is left out).
OverheadSummary make_overhead(const Map& map,
                              const std::vector<const Drive*>& drives,
                              const std::filesystem::path& out,
                              const OverheadOptions& options = {},
                              const Progress& progress = {});

/// Views, rigs, own-car masks and ground of a map, as the second make_overhead uses them. The input
/// refers to `drives`.
[[nodiscard]] OverheadInput overhead_input(const Map& map,
                                           const std::vector<const Drive*>& drives,
                                           const OverheadOptions& options = {});

}  // namespace roadbook
