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
#include "apps/label_server/learning_record.hpp"
#include "apps/label_server/round_worker.hpp"
#include "semantics/detector/box_learner.hpp"
#include "semantics/detector/box_snap.hpp"

namespace roadbook {

/// Runs the learner of the current class in a separate thread. Pages stay responsive during
/// training. They receive an event when there are new hypotheses.
class Learning {
 public:
  /// `book` and `hub` must outlive the object. `taught` has the examples of other places, by class.
  /// Learning resumes from `record`. The object calls `keep` with the new record after each round,
  /// in a separate thread. If `keep` throws, the pages receive the error.
  Learning(const GroundImage& image,
           const BoxLearnerOptions& options,
           const LabelBook* book,
           EventHub* hub,
           std::map<std::string, BoxExamples> taught = {},
           LearningRecord record = {},
           std::function<void(const LearningRecord&)> keep = {});
  /// Begins a round for boxes of a class; when one runs, another after it. Throws RequestError 422
  /// where nothing of the class has been drawn yet, here or in another place that it was given, or
  /// there is no image to find anything in.
  void start(const std::string& kind);

  /// Hypotheses of the last round that nothing is known about yet, best first, and which of them to
  /// ask about, the most useful first.
  [[nodiscard]] nlohmann::json hypotheses() const;
  /// How far the work is: answers, how many are left, the rounds and what each taught.
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
  const LabelBook* book_;
  std::map<std::string, BoxExamples> taught_;
  std::function<void(const LearningRecord&)> keep_;

  // Of the thread alone.
  std::optional<BoxLearner> learner_;
  std::string learner_kind_;
  std::optional<PaintPicture> paint_;
  std::map<std::string, std::string> bases_;  ///< by class: of a large picture each takes a while

  mutable std::mutex mutex_;
  LearningRecord record_;
  RoundWorker worker_;  ///< last: its thread ends before the rest goes
};

}  // namespace roadbook
