#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "semantics/detector/box_learner.hpp"

namespace roadbook {

// A labeller who knows the truth and makes no mistakes: plays the rounds of document 004, V-A.2
// (Fig. 7), and counts what each costs.

struct OracleOptions {
  BoxLearnerOptions learner;
  int rounds = 6;
  int first_boxes = 6;         ///< drawn before the first round; 0 only with a `start`
  int boxes_a_round = 2;       ///< drawn after each: things that were missed
  int max_boxes = 14;          ///< drawn in all
  int questions_a_round = 20;  ///< hypotheses accepted or rejected, one click each
  double same_overlap = 0.5;   ///< intersection over union that makes a hypothesis right
  double good_overlap = 0.75;  ///< below it a right hypothesis is put right, a click more
  double near_overlap = 0.25;  ///< as is one that is half on a thing; below it is rejected
  std::uint64_t seed = 1;      ///< which things are drawn
  BoxExamples start;           ///< taught in another place; may be empty
  /// Called after the learning of each round.
  std::function<void(const BoxLearner&)> after_round;

  /// Throws InvalidOption.
  void check() const;
};

/// How well boxes are found.
struct BoxScore {
  double precision = 0.0;  ///< 0 where nothing is found
  double recall = 0.0;
  double f1 = 0.0;
};

/// One-to-one by overlap: `match_boxes`.
[[nodiscard]] BoxScore score_boxes(const std::vector<OrientedBox>& found,
                                   const std::vector<OrientedBox>& truth,
                                   double min_overlap);

struct OracleRound : BoxScore {
  int drawn = 0;      ///< boxes so far
  int put_right = 0;  ///< hypotheses so far that were moved onto their thing: its box is exact then
  int clicks = 0;     ///< so far: a hypothesis answered, one that is put right a second
  std::size_t found = 0;
  double seconds = 0.0;      ///< training and search of this round
  std::string classifier{};  ///< GpClassifier::digest; empty where nothing could be learnt
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
