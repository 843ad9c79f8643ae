#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mapping/map_layers.hpp"
#include "semantics/labels.hpp"
#include "semantics/person_search.hpp"

namespace roadbook {

/// A round of learning people: what was learnt from, and what was found in images not seen before.
struct PeopleRound {
  int number = 0;
  std::int64_t begin_ns = 0;
  double seconds = 0.0;
  std::size_t persons = 0;  ///< windows that show somebody, learnt from
  std::size_t nobody = 0;
  std::size_t images = 0;  ///< looked through
  std::size_t found = 0;   ///< likely somebody in them
};

struct SearchedImage {
  LabelAnchor image;
  std::vector<PersonHypothesis> hypotheses;  ///< best first
};

inline constexpr const char* kPeopleLearningTable = "people_learning";  ///< record

/// What the rounds so far have brought: it outlives the server, in table `people_learning`.
struct PeopleRecord {
  std::vector<PeopleRound> rounds;
  std::vector<SearchedImage> images;  ///< of the last round, the most useful to ask about first
  std::size_t next = 0;               ///< of all images, in the order they are taken in
};

[[nodiscard]] nlohmann::json people_record_to_json(const PeopleRecord& record);
[[nodiscard]] PlainTable people_record_table(const PeopleRecord& record);
/// Empty where the text is no record: rounds can be learnt again.
[[nodiscard]] PeopleRecord people_record_from_text(const std::string& text);

}  // namespace roadbook
