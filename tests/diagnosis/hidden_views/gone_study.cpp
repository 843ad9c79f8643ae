#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/random.hpp"
#include "diagnosis/map_changes/removed_landmarks.hpp"
#include "tests/diagnosis/hidden_views/gone_world.hpp"
#include "tests/support/diagnosis_outcome.hpp"

// gone_study nulls|power MAPS SEED. nulls: false regions in maps where nothing is removed, by
// length and density. power: share of removed objects that are found, by the removed share and the
// number of expected redetections.

namespace roadbook::test {
namespace {

constexpr double kDensities[] = {20.0, 40.0, 80.0};
constexpr double kLengths[] = {70.0, 120.0};
constexpr double kShares[] = {0.0, 0.02, 0.05, 0.1, 0.2};
constexpr int kBounds[] = {10, 15, 20, 30, 50};  // landmarks of a thing
constexpr std::size_t kClasses = std::size(kBounds) + 1;

struct Outcome {
  std::size_t places = 0, wrong = 0;
  std::size_t things[kClasses] = {}, named[kClasses] = {};
  double scatter = 0.0, tests = 0.0, landmarks = 0.0;
};

// A region without a removed object within its reach is wrong.
bool is_wrong(const FoundPlace& place, const GoneWorld& world) {
  for (std::size_t t = 0; t < world.gone.size(); ++t)
    if (world.gone[t] && (world.middle[t] - place.middle.head<2>()).norm() < place.reach_m + 1.0)
      return false;
  return true;
}

void run(const GoneWorldOptions& options, Outcome& all) {
  const GoneWorld world = make_gone_world(options);
  const std::vector<LandmarkRedetection> chances = landmark_redetections(world.map, 1, {});
  const RemovedLandmarks found = removed_landmarks(chances);
  all.places += found.places.size();
  for (const FoundPlace& place : found.places) all.wrong += is_wrong(place, world) ? 1 : 0;
  all.scatter += found.scatter;
  all.tests += static_cast<double>(found.tests);
  all.landmarks += static_cast<double>(chances.size());
  std::vector<int> should(world.gone.size(), 0), named(world.gone.size(), 0);
  const auto count = [&](std::size_t i, std::vector<int>& of) {
    const int thing = world.thing_of[static_cast<std::size_t>(chances[i].landmark)];
    if (thing >= 0) ++of[static_cast<std::size_t>(thing)];
  };
  for (std::size_t i = 0; i < chances.size(); ++i) count(i, should);
  for (const std::size_t i : found.judged) count(i, named);
  for (std::size_t t = 0; t < should.size(); ++t) {
    if (!world.gone[t] || should[t] < 5) continue;
    const auto k = static_cast<std::size_t>(
        std::upper_bound(std::begin(kBounds), std::end(kBounds), should[t]) - std::begin(kBounds));
    ++all.things[k];
    all.named[k] += 3 * named[t] >= should[t] ? 1 : 0;
  }
}

void study(const std::string& name,
           GoneWorldOptions options,
           std::size_t maps,
           std::uint64_t seed) {
  Outcome all;
  std::size_t alarms = 0;
  const double start = thread_seconds();
  for (std::size_t i = 0; i < maps; ++i) {
    options.seed = Random(seed, "gone " + name, i)() >> 1U;
    const std::size_t before = all.wrong;
    run(options, all);
    alarms += all.wrong > before ? 1 : 0;
    if (all.wrong > before)
      std::printf("  wrong: seed %llu\n", static_cast<unsigned long long>(options.seed));
  }
  const auto n = static_cast<double>(maps);
  std::printf(
      "%-28s maps %zu with a wrong place %zu; places %zu, wrong %zu; landmarks %.0f, squares %.0f, "
      "scatter %.2f; %.2f s a map;",
      name.c_str(), maps, alarms, all.places, all.wrong, all.landmarks / n, all.tests / n,
      all.scatter / n, (thread_seconds() - start) / n);
  for (std::size_t k = 0; k < kClasses; ++k)
    if (all.things[k] > 0)
      std::printf(" %d-: %zu/%zu", k == 0 ? 5 : kBounds[k - 1], all.named[k], all.things[k]);
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace roadbook::test

int main(int count, char** words) {
  if (count != 4) {
    std::fprintf(stderr, "usage: %s nulls|power MAPS SEED\n", words[0]);
    return 1;
  }
  using namespace roadbook::test;
  const bool nulls = std::string(words[1]) == "nulls";
  const auto maps = static_cast<std::size_t>(std::atoll(words[2]));
  const auto seed = static_cast<std::uint64_t>(std::atoll(words[3]));
  for (const double length : kLengths)
    for (const double density : kDensities)
      for (const double share : kShares) {
        if (nulls != (share == 0.0)) continue;
        GoneWorldOptions options;
        options.length_m = length;
        options.per_square = density;
        options.share_gone = share;
        study(std::to_string(static_cast<int>(length)) + " m, " +
                  std::to_string(static_cast<int>(density)) + " a square, " +
                  std::to_string(static_cast<int>(100.0 * share)) + " %",
              options, maps, seed);
      }
  return 0;
}
