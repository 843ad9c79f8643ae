#pragma once

#include <string>
#include <vector>

#include "semantics/labels/labels.hpp"
#include "semantics/people/person_learner.hpp"

namespace roadbook {

// What people have said about windows of images (Label: upright, image), as the detector of people
// learns from it. Labels keep the pictures of their windows, so that they teach where the recording
// is not at hand, and whatever features the detector has.

inline constexpr const char* kPersonKind = "person";

/// PNG of the window (PersonWindow::patch).
[[nodiscard]] std::string window_picture(const PersonCamera& camera,
                                         const ImagePyramid& image,
                                         const PersonBox& box);

/// Adds what windows' pictures show. Throws BadInput naming `table` and `field` where one is none.
void add_pictures(const std::vector<std::string>& pictures,
                  bool person,
                  const std::string& table,
                  const std::string& field,
                  PersonExamples& examples);

/// Examples of all windows of labels of class `person` and `not_person`, in the order of `labels`.
/// Throws BadInput naming the label whose picture is none.
[[nodiscard]] PersonExamples examples_of(const std::vector<Label>& labels);

/// What was said about windows that the detector had found before it learnt of them: all of class
/// `person` and `not_person` whose probability then is known, in the order of `labels`.
[[nodiscard]] std::vector<SearchAnswer> answers_of(const std::vector<Label>& labels);

}  // namespace roadbook
