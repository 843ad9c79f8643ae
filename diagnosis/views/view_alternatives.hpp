#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/views/view_problem.hpp"

namespace roadbook {

// Names that the views of a map cannot tell apart, told apart by the car's motion.
//
// Views know the cameras' clock by the wheels' alone: images that are late and wheels that are
// early look the same. Reference poses or a gyro know better, and what they say has to stand in
// the model before anything is written.

/// Evidence [nats] of all that the motion still wants once `effects` are known beside all else that
/// the views have answered in `found`; none where the motion says nothing.
using MotionWants =
    std::function<std::optional<double>(const Diagnosis& found, const EffectSizes& effects)>;

struct ViewAnswers {
  Diagnosis found;
  std::vector<std::string> contradicted;  ///< names of sets that the motion has ruled out
};

/// Searches the views, and tries every name of an inseparable set on the motion. Those with which
/// it wants more than with the best, by more than a set allows (`SearchOptions::in_set`), leave the
/// set: two streams late by the same are one delay of the cameras. Where the name found is one of
/// them, the best takes its place. `witness`, as the note has it: "the reference poses".
[[nodiscard]] ViewAnswers diagnose_views(const ViewProblem& views,
                                         SearchOptions options,
                                         const MotionWants& wants,
                                         const std::string& witness);

}  // namespace roadbook
