#include "semantics/people/person_oracle.hpp"

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

namespace {

// Simulates the actions of a labeller, who knows the truth, on the hypotheses of some frames.
class PersonTurn {
 public:
  PersonTurn(const std::vector<PeopleFrame>& frames,
             const std::vector<std::vector<TruePerson>>& truth,
             const PersonOracleOptions& options,
             PersonLearner& learner)
      : frames_(frames), truth_(truth), options_(options), learner_(learner) {}

  /// Searches all frames, and notes clear people that the search missed, up to the number of boxes
  /// to draw.
  PersonScore find() {
    PersonScore sum;
    int to_draw = learner_.classifier() ? options_.boxes_a_round : options_.first_boxes;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      again_.push_back(learner_.knows(frames_[i]));
      const auto found = learner_.find(frames_[i]);
      const PersonScore score = score_people(found, truth_[i], options_);
      sum.people += score.people;
      sum.right += score.right;
      sum.wrong += score.wrong;
      for (const TruePerson& person : truth_[i])
        if (to_draw > 0 && person.clear && !likely_at(person.box, found, options_)) {
          drawn_.emplace_back(i, person.box);
          --to_draw;
        }
      for (const PersonHypothesis& h : found) {
        all_.push_back(h);
        frame_of_.push_back(i);
      }
    }
    return sum;
  }

  void draw(PersonRound& total) {
    for (const auto& [i, box] : drawn_) learner_.add(frames_[i], box, true);
    total.drawn += static_cast<int>(drawn_.size());
  }

  void answer_questions(PersonRound& total) {
    asked_.assign(all_.size(), false);
    for (const std::size_t q :
         PersonLearner::questions(all_, static_cast<std::size_t>(options_.questions_a_round))) {
      ++total.clicks;
      asked_[q] = true;
      answer(q, total);
    }
  }

  /// The labeller marks each frame as free of other people with one click. This rejects the
  /// remaining hypotheses of the frame.
  void reject_rest(PersonRound& total) {
    total.clicks += static_cast<int>(frames_.size());
    for (std::size_t q = 0; q < all_.size(); ++q) {
      const double overlap = match_of(q).overlap;
      if (!again_[frame_of_[q]]) learner_.answer(all_[q], overlap >= options_.same_overlap);
      if (!asked_[q] && all_[q].prediction.probability >= options_.likely_negative &&
          overlap < options_.none_overlap)
        learner_.add(frames_[frame_of_[q]], all_[q].box, false);
    }
  }

  void learn() {
    std::vector<std::vector<PersonBox>> known(frames_.size());
    for (std::size_t q = 0; q < all_.size(); ++q) known[frame_of_[q]].push_back(all_[q].box);
    for (const auto& [frame, box] : drawn_) known[frame].push_back(box);
    for (std::size_t i = 0; i < frames_.size(); ++i)
      learner_.add_random_negatives(frames_[i], known[i]);
    for (const PeopleFrame& frame : frames_) learner_.remember(frame);
    (void)learner_.learn();
  }

  /// Adds hard negatives without a click (Dalal and Triggs, Histograms of Oriented Gradients, CVPR
  /// 2005). The frames are completely annotated, so every other hypothesis of the new classifier is
  /// a false alarm.
  void reject_again() {
    if (!learner_.classifier()) return;
    std::size_t added = 0;
    for (std::size_t i = 0; i < frames_.size(); ++i)
      for (const PersonHypothesis& h : learner_.find(frames_[i]))
        if (h.prediction.probability >= options_.likely_negative &&
            best_match(h.box, truth_[i]).overlap < options_.none_overlap) {
          learner_.add(frames_[i], h.box, false);
          ++added;
        }
    if (added > 0) (void)learner_.learn();
  }

 private:
  [[nodiscard]] Match match_of(std::size_t q) const {
    return best_match(all_[q].box, truth_[frame_of_[q]]);
  }
  void answer(std::size_t q, PersonRound& total) {
    const Match match = match_of(q);
    const PeopleFrame& frame = frames_[frame_of_[q]];
    if (match.overlap >= options_.same_overlap) {
      const bool sloppy = match.overlap < options_.good_overlap;
      total.clicks += sloppy ? 1 : 0;
      total.put_right += sloppy ? 1 : 0;
      learner_.add(frame, sloppy ? match.box : all_[q].box, true);
    } else if (match.overlap < options_.none_overlap) {
      learner_.add(frame, all_[q].box, false);
    }
  }

  const std::vector<PeopleFrame>& frames_;
  const std::vector<std::vector<TruePerson>>& truth_;
  const PersonOracleOptions& options_;
  PersonLearner& learner_;
  std::vector<PersonHypothesis> all_;
  std::vector<std::size_t> frame_of_;  ///< of each hypothesis
  std::vector<bool> asked_;            ///< of each hypothesis
  std::vector<bool> again_;            ///< of each frame: learnt in an earlier round
  std::vector<std::pair<std::size_t, PersonBox>> drawn_;  ///< frame and person
};

}  // namespace

PersonRound play_person_round(const std::vector<PeopleFrame>& frames,
                              const std::vector<std::vector<TruePerson>>& truth,
                              const PersonOracleOptions& options,
                              PersonLearner& learner,
                              PersonRound total) {
  PersonTurn turn(frames, truth, options, learner);
  const PersonScore sum = turn.find();
  turn.draw(total);
  turn.answer_questions(total);
  turn.reject_rest(total);
  turn.learn();
  turn.reject_again();
  total.people = sum.people;
  total.precision = sum.precision();
  total.recall = sum.recall();
  return total;
}

}  // namespace roadbook
