#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "semantics/people/person_examples.hpp"
#include "semantics/people/person_search.hpp"

namespace roadbook {

// Learns people from a few clicks (document 004, VI-B: "the same active learning framework applied
// to the raw camera images"): windows of fisheye images instead of boxes on the ground.

/// One instant: an image a camera, empty where there is none.
struct PeopleFrame {
  std::vector<ImagePyramid> images;
  std::string name{};  ///< the same whenever the instant is looked at; empty: it never is again
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

  /// A window that is right or wrong. A person's mirror image is a person too. What was said of a
  /// known instant before counts once.
  void add(const PeopleFrame& frame, const PersonBox& box, bool person);
  /// Windows anywhere in the frame that overlap none of `not_on`.
  void add_random_negatives(const PeopleFrame& frame, const std::vector<PersonBox>& not_on);
  /// Whether all was said about the frame's instant, in this session or an earlier one: what is
  /// found in it then tells nothing of images that are new.
  [[nodiscard]] bool knows(const PeopleFrame& frame) const;
  void remember(const PeopleFrame& frame);
  /// What a hypothesis of the last classifier was found to be in the end, whether or not it becomes
  /// an example: it tells how often searches find somebody.
  void answer(const PersonHypothesis& hypothesis, bool person);
  /// Whether probabilities are those of what a search finds (semantics/detector/search_prior.hpp),
  /// until the next `learn`. Questions and examples are chosen without. The first `from_page`
  /// answers are a source of their own, neither older nor newer than the others.
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
