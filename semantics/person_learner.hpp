#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "semantics/person_search.hpp"
#include "semantics/search_prior.hpp"

namespace roadbook {

// Learns people from a few clicks (document 004, VI-B: "the same active learning framework applied
// to the raw camera images"): windows of fisheye images instead of boxes on the ground. Examples
// are kept as features, so that what was learnt in one session serves in the next.

/// Windows that somebody has judged, as features.
struct PersonExamples {
  std::vector<Eigen::VectorXf> features;  ///< of PersonWindow::feature_size()
  std::vector<std::int8_t> labels;        ///< 1: a person, -1: none
  std::vector<SearchAnswer> answers;      ///< of searches, about images that were new to them
  [[nodiscard]] std::size_t size() const { return labels.size(); }
  [[nodiscard]] std::size_t positives() const;
};

/// Adds what a window shows (PersonWindow::patch). A person's mirror image is a person too.
void add_example(const PersonWindow& window,
                 const cv::Mat& crop,
                 bool person,
                 PersonExamples& examples);

/// One instant: an image a camera, empty where there is none.
struct PeopleFrame {
  std::vector<ImagePyramid> images;
};

struct PersonLearnerOptions {
  PersonSearchOptions search;
  GpClassifierOptions classifier{.calibrate = true};
  std::size_t random_negatives = 12;  ///< windows anywhere, of every frame that was looked at
  double min_probability = 0.5;       ///< of a hypothesis that counts as found
  double same_overlap = 0.3;          ///< above it two windows show the same
  int num_threads = 0;                ///< 0: all cores; the result is the same for any
  std::uint64_t seed = 1;

  /// Throws InvalidOption.
  void check() const;
};

class PersonLearner {
 public:
  PersonLearner(const std::vector<PersonCamera>& cameras, const PersonLearnerOptions& options);

  /// Other cameras, of another session; what was learnt stays.
  void set_cameras(const std::vector<PersonCamera>& cameras);
  [[nodiscard]] const std::vector<PersonSearch>& searches() const { return searches_; }
  [[nodiscard]] const PersonExamples& examples() const { return examples_; }
  void start_from(PersonExamples examples) { examples_ = std::move(examples); }

  /// A window that is right or wrong. A person's mirror image is a person too.
  void add(const PeopleFrame& frame, const PersonBox& box, bool person);
  /// Windows anywhere in the frame that overlap none of `not_on`.
  void add_random_negatives(const PeopleFrame& frame, const std::vector<PersonBox>& not_on);
  /// What a hypothesis of the last classifier was found to be in the end, whether or not it becomes
  /// an example: it tells how often searches find somebody.
  void answer(const PersonHypothesis& hypothesis, bool person);
  /// Whether probabilities are those of what a search finds (semantics/search_prior.hpp), until the
  /// next `learn`. Questions and examples are chosen without. The first `from_page` answers are a
  /// source of their own, neither older nor newer than the others.
  void use_prior_of_searches(bool use, std::size_t from_page = 0);
  /// False without examples of both kinds.
  bool learn();
  [[nodiscard]] const std::optional<GpClassifier>& classifier() const { return classifier_; }

  /// Hypotheses of all cameras, each camera's best first; none before anything is learnt.
  [[nodiscard]] std::vector<PersonHypothesis> find(const PeopleFrame& frame) const;
  /// Indices of at most `count` hypotheses, the least sure of the classifier first.
  [[nodiscard]] static std::vector<std::size_t> questions(
      const std::vector<PersonHypothesis>& hypotheses, std::size_t count);

 private:
  PersonLearnerOptions options_;
  PersonWindow window_;
  std::vector<PersonSearch> searches_;
  PersonExamples examples_;
  std::optional<GpClassifier> classifier_;
  std::uint64_t drawn_ = 0;  ///< frames from which random windows were taken
};

}  // namespace roadbook
