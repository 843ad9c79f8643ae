#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "mapping/cameras/camera_figures.hpp"
#include "mapping/loops/loop_closure.hpp"
#include "mapping/pipeline/map_options.hpp"
#include "mapping/pipeline/map_stages.hpp"

namespace roadbook {

// The gate of a build: a map is made only from enough evidence. Each function throws Refused with
// one line that names the drive, what was found and what is wanted (docs/guide/mapping.md).

/// Names for the lines.
struct GateInputs {
  std::vector<std::string> drives;  ///< folders by session, as given by the user
  std::string map;                  ///< file
};
[[nodiscard]] GateInputs gate_inputs(const std::vector<std::filesystem::path>& drives,
                                     const std::filesystem::path& map);

/// Refuses parts that nothing joins, unless `options.apart`. A further drive of an existing map is
/// named as one of another place.
void require_joined(const MappingInput& input,
                    const Relaxed& relaxed,
                    const GateInputs& inputs,
                    const MapGateOptions& options);

/// Refuses if nearly all pairs of places that look alike were rejected: then the odometry or a
/// calibration is wrong.
void require_loops(const std::vector<LoopClosure>& loops,
                   const GateInputs& inputs,
                   const MapGateOptions& options);

/// Refuses poses between which no car can drive in the time. Sessions as in `inputs.drives`.
void require_possible_motions(const MappingInput& input,
                              const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                              const GateInputs& inputs);

/// Refuses drives with too few landmarks, views a keyframe or cameras in use. `doubts`: what may be
/// wrong with the cameras, for the line.
void require_evidence(const MappingInput& input,
                      const Adjusted& adjusted,
                      const std::vector<CameraFigures>& cameras,
                      const std::vector<Problem>& doubts,
                      const GateInputs& inputs,
                      const MapGateOptions& options);

/// The refusal with the warnings as further lines: what is known about the sensors of the drives
/// that were refused.
[[nodiscard]] Refused with_warnings(const Refused& refusal, const std::vector<Problem>& warnings);

/// Cameras that contributed hardly anything, or rarely at the time of the others.
[[nodiscard]] std::vector<Problem> warnings_of_idle_cameras(
    const std::vector<CameraFigures>& cameras,
    const MappingInput& input,
    const GateInputs& inputs,
    const MapGateOptions& options);

}  // namespace roadbook
