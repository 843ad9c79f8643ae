#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "mapping/layers/map_layers.hpp"
#include "semantics/detector/box_learner.hpp"

namespace roadbook {

// What the labels of one place teach the detector of another (document 004, VI-A: "the classifier
// learned from this floor could be applied to" further floors).

using ExamplesByKind = std::map<std::string, BoxExamples>;  ///< by class of label

/// Table `box_examples`: what a map's detector was given of other places. Empty where it has none.
/// Throws BadInput for a table that is damaged.
[[nodiscard]] ExamplesByKind stored_examples(const std::filesystem::path& map);
[[nodiscard]] PlainTable examples_table(const ExamplesByKind& examples);

/// What a map has taught its detector: its stored examples, and its labels on its overhead image,
/// as they are today. Throws BadInput where it has neither.
[[nodiscard]] ExamplesByKind examples_of_map(const std::filesystem::path& map,
                                             const BoxLearnerOptions& options);

}  // namespace roadbook
