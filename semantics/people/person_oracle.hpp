#pragma once

#include <functional>
#include <vector>

#include "semantics/people/person_learner.hpp"

namespace roadbook {

// Simulated labeller who knows the truth. Each round uses frames that were not seen before, so
// precision and recall of a round are those of new images.

/// A true person in one camera's image.
struct TruePerson {
  PersonBox box;
  bool clear = true;  ///< in range and visible: must be found; other people count neither way
};

struct PersonOracleOptions {
  int first_boxes = 8;    ///< largest number of boxes drawn in the first round
  int boxes_a_round = 4;  ///< largest number drawn in a later round: missed people
  int questions_a_round = 20;
  double same_overlap = 0.5;  ///< intersection over union of a right hypothesis
  double good_overlap = 0.8;  ///< a right hypothesis with less overlap is corrected, one more click
  double none_overlap = 0.2;  ///< below: the hypothesis is wrong; between the two: skipped
  double min_probability = 0.5;
  double likely_negative = 0.1;  ///< wrong hypotheses below it are not kept as examples
};

/// Result of a round: scores on its new frames before training on them, and running totals.
struct PersonRound {
  int drawn = 0;           ///< boxes drawn, total
  int put_right = 0;       ///< hypotheses corrected, total
  int clicks = 0;          ///< total: one for each answer, one more for each correction
  std::size_t people = 0;  ///< clear people in these frames, counted in each image
  double precision = 0.0;
  double recall = 0.0;
};

/// Counts of detections against the truth, by greedy matching in order of probability. Detections
/// of people who are not clear are not counted.
struct PersonScore {
  std::size_t people = 0;
  std::size_t right = 0;
  std::size_t wrong = 0;
  [[nodiscard]] double precision() const;
  [[nodiscard]] double recall() const;
};
[[nodiscard]] PersonScore score_people(const std::vector<PersonHypothesis>& found,
                                       const std::vector<TruePerson>& truth,
                                       const PersonOracleOptions& options);

/// Plays one round over new frames: search, draw missed people, answer questions, say "nobody else
/// here" (one click per frame), add random negatives, train. Then search the same frames again, add
/// false detections as negatives, and train again. Answers in frames that the learner already knows
/// do not enter the prior of searches. `total` carries the running totals from round to round.
PersonRound play_person_round(const std::vector<PeopleFrame>& frames,
                              const std::vector<std::vector<TruePerson>>& truth,
                              const PersonOracleOptions& options,
                              PersonLearner& learner,
                              PersonRound total);

}  // namespace roadbook
