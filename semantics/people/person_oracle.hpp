#pragma once

#include <functional>
#include <vector>

#include "semantics/people/person_learner.hpp"

namespace roadbook {

// A labeller who knows where everybody is and makes no mistakes: each round brings frames that were
// not seen before, so that what a round says of precision and recall is said of new images.

/// Somebody as one camera has them.
struct TruePerson {
  PersonBox box;
  bool clear = true;  ///< in range and in sight: must be found; others may be
};

struct PersonOracleOptions {
  int first_boxes = 8;    ///< drawn in the first frames
  int boxes_a_round = 4;  ///< drawn later: people who were missed
  int questions_a_round = 20;
  double same_overlap = 0.5;  ///< intersection over union that makes a hypothesis right
  double good_overlap = 0.8;  ///< below it a right hypothesis is put right, a click more
  double none_overlap = 0.2;  ///< below it a hypothesis is wrong; between them it is skipped
  double min_probability = 0.5;
  double likely_negative = 0.1;  ///< hypotheses below it teach too little to be kept as examples
};

/// What a round's new frames brought, before its answers.
struct PersonRound {
  int drawn = 0;           ///< boxes so far
  int put_right = 0;       ///< hypotheses so far that were moved onto their person
  int clicks = 0;          ///< so far: a hypothesis answered, one that is put right a second
  std::size_t people = 0;  ///< in these frames, image by image
  double precision = 0.0;
  double recall = 0.0;
};

/// Counts of a search against the truth. Greedy, the likeliest first; hypotheses on somebody who is
/// not clear count for nothing.
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

/// One round of the loop over new frames: search, draw who was missed, answer questions, "nobody
/// else here" (a click a frame), random negatives, learn; then what the new classifier takes for
/// somebody in the same frames, where nobody else is, and learn again. Frames that the learner
/// knows are played like others, but answers about them tell nothing of searches. `total` carries
/// boxes and clicks from round to round.
PersonRound play_person_round(const std::vector<PeopleFrame>& frames,
                              const std::vector<std::vector<TruePerson>>& truth,
                              const PersonOracleOptions& options,
                              PersonLearner& learner,
                              PersonRound total);

}  // namespace roadbook
