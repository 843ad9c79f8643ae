#include "mapping/sessions/map_part.hpp"

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "mapping/landmark_information.hpp"
#include "tests/mapping/localisation/synthetic_place.hpp"

namespace roadbook {
namespace {

// Half of the ring: poses and landmarks stay where they are, whatever frame they are in.
// Covariances of landmarks are in map axes: in those they belong to the observations that are left.
TEST(MapPart, KeepsPlacesAndWidensCovariances) {
  Map map = test::synthetic_place(3, {.point_count = 600, .spacing_m = 1.0}).map;
  const auto before = landmark_information(map);
  for (std::size_t l = 0; l < map.landmarks.size(); ++l)
    map.landmarks[l].covariance = before[l].determinant() > 0.0
                                      ? Eigen::Matrix3d(4.0 * before[l].inverse())
                                      : unknown_covariance<Eigen::Matrix3d>();
  std::vector<char> keeps(map.keyframes.size(), 0);
  const std::size_t first = keeps.size() / 4;
  const std::size_t count = keeps.size() / 2;
  for (std::size_t k = first; k < first + count; ++k) keeps[k] = 1;
  const Map part = part_of_map(map, keeps);

  ASSERT_EQ(part.keyframes.size(), count);
  EXPECT_EQ(part.map_frames.size(), count);
  for (std::size_t k = 0; k < count; ++k)
    EXPECT_EQ(part.T_map_vehicle(static_cast<int>(k)).matrix(),
              map.T_map_vehicle(static_cast<int>(first + k)).matrix());
  std::vector<int> views(map.landmarks.size(), 0);
  for (const Observation& o : map.observations) views[at(o.landmark)] += keeps[at(o.keyframe)];
  std::vector<int> stay;  // of three views and more
  for (std::size_t l = 0; l < views.size(); ++l)
    if (views[l] >= 3) stay.push_back(static_cast<int>(l));
  ASSERT_EQ(part.landmarks.size(), stay.size());
  ASSERT_LT(stay.size(), map.landmarks.size());
  const auto after = landmark_information(part);
  for (std::size_t l = 0; l < stay.size(); ++l) {
    EXPECT_LT((part.p_map(part.landmarks[l]) - map.p_map(map.landmarks[at(stay[l])])).norm(), 1e-9);
    const Eigen::Matrix3d scaled = part.landmarks[l].covariance * after[l];
    EXPECT_LT((scaled - 4.0 * Eigen::Matrix3d::Identity()).norm(), 1e-6) << l;
  }
  for (const Keyframe& keyframe : part.keyframes) EXPECT_EQ(keyframe.piece, 0);
}

}  // namespace
}  // namespace roadbook
