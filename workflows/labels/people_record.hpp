#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mapping/layers/map_layers.hpp"
#include "semantics/labels/labels.hpp"
#include "semantics/people/person_search.hpp"

namespace roadbook {

/// A round of learning people: its examples, and its detections in images not seen before.
struct PeopleRound {
  int number = 0;
  std::int64_t begin_ns = 0;
  double seconds = 0.0;
  std::size_t persons = 0;  ///< positive examples: windows that show a person
  std::size_t nobody = 0;
  std::size_t images = 0;    ///< searched images
  std::size_t found = 0;     ///< likely persons in these images
  std::size_t again = 0;     ///< false alarms of its first classifier, in images that are done
  std::int64_t event = 0;    ///< last label event from which it learnt
  std::string basis{};       ///< people_basis; empty: the program of the round did not record it
  std::string classifier{};  ///< the learnt classifier: GpClassifier::digest
};

struct SearchedImage {
  LabelAnchor image;
  std::vector<PersonHypothesis> hypotheses;  ///< best first
};

/// A window in which the classifier detected a person, although the image shows no person there.
struct FalseAlarm {
  PersonBox box;
  std::string picture;  ///< PNG (window_picture)
};

/// The second search of an image that was done before the round, with the classifier of the round.
/// It is not an answer of a user. It follows from the labels (hard_negatives.hpp).
struct SecondLook {
  LabelAnchor image;
  std::vector<FalseAlarm> alarms;
};

inline constexpr const char* kPeopleLearningTable = "people_learning";  ///< record, picture

/// The result of all rounds so far. It outlives the server in table `people_learning`.
struct PeopleRecord {
  std::vector<PeopleRound> rounds;
  std::vector<SearchedImage> images;  ///< of the last round, the most useful to ask about first
  std::size_t next = 0;               ///< index of the next image in the order of the search
  std::vector<SecondLook> looks;      ///< in the order of the searches
};

/// Converts the record to JSON without the pictures.
[[nodiscard]] nlohmann::json people_record_to_json(const PeopleRecord& record);
/// Makes a table: the record in the first row, then the pictures of its false alarms in order.
[[nodiscard]] PlainTable people_record_table(const PeopleRecord& record);
/// Empty if the table has no record. The rounds can then be repeated.
[[nodiscard]] PeopleRecord people_record_from_table(const PlainTable& table);
/// Empty if the map has no such table.
[[nodiscard]] PeopleRecord read_people_record(const MapLayers& layers);

}  // namespace roadbook
