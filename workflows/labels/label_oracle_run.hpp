#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/messages.hpp"
#include "semantics/detector/box_learner.hpp"

namespace roadbook {

/// The arguments of a simulated labeller, which knows the truth of a simulated drive and replaces
/// the page.
struct OracleRequest {
  std::filesystem::path map;    ///< with an overhead image
  std::filesystem::path drive;  ///< simulated, with its `truth/`; a session of the map
  QuestionPolicy questions = QuestionPolicy::kTelling;
  NegativePolicy negatives = NegativePolicy::kRandom;
  std::filesystem::path classifier;  ///< map of another place whose labels the detector uses first;
                                     ///< may be empty
  std::uint64_t seed = 1;
  int num_threads = 0;
};

/// Runs the rounds of `play_oracle` for the parking spaces. A message reports the effort and the
/// result of each round. Returns the result that `--json` prints: `spaces`, `rounds` (a list of
/// `drawn`, `clicks`, `precision`, `recall`), `area_under_curve`. The map does not change. Throws
/// BadInput.
[[nodiscard]] nlohmann::ordered_json run_oracle(const OracleRequest& request,
                                                const Messages& messages);

/// Return the policies with the names in `--questions` (telling, uncertain, random) and
/// `--negatives` (random, rejected). They throw InvalidOption.
[[nodiscard]] QuestionPolicy question_policy(const std::string& name);
[[nodiscard]] NegativePolicy negative_policy(const std::string& name);

}  // namespace roadbook
