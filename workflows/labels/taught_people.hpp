#pragma once

#include <filesystem>

#include "semantics/people/person_learner.hpp"

namespace roadbook {

/// Examples of people that users gave in the labelling page: labels of windows in images, and the
/// false alarms of its rounds (workflows/labels/hard_negatives.hpp).
[[nodiscard]] PersonExamples taught_examples(const std::filesystem::path& map);

}  // namespace roadbook
