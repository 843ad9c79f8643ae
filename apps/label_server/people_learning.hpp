#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "apps/label_server/http/event_hub.hpp"
#include "apps/label_server/label_service.hpp"
#include "apps/label_server/round_worker.hpp"
#include "workflows/labels/people_images.hpp"
#include "workflows/labels/people_record.hpp"

namespace roadbook {

/// Learns to detect people from the users' answers about windows of images, in a separate thread. A
/// round trains on all known examples (people_training.hpp) and searches images that were not
/// searched before. Then it orders the images by how useful an answer about them is. Safe to use
/// from several threads.
class PeopleLearning {
 public:
  /// `known` has examples in addition to the labels of the service. Pointers must outlive the
  /// object. Learning resumes from `record`. The object calls `keep` after each round, in the
  /// thread of the round.
  PeopleLearning(const PeopleImages* images,
                 const LabelService* service,
                 EventHub* hub,
                 PersonExamples known,
                 const PersonLearnerOptions& options,
                 PeopleRecord record = {},
                 std::function<void(const PeopleRecord&)> keep = {});

  /// Starts a round. If a round is running, another one follows. Throws RequestError 422 if there
  /// is no positive or no negative example yet.
  void start();

  /// Returns the images to label, the most useful first, and the progress.
  [[nodiscard]] nlohmann::json overview() const;
  /// Returns the open questions of one image, as far as a classifier exists. Throws RequestError
  /// 404.
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
  const LabelService* service_;
  PersonExamples known_;
  PersonLearnerOptions options_;
  std::function<void(const PeopleRecord&)> keep_;

  mutable std::mutex mutex_;
  PeopleRecord record_;
  mutable std::shared_ptr<const GpClassifier> classifier_;
  RoundWorker worker_;  ///< last member: its thread must end before the other members are destroyed
};

}  // namespace roadbook
