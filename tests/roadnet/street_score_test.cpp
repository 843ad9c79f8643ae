#include "tests/roadnet/street_score.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

// A square of 400 m with a street through its middle.
test::StreetMap square() {
  test::StreetMap map;
  for (const Eigen::Vector2d& at :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(400, 0), Eigen::Vector2d(400, 400),
        Eigen::Vector2d(0, 400), Eigen::Vector2d(200, 0), Eigen::Vector2d(200, 400)})
    map.add_place(at);
  for (const auto& [a, b] :
       std::vector<std::pair<int, int>>{{0, 4}, {4, 1}, {1, 2}, {2, 5}, {5, 3}, {3, 0}, {4, 5}})
    map.add_street(a, b);
  return map;
}

test::Track along(const test::Track& corners) {
  test::Track track;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i)
    for (int k = 0; k < 20; ++k)
      track.push_back(corners[i] + (corners[i + 1] - corners[i]) * k / 20);
  track.push_back(corners.back());
  return track;
}

TEST(StreetScore, CountsTheStreetsThatATrackWentAlong) {
  const test::StreetMap map = square();
  const auto driven = driven_times(
      map, {along({{0, 8}, {200, 8}, {205, 390}}), along({{5, 5}, {200, -5}, {390, 0}})});
  const auto times = [&](std::size_t street) { return driven[street][driven[street].size() / 2]; };
  EXPECT_EQ(times(0), 2);
  EXPECT_EQ(times(1), 1);
  EXPECT_EQ(times(6), 1);
  for (const std::size_t street : {2U, 3U, 4U, 5U}) EXPECT_EQ(times(street), 0);
}

TEST(StreetScore, MeasuresWhatWasInventedAndWhatWasMissed) {
  const test::StreetMap map = square();
  auto driven = test::not_driven(map);
  for (const std::size_t street : {0U, 1U, 6U})  // 200 + 200 + 400 m
    for (int& times : driven[street]) times = 3;
  // The whole southern side at a distance of 10 m, and a diagonal of the same length that is not a
  // street.
  const auto score =
      score_streets({{{0, 10}, {400, 10}}, {{20, 120}, {303, 403}}}, map, driven, 3, 20);
  EXPECT_NEAR(score.recall, 0.5, 0.02);
  EXPECT_NEAR(score.precision, 0.5, 0.02);
  EXPECT_NEAR(score.wanted_km, 0.8, 0.01);
  EXPECT_EQ(score_streets({}, map, driven, 3, 20).recall, 0.0);
  EXPECT_EQ(score_streets({{{0, 10}, {400, 10}}}, map, driven, 4, 20).wanted_km, 0.0);
  EXPECT_EQ(score_streets({{{0, 30}, {400, 30}}}, map, driven, 3, 20).precision, 0.0);
}

}  // namespace
}  // namespace roadbook
