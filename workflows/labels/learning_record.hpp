#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "mapping/layers/map_layers.hpp"
#include "semantics/detector/box_learner.hpp"

namespace roadbook {

/// A round of learning and its result.
struct LearningRound {
  int number = 0;
  std::string kind;
  std::int64_t begin_ns = 0;
  double seconds = 0.0;
  std::size_t positives = 0;
  std::size_t negatives = 0;
  std::size_t found = 0;  ///< hypotheses that count as found
  std::size_t fresh = 0;  ///< of them, not found in the previous round
  std::size_t gone = 0;   ///< found in the previous round, now neither found nor labelled
  // For repeating the round (round_replay.hpp). Older records lack these fields.
  std::int64_t event = 0;        ///< the last label event from which the round learnt
  std::string basis{};           ///< digest of its other inputs (round_basis)
  std::string classifier{};      ///< the learnt classifier: GpClassifier::digest
  double window_length_m = 0.0;  ///< of the detector's window in this round
  double window_width_m = 0.0;
};

inline constexpr const char* kLearningTable = "label_learning";  ///< picture, record

/// The result of all rounds so far. It outlives the server in table `label_learning` of the map.
/// Places refer to one overhead image and have no meaning on another image.
struct LearningRecord {
  std::vector<LearningRound> rounds;
  std::vector<Hypothesis> hypotheses;  ///< of the last round, best first
  std::vector<std::size_t> questions;  ///< the questions among them, the most useful first
  double shift = 0.0;  ///< the prior of searches, added to the logit of the probabilities
};

[[nodiscard]] nlohmann::json record_to_json(const LearningRecord& record);
/// Makes the table of a record that belongs to the picture `picture` (`picture_version`).
[[nodiscard]] PlainTable record_table(const std::string& picture, const LearningRecord& record);
/// The contents of the table as text. Empty if the map has no such table.
struct StoredLearning {
  std::string picture;  ///< name of the picture on which it learnt
  std::string record;
};
[[nodiscard]] StoredLearning read_stored_learning(const MapLayers& layers);
/// Empty if the text is not a record. The rounds can then be repeated.
[[nodiscard]] LearningRecord record_from_text(const std::string& text);
/// Returns the record of an earlier server whose rounds used the picture `learnt_on`. The current
/// server shows `picture`. If the two pictures differ, the result has the rounds without their
/// hypotheses.
[[nodiscard]] LearningRecord record_on(const std::string& picture,
                                       const std::string& learnt_on,
                                       const std::string& text);

}  // namespace roadbook
