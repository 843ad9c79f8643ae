#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "semantics/labels/label_store.hpp"
#include "workflows/labels/people_images.hpp"
#include "workflows/labels/people_record.hpp"

namespace roadbook {

// The result of a round of learning people is a function of its inputs. These are the current
// labels, the examples from elsewhere, the images, and the second looks of earlier rounds. The
// round can therefore be repeated from the map's list of events.

/// Returns the labels of windows in images after the events up to number `event`, by id.
[[nodiscard]] std::vector<Label> image_labels_at(const std::vector<LabelEvent>& events,
                                                 std::int64_t event);

/// Returns the examples of the labels, then the valid false alarms of the second looks, then the
/// other known examples.
[[nodiscard]] PersonExamples people_examples(const std::vector<Label>& labels,
                                             const std::vector<SecondLook>& looks,
                                             const PersonExamples& known);

/// Null if positive or negative examples are missing.
[[nodiscard]] std::shared_ptr<const GpClassifier> people_classifier(
    const PersonExamples& examples, const PersonLearnerOptions& options);

struct PeopleLesson {
  std::shared_ptr<const GpClassifier> classifier;  ///< null if examples are missing
  std::vector<SecondLook> looks;                   ///< of all rounds, including this one
  std::size_t persons = 0;                         ///< positive examples: windows that show a
                                                   ///< person
  std::size_t nobody = 0;
  std::size_t again = 0;  ///< false alarms of this round's second look
};

/// Runs one round: trains, then searches the images that are done a second time
/// (hard_negatives.hpp). If this second look finds false alarms, trains again. `looks` are the
/// second looks of earlier rounds.
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

/// A repeated round.
struct ReplayedRound {
  std::string basis;    ///< of the current inputs
  bool follows = true;  ///< the rounds before it can be repeated too
  /// The digest of its classifier; "" if nothing can be learnt now. Empty if the round cannot be
  /// repeated.
  std::optional<std::string> classifier{};
};

/// Repeats all rounds, because each learns from the second looks of the earlier ones.
[[nodiscard]] std::vector<ReplayedRound> replayed_people(const PeopleImages& images,
                                                         const PersonExamples& known,
                                                         const PersonLearnerOptions& options,
                                                         const std::vector<LabelEvent>& events,
                                                         const std::vector<PeopleRound>& rounds);

}  // namespace roadbook
