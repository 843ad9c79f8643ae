#pragma once

#include <set>
#include <vector>

#include "apps/label_server/people_images.hpp"
#include "apps/label_server/people_record.hpp"

namespace roadbook {

// "Nobody else is there" was said of an image before the classifier of a round was: what that one
// takes for somebody there, is nobody, and need not be asked (hard negatives: Dalal and Triggs,
// Histograms of Oriented Gradients, CVPR 2005; `reject_again` of
// semantics/people/person_oracle.cpp). What is known so stands as long as that is said and nobody
// is drawn there.

inline constexpr std::size_t kSecondLooksARound = 24;  ///< images; more wait for the next round

/// Of which it is said that nobody else is there.
[[nodiscard]] std::set<LabelAnchor> done_images(const std::vector<Label>& labels);

/// Those of the images that are still done.
[[nodiscard]] std::vector<SecondLook> looks_that_stand(std::vector<SecondLook> looks,
                                                       const std::vector<Label>& labels);

/// Examples of nobody: false alarms that stand, in their order.
[[nodiscard]] PersonExamples examples_of_looks(const std::vector<SecondLook>& looks,
                                               const std::vector<Label>& labels);

/// Looks at images that are done and in none of `looks`, the one done first before the others.
[[nodiscard]] std::vector<SecondLook> further_looks(const PeopleImages& images,
                                                    const GpClassifier& classifier,
                                                    const std::vector<Label>& labels,
                                                    const std::vector<SecondLook>& looks,
                                                    int num_threads);

}  // namespace roadbook
