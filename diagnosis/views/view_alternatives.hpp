#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/views/view_problem.hpp"

namespace roadbook {

// Uses the car's motion to separate effects that are confounded in the views of a map. Views
// determine the clock of the cameras only through the wheels: late images and early wheels give the
// same views. Reference poses or a gyro separate them, so the motion is asked before any result is
// written.

/// Evidence [nats] of the effects that the motion data still support once `effects` are in the
/// model, together with all other effects of `found`. No value if there are no motion data to
/// decide.
using RemainingMotionEvidence =
    std::function<std::optional<double>(const Diagnosis& found, const EffectSizes& effects)>;

struct ViewAnswers {
  Diagnosis found;
  std::vector<std::string> contradicted;  ///< effects that the motion data ruled out
};

/// Searches the views, then compares the members of each equivalence set with the motion data. A
/// member leaves the set if the motion data support more further effects with it than with the best
/// member, by more than `SearchOptions::confounded_loss` nats. If the effect that was found leaves
/// its set, the best member replaces it and the search runs again.
///
/// `witness`: the separating data, as named in the note of the report, for example "the reference
/// poses".
[[nodiscard]] ViewAnswers diagnose_views(const ViewProblem& views,
                                         SearchOptions options,
                                         const RemainingMotionEvidence& wants,
                                         const std::string& witness);

}  // namespace roadbook
