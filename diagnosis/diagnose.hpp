#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/motion/motion_problem.hpp"
#include "diagnosis/options.hpp"
#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// Diagnosis of plain streams of one drive: which effects of the sensor models it shows.

/// Streams that passed their checks, ready for the search, alone or together with other problems.
struct PreparedMotion {
  std::unique_ptr<MotionProblem> problem;
  std::vector<std::string> notes;  ///< data that could not be used, and why
  double length_m = 0.0;
};

/// Throws BadInput if the streams cannot be diagnosed. `name`: of the drive, for messages.
[[nodiscard]] PreparedMotion prepare_motion(const MotionStreams& recorded,
                                            const std::string& name,
                                            const DiagnosisOptions& options = {});

/// Everything about one drive. Throws as `prepare_motion`.
[[nodiscard]] Diagnosis diagnose(const MotionStreams& streams,
                                 const std::string& name,
                                 const DiagnosisOptions& options = {});

}  // namespace roadbook
