#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mapping/layers/map_layers.hpp"
#include "semantics/labels/labels.hpp"
#include "semantics/people/person_search.hpp"

namespace roadbook {

/// A round of learning people: what was learnt from, and what was found in images not seen before.
struct PeopleRound {
  int number = 0;
  std::int64_t begin_ns = 0;
  double seconds = 0.0;
  std::size_t persons = 0;  ///< windows that show somebody, learnt from
  std::size_t nobody = 0;
  std::size_t images = 0;    ///< looked through
  std::size_t found = 0;     ///< likely somebody in them
  std::size_t again = 0;     ///< false alarms of its first classifier, in images that are done
  std::int64_t event = 0;    ///< last change of the labels that it learnt from
  std::string basis{};       ///< people_basis; empty: by a program that did not tell
  std::string classifier{};  ///< what it has learnt: GpClassifier::digest
};

struct SearchedImage {
  LabelAnchor image;
  std::vector<PersonHypothesis> hypotheses;  ///< best first
};

/// A window that a classifier took for somebody where nobody is.
struct FalseAlarm {
  PersonBox box;
  std::string picture;  ///< PNG (window_picture)
};

/// An image that was done before a round, looked at once more by what the round had learnt. No
/// answer of anybody: it follows from the labels (second_look.hpp).
struct SecondLook {
  LabelAnchor image;
  std::vector<FalseAlarm> alarms;
};

inline constexpr const char* kPeopleLearningTable = "people_learning";  ///< record, picture

/// What the rounds so far have brought: it outlives the server, in table `people_learning`.
struct PeopleRecord {
  std::vector<PeopleRound> rounds;
  std::vector<SearchedImage> images;  ///< of the last round, the most useful to ask about first
  std::size_t next = 0;               ///< of all images, in the order they are taken in
  std::vector<SecondLook> looks;      ///< in the order they were taken
};

/// Without the pictures.
[[nodiscard]] nlohmann::json people_record_to_json(const PeopleRecord& record);
/// The record in the first row, then the pictures of its false alarms, in their order.
[[nodiscard]] PlainTable people_record_table(const PeopleRecord& record);
/// Empty where the table holds no record: rounds can be learnt again.
[[nodiscard]] PeopleRecord people_record_from_table(const PlainTable& table);
/// Empty where the map has none.
[[nodiscard]] PeopleRecord read_people_record(const MapLayers& layers);

}  // namespace roadbook
