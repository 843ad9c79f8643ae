#include "mapping/landmark_weights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/index.hpp"
#include "base/median.hpp"

namespace roadbook {
namespace {

// Chances to be seen by a session, and how many landmarks have each. Landmarks that are seldom seen
// cannot be distinguished from landmarks that have gone, and both are of no use.
constexpr std::array<double, 3> kChances{0.65, 0.8, 0.95};
constexpr std::array<double, 3> kShares{0.2, 0.4, 0.4};
constexpr double kGoes = 0.1;              // between two sessions
constexpr double kComesBack = 0.03;        // the same
constexpr double kSeenThoughGone = 0.005;  // another thing with the same look at its place
constexpr double kFullChance = 0.25;       // of the median number of images: enough to be seen

// The evidence of one session about one landmark.
struct Evidence {
  bool seen = false;
  double share = 1.0;  // of a full chance to see it
};
using History = std::vector<Evidence>;

double chance_of(const Evidence& evidence, double chance) {
  const double unseen = std::pow(1.0 - chance, evidence.share);
  return evidence.seen ? 1.0 - unseen : unseen;
}

double chance_if_gone(const Evidence& evidence) {
  return evidence.seen ? kSeenThoughGone : 1.0 - kSeenThoughGone;
}

// The forward sum over all paths of the two states, for each chance.
double weight_of(const History& history) {
  double all_there = 0.0;
  double all_gone = 0.0;
  for (std::size_t c = 0; c < kChances.size(); ++c) {
    double there = 1.0;  // its own session saw it
    double gone = 0.0;
    for (const Evidence& evidence : history) {
      const double still = there * (1.0 - kGoes) + gone * kComesBack;
      const double no_more = there * kGoes + gone * (1.0 - kComesBack);
      there = still * chance_of(evidence, kChances[c]);
      gone = no_more * chance_if_gone(evidence);
    }
    all_there += kShares[c] * there;
    all_gone += kShares[c] * gone;
  }
  return all_there / (all_there + all_gone);
}

std::vector<History> histories_of(const Map& map) {
  std::vector<double> images;
  for (const LandmarkSession& row : map.landmark_sessions)
    if (row.expected > 0) images.push_back(row.expected);
  std::vector<History> histories(map.landmarks.size());
  if (images.empty()) return histories;
  const double enough = std::max(1.0, kFullChance * median(images));
  for (const LandmarkSession& row : map.landmark_sessions) {
    if (row.expected == 0) continue;
    const double share = std::min(1.0, static_cast<double>(row.expected) / enough);
    histories[at(row.landmark)].push_back({row.seen > 0, share});
  }
  return histories;
}

}  // namespace

std::vector<double> landmark_weights(const Map& map) {
  std::vector<double> weights;
  for (const History& history : histories_of(map))
    weights.push_back(history.empty() ? 1.0 : weight_of(history));
  return weights;
}

}  // namespace roadbook
