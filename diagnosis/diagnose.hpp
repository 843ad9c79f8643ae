#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/motion/motion_problem.hpp"
#include "diagnosis/options.hpp"
#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// What the simulation gets wrong in a drive: the whole of it, from plain streams.

/// Streams that passed their checks, ready to be searched, alone or beside other problems.
struct PreparedMotion {
  std::unique_ptr<MotionProblem> problem;
  std::vector<std::string> notes;  ///< what could not be looked at, and why
  double length_m = 0.0;
};

/// Throws BadInput where the streams cannot be diagnosed: `name` stands for the drive in messages.
[[nodiscard]] PreparedMotion prepare_motion(const MotionStreams& recorded,
                                            const std::string& name,
                                            const DiagnosisOptions& options = {});

/// Everything about one drive. Throws as `prepare_motion`.
[[nodiscard]] Diagnosis diagnose(const MotionStreams& streams,
                                 const std::string& name,
                                 const DiagnosisOptions& options = {});

}  // namespace roadbook
