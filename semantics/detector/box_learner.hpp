#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "semantics/detector/search_prior.hpp"
#include "semantics/detector/window_search.hpp"

namespace roadbook {

// Active learning of boxes on the overhead image: from a few drawn boxes to hypotheses of all
// others, improved by each accepted or rejected hypothesis. Source: [metric-semantic maps, section
// V-A.2].

/// Source of negative examples. The paper describes both: random positions (section V-A.2), and
/// only rejected hypotheses, "thus at epoch 1 there is only one negative: the vector 0" (section
/// VI-A).
enum class NegativePolicy {
  kRandom,   ///< random boxes at several scales, equal in every round, and rejected hypotheses
  kRejected  ///< rejected hypotheses, and the vector 0: a window without any gradient
};

/// Strategy for choosing the hypotheses that a person is asked about.
enum class QuestionPolicy {
  kTelling,    ///< largest expected variance reduction (semantics/detector/question_choice.hpp)
  kUncertain,  ///< probability nearest to 0.5, at least `min_apart_m` apart
  kRandom      ///< random
};

/// Training examples without images, to be used on another place. Features are relative to the size
/// of the box, so boxes of another size match.
struct BoxExamples {
  double length_m = 0.0;  ///< mean size of the positive boxes
  double width_m = 0.0;
  Eigen::MatrixXf features;  ///< one example per row: features of a HogWindow with those sides
  std::vector<int> labels;   ///< 1: positive, -1: negative
  [[nodiscard]] bool empty() const { return labels.empty(); }
};

struct BoxLearnerOptions {
  NegativePolicy negatives = NegativePolicy::kRandom;
  QuestionPolicy questions = QuestionPolicy::kTelling;
  std::size_t random_negatives = 200;
  double min_apart_m = 4.0;      ///< smallest distance between two questions of kUncertain
  double min_probability = 0.5;  ///< of a detection; applied without the prior of searches
  double same_overlap = 0.3;     ///< boxes with a larger intersection over union are the same
  double rebuild_change = 0.04;  ///< relative change of the mean size that resizes the window
  HogWindowOptions window;
  WindowSearchOptions search;
  GpClassifierOptions classifier{.calibrate = true};
  std::uint64_t seed = 1;

  /// Throws InvalidOption.
  void check() const;
};

class BoxLearner {
 public:
  /// `image` at full resolution; the learner keeps it and a coarser copy on which it works.
  BoxLearner(const GroundImage& image, const BoxLearnerOptions& options);

  /// Adds a positive example: a drawn box or an accepted hypothesis.
  void add_positive(const OrientedBox& box);
  /// Adds a negative example: a rejected hypothesis.
  void add_negative(const OrientedBox& box);
  /// Replaces all examples added here.
  void set_examples(std::vector<OrientedBox> positives, std::vector<OrientedBox> negatives);

  [[nodiscard]] const std::vector<OrientedBox>& positives() const { return positives_; }
  [[nodiscard]] const std::vector<OrientedBox>& negatives() const { return negatives_; }

  /// Sets the size of the window [m]. The next training keeps it if the examples' mean size is
  /// within `rebuild_change`; a restarted learner then continues with the same window.
  void begin_window(double length_m, double width_m);
  /// Length and width of the window [m]; empty before it is set.
  [[nodiscard]] std::optional<Eigen::Vector2d> window_sides() const;

  /// Trains on all examples. Returns false if positive or negative examples are missing.
  bool train();
  /// Trains on all examples and searches the image. Returns false without hypotheses if there are
  /// no positives, neither here nor from another place.
  bool learn();
  /// Hypotheses of the last `learn`, best first, without those that overlap a positive or a
  /// rejected box. Their probabilities include the prior of searches learnt from the answers
  /// (semantics/detector/search_prior.hpp).
  [[nodiscard]] const std::vector<Hypothesis>& hypotheses() const { return hypotheses_; }
  /// The positives, and hypotheses whose probability without that prior is at least
  /// `min_probability`.
  [[nodiscard]] std::vector<OrientedBox> found() const;
  /// Indices of at most `count` hypotheses to ask about, the most useful first.
  [[nodiscard]] std::vector<std::size_t> questions(std::size_t count) const;
  [[nodiscard]] const std::optional<GpClassifier>& classifier() const { return classifier_; }

  /// Records whether a hypothesis of the last `learn` was right, for the prior of searches. It does
  /// not become an example.
  void answer(std::size_t hypothesis, bool right);
  [[nodiscard]] const std::vector<SearchAnswer>& answers() const { return answers_; }

  /// Starts with examples from another place, so hypotheses exist before anything is drawn here.
  /// Throws InvalidOption if the examples belong to another kind of window.
  void start_from(BoxExamples examples);
  /// Collects the examples without training. Returns false if there are no positives.
  bool gather();
  /// Examples of the last `learn` or `gather`: from another place, drawn, answered, random
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
  BoxExamples before_;    ///< examples from another place
  BoxExamples examples_;  ///< all examples of the last round, `before_` first
  std::optional<HogWindow> window_;
  std::optional<WindowSearch> search_;
  std::optional<GpClassifier> classifier_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<SearchAnswer> answers_;
  std::uint64_t round_ = 0;
};

}  // namespace roadbook
