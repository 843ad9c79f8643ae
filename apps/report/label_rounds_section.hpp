#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/label_server/learning_record.hpp"
#include "apps/label_server/people_record.hpp"

namespace roadbook {

// The rounds of learning of a map's labelling page, as a part of the report: what each learnt from,
// and the name of what it learnt.

/// Rounds about things on the ground, and about people in images.
struct LabelRounds {
  std::vector<LearningRound> ground;
  std::vector<PeopleRound> people;
};

/// Of the tables `label_learning` and `people_learning`.
[[nodiscard]] LabelRounds read_label_rounds(const MapLayers& layers);

/// Empty without rounds. Names of classifiers are their first eight digits.
[[nodiscard]] std::string rounds_table(const LabelRounds& rounds);
/// One entry a round, in the order of the table; `classifier` null where no program told it.
[[nodiscard]] nlohmann::ordered_json label_rounds_json(const LabelRounds& rounds);

}  // namespace roadbook
