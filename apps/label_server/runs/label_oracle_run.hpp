#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "apps/console.hpp"
#include "semantics/detector/box_learner.hpp"

namespace roadbook {

/// A labeller who knows the truth of a simulated drive, in place of the page.
struct OracleRequest {
  std::filesystem::path map;    ///< with an overhead image
  std::filesystem::path drive;  ///< simulated, with its `truth/`; a session of the map
  QuestionPolicy questions = QuestionPolicy::kTelling;
  NegativePolicy negatives = NegativePolicy::kRandom;
  std::filesystem::path classifier;  ///< map of another place whose labels come first; may be empty
  std::uint64_t seed = 1;
  int num_threads = 0;
};

/// Plays the rounds of `play_oracle` for the parking spaces, says and prints what each cost and
/// gave (design.md: `rounds`, a list of `drawn`, `clicks`, `precision`, `recall`). The map is not
/// changed. Throws BadInput.
void run_oracle(const OracleRequest& request, Console& console);

/// Policies by their names in `--questions` (telling, uncertain, random) and `--negatives` (random,
/// rejected). Throw InvalidOption.
[[nodiscard]] QuestionPolicy question_policy(const std::string& name);
[[nodiscard]] NegativePolicy negative_policy(const std::string& name);

}  // namespace roadbook
