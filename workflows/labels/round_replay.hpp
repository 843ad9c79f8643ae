#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "semantics/detector/box_learner.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/labels/learning_record.hpp"

namespace roadbook {

// Repeats the rounds of a map from its list of events. The result of a round is a function of the
// labels at that time, the picture, and the examples given to the detector.

/// Returns a name (digest) of a round's inputs other than the labels: the poses, the picture, and
/// the examples of other places.
[[nodiscard]] std::string round_basis(const Map& map,
                                      const GroundImage& image,
                                      const BoxExamples& taught);

/// Returns the sides [m] of the detector's window in the last round about that class. Empty if
/// there is no such round.
[[nodiscard]] std::optional<Eigen::Vector2d> window_before(const std::vector<LearningRound>& rounds,
                                                           const std::string& kind);

/// Returns the digest of the classifier that round `number` (an index of `rounds`) learns from the
/// events up to its own. Empty if there is nothing to learn.
[[nodiscard]] std::string replayed_classifier(const Map& map,
                                              const GroundImage& image,
                                              const BoxExamples& taught,
                                              const BoxLearnerOptions& options,
                                              const std::vector<LabelEvent>& events,
                                              const std::vector<LearningRound>& rounds,
                                              std::size_t number);

}  // namespace roadbook
