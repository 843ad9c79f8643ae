#include "semantics/people/person_examples.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

namespace roadbook {

std::size_t PersonExamples::positives() const {
  return static_cast<std::size_t>(std::count(labels.begin(), labels.end(), std::int8_t{1}));
}

void add_example(const PersonWindow& window,
                 const cv::Mat& crop,
                 bool person,
                 PersonExamples& examples) {
  const std::int8_t label = person ? 1 : -1;
  examples.features.push_back(window.feature(crop).cast<float>());
  examples.labels.push_back(label);
  if (!person) return;
  cv::Mat mirrored;
  cv::flip(crop, mirrored, 1);
  examples.features.push_back(window.feature(mirrored).cast<float>());
  examples.labels.push_back(label);
}

PersonExamples joined(PersonExamples a, const PersonExamples& b) {
  const std::size_t before = a.size();
  for (std::size_t i = 0; i < b.size(); ++i) {
    bool known = false;
    for (std::size_t j = 0; j < before && !known; ++j)
      known = a.labels[j] == b.labels[i] && a.features[j] == b.features[i];
    if (known) continue;
    a.features.push_back(b.features[i]);
    a.labels.push_back(b.labels[i]);
  }
  const std::size_t answered = a.answers.size();
  for (const SearchAnswer& answer : b.answers)
    if (std::find(a.answers.begin(), a.answers.begin() + static_cast<std::ptrdiff_t>(answered),
                  answer) == a.answers.begin() + static_cast<std::ptrdiff_t>(answered))
      a.answers.push_back(answer);
  a.instants.insert(b.instants.begin(), b.instants.end());
  return a;
}

}  // namespace roadbook
