#pragma once

#include <string>
#include <vector>

#include "semantics/labels/labels.hpp"
#include "semantics/people/person_learner.hpp"

namespace roadbook {

// Converts labels of image windows (LabelShape kUpright and kImage) to training examples of the
// person detector. Labels store their windows as pictures, so training needs neither the recording
// nor fixed features.

inline constexpr const char* kPersonKind = "person";

/// PNG of the window of `box` (PersonWindow::patch).
[[nodiscard]] std::string window_picture(const PersonCamera& camera,
                                         const ImagePyramid& image,
                                         const PersonBox& box);

/// Adds the windows in `pictures` as examples. Throws BadInput naming `table` and `field` for an
/// invalid picture.
void add_pictures(const std::vector<std::string>& pictures,
                  bool person,
                  const std::string& table,
                  const std::string& field,
                  PersonExamples& examples);

/// Examples of all window labels of class `person` and `not_person`, in the order of `labels`.
/// Throws BadInput naming the label whose picture is invalid.
[[nodiscard]] PersonExamples examples_of(const std::vector<Label>& labels);

/// Answers to hypotheses that the detector had found before training on them: labels of class
/// `person` and `not_person` whose probability was recorded, in the order of `labels`.
[[nodiscard]] std::vector<SearchAnswer> answers_of(const std::vector<Label>& labels);

}  // namespace roadbook
