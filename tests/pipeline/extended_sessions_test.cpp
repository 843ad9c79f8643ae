#include <gtest/gtest.h>

#include <cmath>

#include "mapping/sessions/extend_map.hpp"
#include "tests/pipeline/malaga_pairs.hpp"
#include "tests/pipeline/session_residuals.hpp"
#include "tests/pipeline/visits.hpp"
#include "tests/support/real_data.hpp"

// A map is extended by further visits without the recordings of earlier ones. The judges: the truth
// of the simulation, and the map that is built from all recordings at once.

namespace roadbook {
namespace {

using test::Visits;

void expect_same_frames(const Map& before, const Map& after) {
  ASSERT_GE(after.map_frames.size(), before.map_frames.size());
  for (std::size_t f = 0; f < before.map_frames.size(); ++f)
    EXPECT_EQ(after.map_frames[f].T_map_frame.matrix(), before.map_frames[f].T_map_frame.matrix());
}

// Takes the recording of a visit away while it lives.
class Hidden {
 public:
  explicit Hidden(const std::filesystem::path& drive) : drive_(drive) {
    std::filesystem::rename(drive_, hidden());
  }
  ~Hidden() { std::filesystem::rename(hidden(), drive_); }
  Hidden(const Hidden&) = delete;
  Hidden& operator=(const Hidden&) = delete;

 private:
  [[nodiscard]] std::filesystem::path hidden() const { return drive_.string() + ".away"; }
  std::filesystem::path drive_;
};

TEST_F(Visits, ExtendAMapOneAfterAnother) {
  const std::filesystem::path file = map_of_first("extended.gpkg");
  const Map first = load_map(file);
  {
    const Hidden away(drives()[0]);
    const MapSummary near = extend_map(drives()[1], file, {});
    EXPECT_GT(near.localised_share.value(), 0.95);
    expect_same_frames(first, load_map(file));
    // Nothing but a command of other inputs does it again.
    EXPECT_TRUE(extend_map(drives()[1], file, {}).is_unchanged);
    EXPECT_EQ(load_meta(file).digest, near.digest);
  }
  MapOptions all;
  all.adjust = SessionAdjust::kAll;
  const MapSummary summary = extend_map(drives()[2], file, all);
  const Map map = load_map(file);
  expect_same_frames(first, map);
  EXPECT_LT(map.map_frames.size(), first.map_frames.size() + 10) << "the visits drive one road";
  ASSERT_EQ(map.sessions.size(), 3U);
  EXPECT_FALSE(map.landmark_sessions.empty());

  const test::Residuals residuals = test::residuals_of(map);
  EXPECT_GT(residuals.joined, 300);
  EXPECT_LT(residuals.off, 0.01 * residuals.joined);
  const MapSummary& batch = together();
  ASSERT_TRUE(summary.ate_median_m) << summary.truth_apart;
  EXPECT_LT(*summary.ate_median_m, 1.1 * *batch.ate_median_m);
  ASSERT_EQ(summary.truth_sessions.size(), 3U);
  for (const SessionTruth& session : summary.truth_sessions)
    EXPECT_LT(session.offset.value().shift_m.norm(), 0.03) << session.session;
}

TEST_F(Visits, LeaveTheMapAsItIsWhereNothingMayMove) {
  const std::filesystem::path file = map_of_first("frozen.gpkg");
  const Map before = load_map(file);
  MapOptions none;
  none.adjust = SessionAdjust::kNone;
  const MapSummary summary = extend_map(drives()[1], file, none);
  const Map after = load_map(file);
  expect_same_frames(before, after);
  for (std::size_t k = 0; k < before.keyframes.size(); ++k) {
    EXPECT_EQ(after.keyframes[k].T_frame_vehicle.matrix(),
              before.keyframes[k].T_frame_vehicle.matrix());
    EXPECT_EQ(after.keyframes[k].covariance, before.keyframes[k].covariance);
  }
  ASSERT_GE(after.landmarks.size(), before.landmarks.size());
  for (std::size_t l = 0; l < before.landmarks.size(); ++l) {
    EXPECT_EQ(after.landmarks[l].p_frame, before.landmarks[l].p_frame) << l;
    EXPECT_EQ(after.landmarks[l].map_frame, before.landmarks[l].map_frame);
  }
  std::size_t joined = 0;
  for (const Observation& seen : after.observations)
    joined += static_cast<std::size_t>(seen.landmark) < before.landmarks.size() &&
                      static_cast<std::size_t>(seen.keyframe) >= before.keyframes.size()
                  ? 1
                  : 0;
  EXPECT_GT(joined, 2000U);
  EXPECT_LT(summary.truth_sessions.at(1).offset.value().shift_m.norm(), 0.03);
}

// One camera, no wheels: the second drive extends the map of the first without its recording.
TEST(ExtendRecorded, MalagaBPassesTheFramesOfA) {
  ROADBOOK_REQUIRE_DATA(a, "drives/malaga07_a");
  ROADBOOK_REQUIRE_DATA(b, "drives/malaga07_b");
  const auto file = test::fresh_folder("malaga_extended") / "map.gpkg";
  build_map({a}, file, {});
  const Map before = load_map(file);
  MapOptions none;
  none.adjust = SessionAdjust::kNone;
  const MapSummary summary = extend_map(b, file, none);
  // One camera sees too few landmarks in some keyframes: the odometry between others
  // gives their poses.
  EXPECT_GT(summary.localised_share.value(), 0.6);
  EXPECT_EQ(summary.components, 1U);
  const Map after = load_map(file);
  expect_same_frames(before, after);
  for (std::size_t l = 0; l < before.landmarks.size(); ++l)
    EXPECT_EQ(after.landmarks[l].p_frame, before.landmarks[l].p_frame) << l;
  int loops = 0;
  int right = 0;
  for (const LoopEdge& loop : after.loops) {
    if (!loop.accepted) continue;
    const Keyframe& from = after.keyframes[static_cast<std::size_t>(loop.from)];
    const Keyframe& to = after.keyframes[static_cast<std::size_t>(loop.to)];
    if (from.session != 0 || to.session != 1) continue;
    ++loops;
    const double expected = test::frame_of_malaga_a(1600.0 + 2.0 * to.drive_frame);
    right += std::abs(2.0 * from.drive_frame - expected) <= 16.0 ? 1 : 0;
  }
  EXPECT_GT(loops, 50);
  EXPECT_GE(right, 0.95 * loops);
}

}  // namespace
}  // namespace roadbook
