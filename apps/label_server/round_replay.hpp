#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/label_server/learning_record.hpp"
#include "mapping/map.hpp"
#include "semantics/detector/box_learner.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {

// The rounds of a map, played again from its list of events: what was learnt is a function of the
// labels as they stood, the picture, and what the detector was given.

/// Names what a round learns on beside the labels: poses, picture, what was taught elsewhere.
[[nodiscard]] std::string round_basis(const Map& map,
                                      const GroundImage& image,
                                      const BoxExamples& taught);

/// Sides of the window of the last of the rounds that was about that class [m]; empty without one.
[[nodiscard]] std::optional<Eigen::Vector2d> window_before(const std::vector<LearningRound>& rounds,
                                                           const std::string& kind);

/// What round `number` (an index of `rounds`) learns from the events up to its own: digest of the
/// classifier; empty where there is nothing to learn.
[[nodiscard]] std::string replayed_classifier(const Map& map,
                                              const GroundImage& image,
                                              const BoxExamples& taught,
                                              const BoxLearnerOptions& options,
                                              const std::vector<LabelEvent>& events,
                                              const std::vector<LearningRound>& rounds,
                                              std::size_t number);

}  // namespace roadbook
