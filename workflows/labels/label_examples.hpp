#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "mapping/layers/map_layers.hpp"
#include "semantics/detector/box_learner.hpp"

namespace roadbook {

// Carries the examples from the labels of one place to the detector of another place
// [metric-semantic maps, section VI-A: "the classifier learned from this floor could be applied to"
// further floors].

using ExamplesByKind = std::map<std::string, BoxExamples>;  ///< by class of label

/// Reads table `box_examples`: the examples of other places for the detector of this map. Empty if
/// the map has no such table. Throws BadInput if the table is damaged.
[[nodiscard]] ExamplesByKind stored_examples(const std::filesystem::path& map);
[[nodiscard]] PlainTable examples_table(const ExamplesByKind& examples);

/// Returns the examples of a map for its detector: its stored examples, and its current labels on
/// its overhead image. Throws BadInput if the map has neither.
[[nodiscard]] ExamplesByKind examples_of_map(const std::filesystem::path& map,
                                             const BoxLearnerOptions& options);

}  // namespace roadbook
