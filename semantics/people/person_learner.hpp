#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "semantics/people/person_examples.hpp"
#include "semantics/people/person_search.hpp"

namespace roadbook {

// Trains a person detector from few clicks, with the same active learning as for boxes on the
// ground. Source: [metric-semantic maps, section VI-B].

/// One instant: one image for each camera, empty if the camera has none.
struct PeopleFrame {
  std::vector<ImagePyramid> images;
  std::string name{};  ///< identifies the instant in later sessions; empty: it will not occur again
};

struct PersonLearnerOptions {
  PersonSearchOptions search;
  GpClassifierOptions classifier{.calibrate = true};
  std::size_t random_negatives = 12;  ///< random background windows per frame
  double min_probability = 0.5;       ///< of a hypothesis that counts as a detection
  double same_overlap = 0.3;          ///< windows with more overlap show the same person
  int num_threads = 0;                ///< 0: all cores; the result does not depend on it
  std::uint64_t seed = 1;

  /// Throws InvalidOption.
  void check() const;
};

class PersonLearner {
 public:
  PersonLearner(const std::vector<PersonCamera>& cameras, const PersonLearnerOptions& options);

  /// Replaces the cameras by those of another session; the examples stay.
  void set_cameras(const std::vector<PersonCamera>& cameras);
  [[nodiscard]] const std::vector<PersonSearch>& searches() const { return searches_; }
  [[nodiscard]] const PersonExamples& examples() const { return examples_; }
  void start_from(PersonExamples examples) { examples_ = std::move(examples); }

  /// Adds a window as an example, a person also as its mirror image. In a frame that is already
  /// known, a repeated example counts once.
  void add(const PeopleFrame& frame, const PersonBox& box, bool person);
  /// Adds random windows of the frame that overlap none of `not_on` as negative examples.
  void add_random_negatives(const PeopleFrame& frame, const std::vector<PersonBox>& not_on);
  /// True if the frame's instant is completely labelled, in this session or an earlier one. Its
  /// detections then say nothing about new images.
  [[nodiscard]] bool knows(const PeopleFrame& frame) const;
  void remember(const PeopleFrame& frame);
  /// Records whether a hypothesis of the last classifier was a person, for the prior of searches.
  /// It does not become an example.
  void answer(const PersonHypothesis& hypothesis, bool person);
  /// With `use`, predicted probabilities include the prior of searches
  /// (semantics/detector/search_prior.hpp) until the next `learn`. Questions and examples are
  /// chosen without it. The first `from_page` answers form a separate source.
  void use_prior_of_searches(bool use, std::size_t from_page = 0);
  /// Trains the classifier. Returns false if examples of one kind are missing.
  bool learn();
  [[nodiscard]] const std::optional<GpClassifier>& classifier() const { return classifier_; }

  /// Detections of all cameras, best first for each camera; empty before `learn` has succeeded.
  [[nodiscard]] std::vector<PersonHypothesis> find(const PeopleFrame& frame) const;
  /// Indices of at most `count` hypotheses, nearest to probability 0.5 first.
  [[nodiscard]] static std::vector<std::size_t> questions(
      const std::vector<PersonHypothesis>& hypotheses, std::size_t count);

 private:
  PersonLearnerOptions options_;
  PersonWindow window_;
  std::vector<PersonSearch> searches_;
  PersonExamples examples_;
  std::optional<GpClassifier> classifier_;
  std::uint64_t drawn_ = 0;  ///< number of frames that gave random negatives
};

}  // namespace roadbook
