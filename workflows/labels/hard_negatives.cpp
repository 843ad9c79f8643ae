#include "workflows/labels/hard_negatives.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "semantics/people/person_labels.hpp"
#include "semantics/people/person_oracle.hpp"

namespace roadbook {
namespace {

// Returns the boxes of all people that the labels show in an image.
std::vector<PersonBox> shown_in(const LabelAnchor& image, const std::vector<Label>& labels) {
  std::vector<PersonBox> boxes;
  for (const Label& label : labels)
    if (label.anchor == image && label.shape == LabelShape::kUpright && label.kind == kPersonKind)
      boxes.push_back(label.window);
  return boxes;
}

bool is_on_nobody(const PersonBox& box, const std::vector<PersonBox>& people) {
  const double least = PersonOracleOptions().none_overlap;
  return std::none_of(people.begin(), people.end(), [&](const PersonBox& person) {
    return intersection_over_union(box, person) >= least;
  });
}

SecondLook look_at(const PeopleImages& images,
                   const GpClassifier& classifier,
                   const LabelAnchor& image,
                   const std::vector<PersonBox>& people) {
  std::vector<PersonBox> boxes;
  for (const PersonHypothesis& h : images.search(image, classifier))
    if (h.prediction.probability >= PersonOracleOptions().likely_negative &&
        is_on_nobody(h.box, people))
      boxes.push_back(h.box);
  SecondLook look{image, {}};
  if (boxes.empty()) return look;
  const auto pictures = images.pictures(image, boxes);
  for (std::size_t i = 0; i < pictures.size(); ++i) look.alarms.push_back({boxes[i], pictures[i]});
  return look;
}

}  // namespace

std::set<LabelAnchor> done_images(const std::vector<Label>& labels) {
  std::set<LabelAnchor> done;
  for (const Label& label : labels)
    if (label.shape == LabelShape::kImage) done.insert(label.anchor);
  return done;
}

std::vector<SecondLook> looks_that_stand(std::vector<SecondLook> looks,
                                         const std::vector<Label>& labels) {
  const auto done = done_images(labels);
  std::erase_if(looks, [&](const SecondLook& look) { return !done.contains(look.image); });
  return looks;
}

PersonExamples examples_of_looks(const std::vector<SecondLook>& looks,
                                 const std::vector<Label>& labels) {
  PersonExamples examples;
  const auto done = done_images(labels);
  for (const SecondLook& look : looks) {
    if (!done.contains(look.image)) continue;
    const auto people = shown_in(look.image, labels);
    for (const FalseAlarm& alarm : look.alarms)
      if (is_on_nobody(alarm.box, people))
        add_pictures({alarm.picture}, false, kPeopleLearningTable, "picture", examples);
  }
  return examples;
}

std::vector<SecondLook> further_looks(const PeopleImages& images,
                                      const GpClassifier& classifier,
                                      const std::vector<Label>& labels,
                                      const std::vector<SecondLook>& looks,
                                      int num_threads) {
  std::set<LabelAnchor> seen;
  for (const SecondLook& look : looks) seen.insert(look.image);
  std::vector<LabelAnchor> chosen;
  for (const Label& label : labels)  // by label number: the order in which the images were first
                                     // done
    if (label.shape == LabelShape::kImage && chosen.size() < kSecondLooksARound &&
        images.has(label.anchor) && seen.insert(label.anchor).second)
      chosen.push_back(label.anchor);
  std::vector<SecondLook> further(chosen.size());
  parallel_for(chosen.size(), num_threads, [&](std::size_t i) {
    further[i] = look_at(images, classifier, chosen[i], shown_in(chosen[i], labels));
  });
  return further;
}

}  // namespace roadbook
