#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "semantics/window_search.hpp"

namespace roadbook {

// Learns what a person draws (document 004, V-A.2): from a few boxes on the picture of the ground
// to hypotheses of all others, better with each one that is accepted or rejected.

enum class NegativePolicy {
  kRandom,   ///< boxes anywhere at several scales, the same in every round, and what was rejected
  kRejected  ///< what was rejected alone; random ones only until there are any
};

/// Which hypotheses a person is asked about.
enum class QuestionPolicy {
  kUncertain,  ///< the least sure ones of the classifier, not too near to one another
  kRandom      ///< any
};

struct BoxLearnerOptions {
  NegativePolicy negatives = NegativePolicy::kRandom;
  QuestionPolicy questions = QuestionPolicy::kUncertain;
  std::size_t random_negatives = 200;
  double min_apart_m = 4.0;      ///< of two questions of a round, so that they are diverse
  double min_probability = 0.5;  ///< of a hypothesis that counts as found
  double same_overlap = 0.3;     ///< intersection over union above which two boxes are one
  double rebuild_change = 0.04;  ///< relative change of the mean size that moves the window
  HogWindowOptions window;
  WindowSearchOptions search;
  GpClassifierOptions classifier;
  std::uint64_t seed = 1;

  /// Throws InvalidOption.
  void check() const;
};

class BoxLearner {
 public:
  /// `image` at its own resolution; the learner keeps the coarser one it works on.
  BoxLearner(const GroundImage& image, const BoxLearnerOptions& options);

  /// A box that is right: drawn, or a hypothesis that was accepted.
  void add_positive(const OrientedBox& box);
  /// A hypothesis that was rejected.
  void add_negative(const OrientedBox& box);
  /// Takes an example back: the last one equal to `box`.
  void forget(const OrientedBox& box);

  [[nodiscard]] const std::vector<OrientedBox>& positives() const { return positives_; }
  [[nodiscard]] const std::vector<OrientedBox>& negatives() const { return negatives_; }

  /// Trains on all examples and searches the picture. Without positives there is nothing to learn:
  /// false, and no hypotheses.
  bool learn();
  /// Of the last `learn`, best first: none that is a positive or was rejected.
  [[nodiscard]] const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }
  /// Hypotheses with at least `min_probability`, and the positives: what has been found.
  [[nodiscard]] std::vector<OrientedBox> found() const;
  /// Indices of at most `count` hypotheses to ask about, the most useful first.
  [[nodiscard]] std::vector<std::size_t> questions(std::size_t count) const;
  [[nodiscard]] const std::optional<GpClassifier>& classifier() const { return classifier_; }

  /// Starts from a classifier of another place: hypotheses before anything is drawn. `length_m` and
  /// `width_m` are those it was trained with.
  void start_from(GpClassifier classifier, double length_m, double width_m);

 private:
  void fit_window();
  void search();
  [[nodiscard]] std::vector<OrientedBox> random_boxes() const;
  [[nodiscard]] bool is_known(const OrientedBox& box) const;

  BoxLearnerOptions options_;
  GroundImage full_;
  GroundImage image_;
  std::vector<OrientedBox> positives_;
  std::vector<OrientedBox> negatives_;
  std::optional<HogWindow> window_;
  std::optional<WindowSearch> search_;
  std::optional<GpClassifier> classifier_;
  std::vector<Hypothesis> hypotheses_;
  std::uint64_t round_ = 0;
};

}  // namespace roadbook
