#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "semantics/detector/search_prior.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// The users' answers about the hypotheses of a detector, as the labels give them.

/// The answer of a user about an object of a class.
struct LabelAnswer {
  std::int64_t t_ns = 0;        ///< time since 1970
  bool right = false;           ///< the object is of the class; false: a user rejected it
  bool drawn = false;           ///< drawn by the user
  std::optional<double> found;  ///< probability of the hypothesis; empty: the object was not a
                                ///< hypothesis
};

/// Returns the answer of a label about a class, with the time of the last change of the label.
/// Empty if the label is deleted or says nothing about that class.
[[nodiscard]] std::optional<LabelAnswer> answer_of(const Label& label, const std::string& kind);

/// Returns whether the answer about the class stays the same after a change. It does after a small
/// move or a new note.
[[nodiscard]] bool says_the_same(const Label& before, const Label& after);

struct AnswerCounts {
  std::size_t accepted = 0;  ///< among the hypotheses
  std::size_t rejected = 0;
  std::size_t drawn = 0;  ///< correct objects that no hypothesis showed
};

/// Counts the answers given from `from_ns` up to, but not including, `to_ns`. Of the hypotheses,
/// only those with a score of at least `least` count. The precision of the detector is computed
/// from these counts.
[[nodiscard]] AnswerCounts count_answers(const std::vector<LabelAnswer>& answers,
                                         double least,
                                         std::int64_t from_ns,
                                         std::int64_t to_ns);

/// Returns the answers about hypotheses, with their probability before the answer, in the order of
/// the answers.
[[nodiscard]] std::vector<SearchAnswer> search_answers(std::vector<LabelAnswer> answers);

}  // namespace roadbook
