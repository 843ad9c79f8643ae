#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "mapping/cameras/camera_doubts.hpp"
#include "mapping/map.hpp"
#include "mapping/pipeline/build_summary.hpp"
#include "mapping/pipeline/map_gate.hpp"
#include "mapping/pipeline/map_options.hpp"
#include "mapping/pipeline/map_stages.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "vo/own_car_mask.hpp"

namespace roadbook {

// Steps that a build takes for its drives, and an extension of a map for its one.

/// Opens the drives and corrects them by the effects `model`, if there are any.
[[nodiscard]] std::vector<Drive> open_drives(const std::vector<std::filesystem::path>& folders,
                                             const EffectSizes& model);

/// Odometry of a drive, from its checkpoint if there is one. Throws Refused for a drive with too
/// few keyframes.
[[nodiscard]] VoResult odometry_of(const Drive& drive,
                                   const OwnCar& car,
                                   std::size_t index,
                                   const MapOptions& options,
                                   MapFileBuilder& build,
                                   const Progress& progress);

/// Appends what the odometry doubts about the sensors.
void add_doubts(const Drive& drive, const VoResult& odometry, std::vector<Problem>& warnings);

/// Keyframes that `remove_short_segments` took away.
[[nodiscard]] Problem short_segments_warning(const Drive& drive, int keyframes);

/// Notes the figures and the doubts of the cameras in `summary`. Throws Refused with too little
/// evidence for a map. Returns the doubts.
[[nodiscard]] std::vector<CameraDoubt> judge_cameras(const MappingInput& input,
                                                     const std::vector<Drive>& drives,
                                                     const Adjusted& adjusted,
                                                     const GateInputs& gate,
                                                     const MapOptions& options,
                                                     MapSummary& summary);

/// The session of a drive; its scale is set by `set_scale`.
[[nodiscard]] Session session_of(const Drive& drive,
                                 const OwnCar& car,
                                 const MapOptions& options,
                                 const std::filesystem::path& map);

/// Says what gave session number `index` of an adjustment its scale. `ground_sigma`: of the scale
/// by the cameras' height; empty if that was not used.
void set_scale(const Adjusted& adjusted,
               std::size_t index,
               const std::optional<double>& ground_sigma,
               Session& session);

}  // namespace roadbook
