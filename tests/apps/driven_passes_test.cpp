#include "workflows/driven_passes.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

Keyframe keyframe(int session, double x, bool reversing = false, bool after_gap = false) {
  Keyframe result;
  result.session = session;
  result.T_frame_vehicle.translation().x() = x;
  result.reversing = reversing;
  result.after_gap = after_gap;
  return result;
}

TEST(DrivenPasses, BeginAtSessionsGapsAndTurningPoints) {
  Map map;
  map.map_frames.resize(1);
  map.keyframes = {keyframe(0, 0.0),
                   keyframe(0, 1.0),
                   keyframe(0, 0.5, true),
                   keyframe(0, 0.0, true),
                   keyframe(0, 9.0, true, true),
                   keyframe(1, 20.0),
                   keyframe(1, 21.0)};
  const auto passes = driven_passes(map);
  ASSERT_EQ(passes.size(), 4U);
  EXPECT_EQ(passes[0].positions.size(), 2U);
  // The turning point belongs to both passes, so the path is continuous there.
  ASSERT_EQ(passes[1].positions.size(), 3U);
  EXPECT_TRUE(passes[1].reversing);
  EXPECT_EQ(passes[1].positions[0].x(), 1.0);
  // Passes are not joined across a gap or across sessions.
  EXPECT_EQ(passes[2].positions.size(), 1U);
  EXPECT_EQ(passes[3].session, 1);
  EXPECT_EQ(passes[3].positions.size(), 2U);
  EXPECT_DOUBLE_EQ(driven_length_m(passes), 1.0 + 1.0 + 1.0);  // the passes' lengths without gaps
}

TEST(DrivenPasses, OfAnEmptyMapAreNone) { EXPECT_TRUE(driven_passes(Map{}).empty()); }

}  // namespace
}  // namespace roadbook
