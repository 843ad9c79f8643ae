#pragma once

#include <cstdint>
#include <vector>

#include "semantics/box_learner.hpp"

namespace roadbook {

// A labeller who knows the truth and makes no mistakes: plays the rounds of document 004, V-A.2
// (Fig. 7), and counts what each costs.

struct OracleOptions {
  BoxLearnerOptions learner;
  int rounds = 6;
  int first_boxes = 6;         ///< drawn before the first round
  int boxes_a_round = 2;       ///< drawn after each: things that were missed
  int max_boxes = 14;          ///< drawn in all
  int questions_a_round = 20;  ///< hypotheses accepted or rejected, one click each
  double same_overlap = 0.5;   ///< intersection over union that makes a hypothesis right
  double good_overlap = 0.75;  ///< below it a right hypothesis is put right, a click more
  double near_overlap = 0.25;  ///< as is one that is half on a thing; below it is rejected
  std::uint64_t seed = 1;      ///< which things are drawn

  /// Throws InvalidOption.
  void check() const;
};

struct OracleRound {
  int drawn = 0;   ///< boxes so far
  int clicks = 0;  ///< hypotheses answered so far
  double precision = 0.0;
  double recall = 0.0;
  double f1 = 0.0;
  std::size_t found = 0;
  double seconds = 0.0;  ///< training and search of this round
};

struct OracleResult {
  std::vector<OracleRound> rounds;
  std::vector<OrientedBox> found;  ///< after the last round
  /// Mean of f1 over labels given (drawn and clicked) from the first round to the last.
  [[nodiscard]] double area_under_curve() const;
};

/// `truth`: all things there are; those that were not seen in `image` count as missed.
[[nodiscard]] OracleResult play_oracle(const GroundImage& image,
                                       const std::vector<OrientedBox>& truth,
                                       const OracleOptions& options);

}  // namespace roadbook
