#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>

#include "apps/evaluation/pictures/painted_lot.hpp"
#include "semantics/detector/label_oracle.hpp"

// Checks [metric-semantic maps, figure 7]: the effort and the time to find the 164 spaces of
// `stuttgart`.

namespace roadbook {
namespace {

double processor_s() {
  std::timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Effort {
  OracleResult result;
  std::vector<double>
      round_s;  ///< processor time over all threads: upper bound of the time that a round waits
};

Effort label_floor(std::uint64_t floor) {
  const PaintedLot lot = painted_lot("stuttgart", "full", floor, 2);
  EXPECT_EQ(lot.spaces.size(), 164U);
  Effort effort;
  double begin = processor_s();
  OracleOptions options;
  options.learner.search.num_threads = 2;
  options.after_round = [&](const BoxLearner&) {
    effort.round_s.push_back(processor_s() - begin);
    begin = processor_s();
  };
  effort.result = play_oracle(lot.image, lot.spaces, options);
  return effort;
}

// The floor is worn and has cars on it: the first one that `evaluate labels` uses. The test
// measures processor time, because other load on the machine changes it little. The limit of the
// search is stricter than the required elapsed time with two cores. A further round is measured by
// the search of the same run: it keeps the features.
TEST(LabelEffort, FourteenBoxesAndSixRoundsFindAlmostAllOf164SpacesWithoutWaiting) {
  const Effort effort = label_floor(1);
  const auto& rounds = effort.result.rounds;
  ASSERT_LE(rounds.size(), 6U);
  EXPECT_LE(rounds.back().drawn, 14);
  EXPECT_GT(rounds.back().precision, 0.93);
  EXPECT_GT(rounds.back().recall, 0.9);
  const double search_s = effort.round_s.front();
  const double again_s = *std::min_element(effort.round_s.begin(), effort.round_s.end());
#ifdef ROADBOOK_TIMED  // release builds
  EXPECT_LT(search_s, 5.0);
  EXPECT_LT(again_s, 0.4 * search_s);
#endif
  RecordProperty("search_ms", static_cast<int>(1e3 * search_s));
  RecordProperty("again_ms", static_cast<int>(1e3 * again_s));
}

}  // namespace
}  // namespace roadbook
