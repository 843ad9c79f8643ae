#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/label_server/event_hub.hpp"
#include "apps/label_server/label_book.hpp"
#include "semantics/box_learner.hpp"

namespace roadbook {

/// The learner of the class that is worked on, in a thread of its own: pages stay quick while it
/// trains, and are told when there are new hypotheses.
class Learning {
 public:
  /// `book` and `hub` must outlive it.
  Learning(const GroundImage& image,
           const BoxLearnerOptions& options,
           const LabelBook* book,
           EventHub* hub);
  /// Waits for a round that runs.
  ~Learning();
  Learning(const Learning&) = delete;
  Learning& operator=(const Learning&) = delete;

  /// Begins a round for boxes of a class; when one runs, another after it. Throws RequestError 422
  /// where nothing of the class has been drawn yet.
  void start(const std::string& kind);

  /// Hypotheses of the last round that nothing is known about yet, best first, and which of them to
  /// ask about, the most useful first.
  [[nodiscard]] nlohmann::json hypotheses() const;
  /// How far the work is: answers, how many are left, the rounds and what each taught.
  [[nodiscard]] nlohmann::json progress() const;

 private:
  struct Round {
    int number = 0;
    std::string kind;
    std::int64_t begin_ns = 0;
    double seconds = 0.0;
    std::size_t positives = 0;
    std::size_t negatives = 0;
    std::size_t found = 0;  ///< hypotheses that count as found
    std::size_t fresh = 0;  ///< of them, not found by the round before
    std::size_t gone = 0;   ///< found by the round before, now neither found nor known
  };
  struct Open {
    std::size_t index = 0;  ///< in the round
    Hypothesis hypothesis;
  };
  void work();
  void run_round(const std::string& kind);
  void take_examples(const std::string& kind);
  [[nodiscard]] std::vector<Open> open_hypotheses() const;

  GroundImage image_;
  BoxLearnerOptions options_;
  const LabelBook* book_;
  EventHub* hub_;

  // Of the thread alone.
  std::optional<BoxLearner> learner_;
  std::string learner_kind_;

  mutable std::mutex mutex_;
  std::condition_variable wanted_changed_;
  std::optional<std::string> wanted_;
  bool running_ = false;
  bool ending_ = false;
  std::vector<Round> rounds_;
  std::vector<Hypothesis> hypotheses_;
  std::vector<std::size_t> questions_;
  std::thread thread_;
};

}  // namespace roadbook
