#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "semantics/detector/search_prior.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// What labels tell of the detector whose hypotheses they answer.

/// The answer of a user about an object of a class.
struct LabelAnswer {
  std::int64_t t_ns = 0;        ///< when, since 1970
  bool right = false;           ///< it is one; else it was said to be none
  bool drawn = false;           ///< by hand
  std::optional<double> found;  ///< probability with which a search had found it, where one had
};

/// Empty where the label is deleted or says nothing of that class; given when the label was
/// changed.
[[nodiscard]] std::optional<LabelAnswer> answer_of(const Label& label, const std::string& kind);

/// Whether a change of a label leaves what was said about its class: a nudge or a note does.
[[nodiscard]] bool says_the_same(const Label& before, const Label& after);

struct AnswerCounts {
  std::size_t accepted = 0;  ///< of what was found
  std::size_t rejected = 0;
  std::size_t drawn = 0;  ///< right ones that no hypothesis showed
};

/// Counts the answers given from `from_ns` up to, but not including, `to_ns`. Of the hypotheses,
/// only those with a score of at least `least` count. The precision of the detector is computed
/// from these counts.
[[nodiscard]] AnswerCounts count_answers(const std::vector<LabelAnswer>& answers,
                                         double least,
                                         std::int64_t from_ns,
                                         std::int64_t to_ns);

/// What searches had found before it was answered, in the order the answers were given.
[[nodiscard]] std::vector<SearchAnswer> search_answers(std::vector<LabelAnswer> answers);

}  // namespace roadbook
