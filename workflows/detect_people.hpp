#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/messages.hpp"
#include "semantics/people/person_oracle.hpp"
#include "workflows/people/people_detect.hpp"

namespace roadbook {

/// The arguments of `detect_people`.
struct DetectRequest {
  std::filesystem::path map;
  std::vector<std::filesystem::path> drives;  ///< for sessions whose drive has moved
  std::vector<std::string> oracle;            ///< sessions of simulated drives; the truth gives the
                                              ///< answers
  std::vector<std::string> sessions;          ///< sessions to search; empty: all whose drive is
                                              ///< available
  std::filesystem::path from;  ///< another map, whose examples are used too; empty: none
  bool anew = false;           ///< forget examples of earlier runs
  PeopleDetectOptions options;
  /// Examples that users gave in the labelling page of a map.
  std::function<PersonExamples(const std::filesystem::path& map)> taught_examples;
};

/// The detections in one session.
struct SessionDetections {
  std::string session;
  std::size_t detections = 0;
  std::size_t frames = 0;            ///< searched times
  std::optional<PeopleScore> score;  ///< against the truth, if there is one
};

struct DetectResult {
  std::vector<PersonRound> rounds;  ///< of the oracle
  std::size_t examples = 0;
  std::size_t taught = 0;     ///< of these, from the labelling page
  std::size_t positives = 0;  ///< examples that are people
  std::size_t answers = 0;    ///< answers about hypotheses of searches
  double prior_shift = 0.0;   ///< of the logit
  std::vector<SessionDetections> sessions;
  std::string digest;  ///< of the map file afterwards
};

/// Detects people in the images of a map's sessions. Stores them in the map, together with the
/// examples that the oracle gave. Reports rounds and sessions through `messages` as they end.
/// Throws BadInput, InvalidOption, Refused (no examples), StorageError, Interrupted.
[[nodiscard]] DetectResult detect_people(const DetectRequest& request, Messages& messages);

}  // namespace roadbook
