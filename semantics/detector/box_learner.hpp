#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "semantics/detector/search_prior.hpp"
#include "semantics/detector/window_search.hpp"

namespace roadbook {

// Learns what a person draws (document 004, V-A.2): from a few boxes on the picture of the ground
// to hypotheses of all others, better with each one that is accepted or rejected.

/// What counts as none. The document tells of both: random places (V-A.2), and rejected hypotheses
/// alone, "thus at epoch 1 there is only one negative: the vector 0" (VI-A).
enum class NegativePolicy {
  kRandom,   ///< boxes anywhere at several scales, the same in every round, and what was rejected
  kRejected  ///< what was rejected, and the vector 0: a window without any gradient
};

/// Which hypotheses a person is asked about.
enum class QuestionPolicy {
  kTelling,    ///< those whose answers make all others surest
               ///< (semantics/detector/question_choice.hpp)
  kUncertain,  ///< the least sure ones of the classifier, not too near to one another
  kRandom      ///< any
};

/// What a learner has been taught, without its pictures: it serves in another place. Boxes of that
/// place count by their gradients relative to their own size.
struct BoxExamples {
  double length_m = 0.0;  ///< mean box that was right
  double width_m = 0.0;
  Eigen::MatrixXf features;  ///< an example a row, of a HogWindow of those sides
  std::vector<int> labels;   ///< 1 or -1
  [[nodiscard]] bool empty() const { return labels.empty(); }
};

struct BoxLearnerOptions {
  NegativePolicy negatives = NegativePolicy::kRandom;
  QuestionPolicy questions = QuestionPolicy::kTelling;
  std::size_t random_negatives = 200;
  double min_apart_m = 4.0;      ///< of two of the least sure of a round, so that they are diverse
  double min_probability = 0.5;  ///< of what counts as found, before the prior of searches
  double same_overlap = 0.3;     ///< intersection over union above which two boxes are one
  double rebuild_change = 0.04;  ///< relative change of the mean size that moves the window
  HogWindowOptions window;
  WindowSearchOptions search;
  GpClassifierOptions classifier{.calibrate = true};
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
  /// In place of all that was added.
  void set_examples(std::vector<OrientedBox> positives, std::vector<OrientedBox> negatives);

  [[nodiscard]] const std::vector<OrientedBox>& positives() const { return positives_; }
  [[nodiscard]] const std::vector<OrientedBox>& negatives() const { return negatives_; }

  /// The window that the next training goes on with, where its sides are still near those of the
  /// examples (`rebuild_change`): as a learner that had come to it by earlier rounds would. [m]
  void begin_window(double length_m, double width_m);
  /// Length and width of the window; empty before there is one. [m]
  [[nodiscard]] std::optional<Eigen::Vector2d> window_sides() const;

  /// Trains on all examples; false where there is nothing to learn.
  bool train();
  /// Trains on all examples and searches the picture. Without positives, here or of another place,
  /// there is nothing to learn: false, and no hypotheses.
  bool learn();
  /// Of the last `learn`, best first: none that is a positive or was rejected. Probabilities are of
  /// what a search finds, as far as answers have told (semantics/detector/search_prior.hpp).
  [[nodiscard]] const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }
  /// Hypotheses as likely as `min_probability` among the examples, and the positives.
  [[nodiscard]] std::vector<OrientedBox> found() const;
  /// Indices of at most `count` hypotheses to ask about, the most useful first.
  [[nodiscard]] std::vector<std::size_t> questions(std::size_t count) const;
  [[nodiscard]] const std::optional<GpClassifier>& classifier() const { return classifier_; }

  /// What was said about a hypothesis of the last `learn`, whatever becomes an example: it tells
  /// how often a search is right.
  void answer(std::size_t hypothesis, bool right);
  [[nodiscard]] const std::vector<SearchAnswer>& answers() const { return answers_; }

  /// Begins with what was taught elsewhere: hypotheses before anything is drawn here. Throws
  /// InvalidOption for examples of another kind of window.
  void start_from(BoxExamples examples);
  /// Collects the examples without learning from them; false where there is nothing to learn.
  bool gather();
  /// All that the last `learn` or `gather` was taught: from elsewhere, drawn, answered, random
  /// negatives.
  [[nodiscard]] const BoxExamples& examples() const { return examples_; }

 private:
  void fit_window();
  void collect_examples();
  [[nodiscard]] Eigen::MatrixXd features_of(const std::vector<OrientedBox>& boxes) const;
  void search();
  [[nodiscard]] std::vector<std::size_t> telling(std::size_t count) const;
  [[nodiscard]] std::vector<OrientedBox> random_boxes() const;
  [[nodiscard]] bool is_known(const OrientedBox& box) const;

  BoxLearnerOptions options_;
  GroundImage full_;
  GroundImage image_;
  std::vector<OrientedBox> positives_;
  std::vector<OrientedBox> negatives_;
  BoxExamples before_;    ///< of other places
  BoxExamples examples_;  ///< of the last round, those of other places first
  std::optional<HogWindow> window_;
  std::optional<WindowSearch> search_;
  std::optional<GpClassifier> classifier_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<SearchAnswer> answers_;
  std::uint64_t round_ = 0;
};

}  // namespace roadbook
