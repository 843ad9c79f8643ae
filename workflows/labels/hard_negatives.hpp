#pragma once

#include <set>
#include <vector>

#include "workflows/labels/people_images.hpp"
#include "workflows/labels/people_record.hpp"

namespace roadbook {

// Hard negatives (Dalal and Triggs, Histograms of Oriented Gradients, CVPR 2005). A user has
// declared that an image shows no other person. If the classifier of a later round detects a person
// there, the detection is a false alarm. The server does not ask the user about it (`reject_again`
// of semantics/people/person_oracle.cpp). The false alarm stays valid while the declaration is in
// force and no label of a person is drawn there.

inline constexpr std::size_t kSecondLooksARound = 24;  ///< images; the others wait for the next
                                                       ///< round

/// Returns the images for which a user has declared that they show no other person.
[[nodiscard]] std::set<LabelAnchor> done_images(const std::vector<Label>& labels);

/// Returns the second looks whose images are still done.
[[nodiscard]] std::vector<SecondLook> looks_that_stand(std::vector<SecondLook> looks,
                                                       const std::vector<Label>& labels);

/// Returns the negative examples: the false alarms that are still valid, in their order.
[[nodiscard]] PersonExamples examples_of_looks(const std::vector<SecondLook>& looks,
                                               const std::vector<Label>& labels);

/// Searches the images that are done and that no element of `looks` covers. The image that was done
/// first comes first.
[[nodiscard]] std::vector<SecondLook> further_looks(const PeopleImages& images,
                                                    const GpClassifier& classifier,
                                                    const std::vector<Label>& labels,
                                                    const std::vector<SecondLook>& looks,
                                                    int num_threads);

}  // namespace roadbook
