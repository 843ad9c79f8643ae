#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "workflows/labels/learning_record.hpp"
#include "workflows/labels/people_record.hpp"

namespace roadbook {

// The part of the report about the learning rounds of a map's labelling page: for each round, the
// examples and the digest of the learnt classifier.

/// Rounds about objects on the ground, and about people in images.
struct LabelRounds {
  std::vector<LearningRound> ground;
  std::vector<PeopleRound> people;
};

/// Reads the tables `label_learning` and `people_learning`.
[[nodiscard]] LabelRounds read_label_rounds(const MapLayers& layers);

/// Empty without rounds. The name of a classifier is the first eight digits of its digest.
[[nodiscard]] std::string rounds_table(const LabelRounds& rounds);
/// Returns one entry for each round, in the order of the table. `classifier` is null if the program
/// of the round did not record it.
[[nodiscard]] nlohmann::ordered_json label_rounds_json(const LabelRounds& rounds);

}  // namespace roadbook
