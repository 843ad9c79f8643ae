#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "apps/label_server/http/event_hub.hpp"
#include "apps/label_server/label_service.hpp"
#include "apps/label_server/people_images.hpp"
#include "apps/label_server/people_record.hpp"
#include "apps/label_server/round_worker.hpp"

namespace roadbook {

/// Learns people from what the pages say about windows of images, in a thread of its own. A round
/// learns from all that is known (people_lesson.hpp), looks through images that were not seen
/// before, and orders them by how useful an answer about them is. Safe to use from several threads.
class PeopleLearning {
 public:
  /// `known`: examples beside those of the book's labels. Pointers must outlive it. Begins where
  /// `record` stands; `keep` is called after each round, from the round's thread.
  PeopleLearning(const PeopleImages* images,
                 const LabelBook* book,
                 EventHub* hub,
                 PersonExamples known,
                 const PersonLearnerOptions& options,
                 PeopleRecord record = {},
                 std::function<void(const PeopleRecord&)> keep = {});

  /// Begins a round; when one runs, another after it. Throws RequestError 422 where nobody has been
  /// shown yet, or nothing that is nobody.
  void start();

  /// Which images to look at, the most useful first, and how far the work is.
  [[nodiscard]] nlohmann::json overview() const;
  /// One image: what is open in it, as far as anything has been learnt. Throws RequestError 404.
  [[nodiscard]] nlohmann::json image(const LabelAnchor& image) const;

 private:
  void run_round();
  [[nodiscard]] std::shared_ptr<const GpClassifier> learn(PeopleRecord& record,
                                                          PeopleRound& round) const;
  void search_next(const GpClassifier& classifier, PeopleRecord& record, PeopleRound& round) const;
  [[nodiscard]] std::shared_ptr<const GpClassifier> learnt() const;
  [[nodiscard]] std::vector<LabelAnchor> next_images(std::size_t count, std::size_t* next) const;
  [[nodiscard]] std::vector<PersonHypothesis> hypotheses_in(const LabelAnchor& image) const;
  [[nodiscard]] nlohmann::json rounds_json(const std::vector<PeopleRound>& rounds) const;

  const PeopleImages* images_;
  const LabelBook* book_;
  PersonExamples known_;
  PersonLearnerOptions options_;
  std::function<void(const PeopleRecord&)> keep_;

  mutable std::mutex mutex_;
  PeopleRecord record_;
  mutable std::shared_ptr<const GpClassifier> classifier_;
  RoundWorker worker_;  ///< last: its thread ends before the rest goes
};

}  // namespace roadbook
