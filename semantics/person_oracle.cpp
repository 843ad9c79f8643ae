#include "semantics/person_oracle.hpp"

#include <algorithm>

namespace roadbook {
namespace {

struct Match {
  double overlap = 0.0;
  PersonBox box;  ///< of the person
};

Match best_match(const PersonBox& box, const std::vector<TruePerson>& truth) {
  Match best;
  for (const TruePerson& person : truth)
    if (const double o = intersection_over_union(box, person.box); o > best.overlap)
      best = {o, person.box};
  return best;
}

bool likely_at(const PersonBox& box,
               const std::vector<PersonHypothesis>& found,
               const PersonOracleOptions& options) {
  return std::any_of(found.begin(), found.end(), [&](const PersonHypothesis& h) {
    return h.prediction.probability >= options.min_probability &&
           intersection_over_union(h.box, box) >= options.same_overlap;
  });
}

}  // namespace

double PersonScore::precision() const {
  return right + wrong > 0 ? static_cast<double>(right) / static_cast<double>(right + wrong) : 0.0;
}
double PersonScore::recall() const {
  return people > 0 ? static_cast<double>(right) / static_cast<double>(people) : 0.0;
}

PersonScore score_people(const std::vector<PersonHypothesis>& found,
                         const std::vector<TruePerson>& truth,
                         const PersonOracleOptions& options) {
  PersonScore score;
  for (const TruePerson& person : truth) score.people += person.clear ? 1U : 0U;
  std::vector<const PersonHypothesis*> order;
  for (const PersonHypothesis& h : found)
    if (h.prediction.probability >= options.min_probability) order.push_back(&h);
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) {
    return a->prediction.probability > b->prediction.probability;
  });
  std::vector<bool> taken(truth.size(), false);
  for (const PersonHypothesis* h : order) {
    std::size_t best = truth.size();
    double overlap = options.same_overlap;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (taken[i]) continue;
      const double o = intersection_over_union(h->box, truth[i].box);
      if (o < overlap) continue;
      overlap = o;
      best = i;
    }
    if (best == truth.size()) {
      ++score.wrong;
      continue;
    }
    taken[best] = true;
    if (truth[best].clear) ++score.right;
  }
  return score;
}

PersonRound play_person_round(const std::vector<PeopleFrame>& frames,
                              const std::vector<std::vector<TruePerson>>& truth,
                              const PersonOracleOptions& options,
                              PersonLearner& learner,
                              PersonRound total) {
  std::vector<PersonHypothesis> all;
  std::vector<std::size_t> frame_of;
  std::vector<bool> again;  // of each frame: the classifier has learnt from it before
  std::vector<std::vector<PersonBox>> known(frames.size());
  PersonScore sum;
  int to_draw = learner.classifier() ? options.boxes_a_round : options.first_boxes;
  std::vector<std::pair<std::size_t, PersonBox>> drawn;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    again.push_back(learner.knows(frames[i]));
    const auto found = learner.find(frames[i]);
    const PersonScore score = score_people(found, truth[i], options);
    sum.people += score.people;
    sum.right += score.right;
    sum.wrong += score.wrong;
    for (const TruePerson& person : truth[i])
      if (to_draw > 0 && person.clear && !likely_at(person.box, found, options)) {
        drawn.emplace_back(i, person.box);
        --to_draw;
      }
    for (const PersonHypothesis& h : found) {
      all.push_back(h);
      frame_of.push_back(i);
    }
  }
  for (const auto& [i, box] : drawn) learner.add(frames[i], box, true);
  total.drawn += static_cast<int>(drawn.size());
  const auto answer = [&](std::size_t q) {
    const Match match = best_match(all[q].box, truth[frame_of[q]]);
    if (match.overlap >= options.same_overlap) {
      const bool sloppy = match.overlap < options.good_overlap;
      total.clicks += sloppy ? 1 : 0;
      learner.add(frames[frame_of[q]], sloppy ? match.box : all[q].box, true);
    } else if (match.overlap < options.none_overlap) {
      learner.add(frames[frame_of[q]], all[q].box, false);
    }
  };
  const auto questions =
      PersonLearner::questions(all, static_cast<std::size_t>(options.questions_a_round));
  std::vector<bool> asked(all.size(), false);
  for (const std::size_t q : questions) {
    ++total.clicks;
    asked[q] = true;
    answer(q);
  }
  // "Nobody else here": one click a frame rejects what is left of its hypotheses.
  total.clicks += static_cast<int>(frames.size());
  for (std::size_t q = 0; q < all.size(); ++q) {
    known[frame_of[q]].push_back(all[q].box);
    const double overlap = best_match(all[q].box, truth[frame_of[q]]).overlap;
    if (!again[frame_of[q]]) learner.answer(all[q], overlap >= options.same_overlap);
    if (!asked[q] && all[q].prediction.probability >= options.likely_negative &&
        overlap < options.none_overlap)
      learner.add(frames[frame_of[q]], all[q].box, false);
  }
  for (const auto& [frame, box] : drawn) known[frame].push_back(box);
  for (std::size_t i = 0; i < frames.size(); ++i) learner.add_random_negatives(frames[i], known[i]);
  for (const PeopleFrame& frame : frames) learner.remember(frame);
  (void)learner.learn();
  total.people = sum.people;
  total.precision = sum.precision();
  total.recall = sum.recall();
  return total;
}

}  // namespace roadbook
