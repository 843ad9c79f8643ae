#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/label_server/people_images.hpp"
#include "apps/label_server/people_record.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {

// What a round of learning people learns is a function of the labels as they stand, of what was
// learnt elsewhere, of the images, and of what earlier rounds saw at their second looks: it can be
// played again from the map's list of events.

/// Labels of windows in images after the events up to that number, by id.
[[nodiscard]] std::vector<Label> image_labels_at(const std::vector<LabelEvent>& events,
                                                 std::int64_t event);

/// Returns the examples of the labels, then the valid false alarms of the second looks, then the
/// other known examples.
[[nodiscard]] PersonExamples people_examples(const std::vector<Label>& labels,
                                             const std::vector<SecondLook>& looks,
                                             const PersonExamples& known);

/// Null without examples of both kinds.
[[nodiscard]] std::shared_ptr<const GpClassifier> people_classifier(
    const PersonExamples& examples, const PersonLearnerOptions& options);

struct PeopleLesson {
  std::shared_ptr<const GpClassifier> classifier;  ///< null where there is nothing to learn
  std::vector<SecondLook> looks;                   ///< of all rounds, this one too
  std::size_t persons = 0;                         ///< positive examples: windows that show a
                                                   ///< person
  std::size_t nobody = 0;
  std::size_t again = 0;  ///< false alarms of this round's second look
};

/// Runs one round: trains, then searches the images that are done a second time (second_look.hpp).
/// If this second look finds false alarms, trains again. `looks` are the second looks of earlier
/// rounds.
[[nodiscard]] PeopleLesson learn_people(const PeopleImages& images,
                                        const std::vector<Label>& labels,
                                        const PersonExamples& known,
                                        std::vector<SecondLook> looks,
                                        const PersonLearnerOptions& options);

/// Returns a name (digest) of a round's inputs other than the labels. These inputs are the other
/// known examples and, for each session with images that are done, the drive, the cameras and
/// whether the drive is available.
[[nodiscard]] std::string people_basis(const PeopleImages& images,
                                       const std::vector<Label>& labels,
                                       const PersonExamples& known);

/// A round played again.
struct ReplayedRound {
  std::string basis;    ///< of the current inputs
  bool follows = true;  ///< the rounds before it could be played again too
  /// Its digest, "" where nothing is learnt now; empty where it cannot be played again.
  std::optional<std::string> classifier{};
};

/// All of them: each learns from the second looks of those before it.
[[nodiscard]] std::vector<ReplayedRound> replayed_people(const PeopleImages& images,
                                                         const PersonExamples& known,
                                                         const PersonLearnerOptions& options,
                                                         const std::vector<LabelEvent>& events,
                                                         const std::vector<PeopleRound>& rounds);

}  // namespace roadbook
