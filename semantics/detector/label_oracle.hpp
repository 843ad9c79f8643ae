#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "semantics/detector/box_learner.hpp"

namespace roadbook {

// Simulated labeller who knows the truth: plays rounds of active learning and counts their cost.
// Source: [metric-semantic maps, section V-A.2, Fig. 7].

struct OracleOptions {
  BoxLearnerOptions learner;
  int rounds = 6;
  int first_boxes = 6;         ///< drawn before the first round; may be 0 with `start`
  int boxes_a_round = 2;       ///< drawn after each round: missed things
  int max_boxes = 14;          ///< largest total of drawn boxes
  int questions_a_round = 20;  ///< hypotheses accepted or rejected, one click each
  double same_overlap = 0.5;   ///< intersection over union of a right hypothesis
  double good_overlap = 0.75;  ///< below: a right hypothesis is corrected, one more click
  double near_overlap = 0.25;  ///< above: corrected as well; below: rejected
  std::uint64_t seed = 1;      ///< of the order in which things are drawn
  BoxExamples start;           ///< examples from another place; may be empty
  /// Called after each round's training and search.
  std::function<void(const BoxLearner&)> after_round;

  /// Throws InvalidOption.
  void check() const;
};

/// Precision, recall and F1 of found boxes.
struct BoxScore {
  double precision = 0.0;  ///< 0 if nothing was found
  double recall = 0.0;
  double f1 = 0.0;
};

/// Scores found boxes after one-to-one matching by overlap (`match_boxes`).
[[nodiscard]] BoxScore score_boxes(const std::vector<OrientedBox>& found,
                                   const std::vector<OrientedBox>& truth,
                                   double min_overlap);

struct OracleRound : BoxScore {
  int drawn = 0;      ///< boxes drawn, total
  int put_right = 0;  ///< hypotheses corrected to the true box, total
  int clicks = 0;     ///< total: one for each answer, one more for each correction
  std::size_t found = 0;
  double seconds = 0.0;      ///< time of this round's training and search
  std::string classifier{};  ///< GpClassifier::digest; empty if training was not possible
};

struct OracleResult {
  std::vector<OracleRound> rounds;
  std::vector<OrientedBox> found;  ///< after the last round
  /// Mean F1 over the number of labels given (drawn and clicked), from the first to the last round.
  [[nodiscard]] double area_under_curve() const;
};

/// Plays all rounds. `truth`: all things; those not visible in `image` count as missed.
[[nodiscard]] OracleResult play_oracle(const GroundImage& image,
                                       const std::vector<OrientedBox>& truth,
                                       const OracleOptions& options);

}  // namespace roadbook
