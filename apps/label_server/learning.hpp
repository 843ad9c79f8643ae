#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/label_server/http/event_hub.hpp"
#include "apps/label_server/label_service.hpp"
#include "apps/label_server/round_worker.hpp"
#include "semantics/detector/box_learner.hpp"
#include "semantics/detector/box_snap.hpp"
#include "workflows/labels/learning_record.hpp"

namespace roadbook {

/// Runs the learner of the current class in a separate thread. Pages stay responsive during
/// training. They receive an event when there are new hypotheses.
class Learning {
 public:
  /// `service` and `hub` must outlive the object. `taught` has the examples of other places, by
  /// class. Learning resumes from `record`. The object calls `keep` with the new record after each
  /// round, in a separate thread. If `keep` throws, the pages receive the error.
  Learning(const GroundImage& image,
           const BoxLearnerOptions& options,
           const LabelService* service,
           EventHub* hub,
           std::map<std::string, BoxExamples> taught = {},
           LearningRecord record = {},
           std::function<void(const LearningRecord&)> keep = {});
  /// Starts a round for boxes of a class. If a round is running, another one follows. Throws
  /// RequestError 422 if there is no example of the class from this or another place, or if there
  /// is no image to search.
  void start(const std::string& kind);

  /// Returns the unanswered hypotheses of the last round, best first, and the questions among them,
  /// the most useful first.
  [[nodiscard]] nlohmann::json hypotheses() const;
  /// Returns the progress: the answers, the number of open hypotheses, and the rounds with their
  /// results.
  [[nodiscard]] nlohmann::json progress() const;

 private:
  struct Open {
    std::size_t index = 0;  ///< in the round
    Hypothesis hypothesis;
  };
  void run_round(const std::string& kind);
  [[nodiscard]] std::vector<Hypothesis> on_their_lines(std::vector<Hypothesis> hypotheses);
  [[nodiscard]] std::vector<std::size_t> questions_in_sight(
      const std::vector<Hypothesis>& hypotheses) const;
  void take_examples(const std::string& kind, const LearningRecord& record);
  [[nodiscard]] std::string basis_of(const std::string& kind);
  [[nodiscard]] std::vector<Open> open_hypotheses() const;

  GroundImage image_;
  BoxLearnerOptions options_;
  const LabelService* service_;
  std::map<std::string, BoxExamples> taught_;
  std::function<void(const LearningRecord&)> keep_;

  // Only the worker's thread uses these members.
  std::optional<BoxLearner> learner_;
  std::string learner_kind_;
  std::optional<PaintPicture> paint_;
  std::map<std::string, std::string> bases_;  ///< by class; cached, because computing them takes
                                              ///< long for a large picture

  mutable std::mutex mutex_;
  LearningRecord record_;
  RoundWorker worker_;  ///< last member: its thread must end before the other members are destroyed
};

}  // namespace roadbook
