#include "apps/label_server/label_answers.hpp"

#include <algorithm>

#include "semantics/detector/gp_classifier.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {

bool says_the_same(const Label& before, const Label& after) {
  return before.state == after.state && before.kind == after.kind;
}

std::optional<LabelAnswer> answer_of(const Label& label, const std::string& kind) {
  const bool right = label.kind == kind;
  if (label.state == LabelState::kDeleted || (!right && label.kind != rejected_kind(kind)))
    return std::nullopt;
  LabelAnswer answer{label.t_ns, right, label.source == LabelSource::kDrawn, std::nullopt};
  if (was_found(label)) answer.found = label.score;
  return answer;
}

AnswerCounts count_answers(const std::vector<LabelAnswer>& answers,
                           double least,
                           std::int64_t from_ns,
                           std::int64_t to_ns) {
  AnswerCounts counts;
  for (const LabelAnswer& answer : answers) {
    if (answer.t_ns < from_ns || answer.t_ns >= to_ns) continue;
    if (answer.right && answer.drawn) ++counts.drawn;
    if (answer.found.value_or(-1.0) < least) continue;
    ++(answer.right ? counts.accepted : counts.rejected);
  }
  return counts;
}

std::vector<SearchAnswer> search_answers(std::vector<LabelAnswer> answers) {
  std::stable_sort(answers.begin(), answers.end(),
                   [](const LabelAnswer& a, const LabelAnswer& b) { return a.t_ns < b.t_ns; });
  std::vector<SearchAnswer> of_searches;
  for (const LabelAnswer& answer : answers)
    if (answer.found) of_searches.push_back({logit_of(*answer.found), answer.right});
  return of_searches;
}

}  // namespace roadbook
