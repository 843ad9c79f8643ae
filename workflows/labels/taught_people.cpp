#include "workflows/labels/taught_people.hpp"

#include <vector>

#include "semantics/labels/label_store.hpp"
#include "semantics/people/person_labels.hpp"
#include "workflows/labels/hard_negatives.hpp"

namespace roadbook {

PersonExamples taught_examples(const std::filesystem::path& map) {
  const std::vector<Label> labels = read_image_labels(map);
  const PeopleRecord record = read_people_record(MapLayers(map));
  PersonExamples examples = joined(examples_of(labels), examples_of_looks(record.looks, labels));
  examples.answers = answers_of(labels);
  return examples;
}

}  // namespace roadbook
