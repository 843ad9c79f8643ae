#include "semantics/labels/keyframe_index.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {
namespace {

// A map of one session with keyframes at random places, in no order of their coordinates. Some
// places occur several times.
Map scattered_map(std::size_t keyframes) {
  Random random(7);
  Map map;
  map.sessions.emplace_back();
  for (std::size_t i = 0; i < keyframes; ++i) {
    Keyframe k;
    k.t_ns = static_cast<std::int64_t>(i);
    k.map_frame = static_cast<int>(i);
    map.keyframes.push_back(k);
    const bool again = i % 7 == 6;
    map.map_frames.push_back(again ? map.map_frames.back() : MapFrame());
    if (!again)
      map.map_frames.back().T_map_frame = pose_from_planar(
          random.uniform(-60.0, 60.0), random.uniform(-20.0, 20.0), random.uniform(-3.0, 3.0));
  }
  return map;
}

TEST(KeyframeIndex, FindsWhatAScanOfAllKeyframesFinds) {
  Random random(3);
  for (const std::size_t size : {0U, 1U, 2U, 11U, 800U}) {
    const Map map = scattered_map(size);
    const KeyframeIndex index(map);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d place(random.uniform(-80.0, 80.0), random.uniform(-40.0, 40.0));
      const double radius_m = random.uniform(0.0, 40.0);
      std::vector<std::size_t> want;
      for (std::size_t k = 0; k < size; ++k)
        if ((map.T_map_vehicle(static_cast<int>(k)).translation().head<2>() - place).norm() <=
            radius_m)
          want.push_back(k);
      EXPECT_EQ(index.within(place, radius_m), want) << size << " " << radius_m;
    }
  }
}

TEST(KeyframeIndex, CountsAKeyframeAtExactlyTheRadius) {
  for (const double scale : {1.0, 20.0, 200.0}) {
    Map map = scattered_map(1);
    map.map_frames[0].T_map_frame = pose_from_planar(3.0 * scale, 4.0 * scale, 0.0);
    const KeyframeIndex index(map);
    EXPECT_EQ(index.within({0.0, 0.0}, 5.0 * scale).size(), 1U) << scale;
    EXPECT_TRUE(index.within({0.0, 0.0}, 4.999999 * scale).empty()) << scale;
  }
}

}  // namespace
}  // namespace roadbook
