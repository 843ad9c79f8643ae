#include "mapping/localisation/register_drive.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "base/se3.hpp"

namespace roadbook {
namespace {

// A map of one keyframe and 80 landmarks with descriptors of chance.
Map place_of_landmarks() {
  Random random(8, "landmarks");
  Map map;
  map.sessions.resize(1);
  map.map_frames.resize(1);
  map.keyframes.resize(1);
  for (int i = 0; i < 80; ++i) {
    Landmark& landmark = map.landmarks.emplace_back();
    landmark.p_frame = {random.uniform(-7.0, 7.0), random.uniform(-3.0, 3.0),
                        random.uniform(0.0, 2.0)};
    for (std::uint8_t& byte : landmark.descriptor)
      byte = static_cast<std::uint8_t>(random.below(256));
  }
  return map;
}

// The same thing in another image: 30 of the 512 bits differ.
void look_again(Landmark& landmark, Random& random) {
  for (int i = 0; i < 30; ++i)
    landmark.descriptor[random.below(landmark.descriptor.size())] ^=
        static_cast<std::uint8_t>(1U << random.below(8));
}

TEST(LocaliseIn, ADriveIsFoundByLandmarksThatOccurOnceAndNotByTwins) {
  const Map own = place_of_landmarks();
  const Eigen::Isometry3d T_frozen_own = pose_from_planar(5.0, -3.0, 0.4);
  Map frozen = own;
  frozen.map_frames[0].T_map_frame = T_frozen_own;
  Random random(9, "looks");
  for (Landmark& landmark : frozen.landmarks) look_again(landmark, random);
  const auto found = localise_in(frozen, own);
  ASSERT_TRUE(found);
  EXPECT_LT((found->map.T_map_vehicle(1).translation() - T_frozen_own.translation()).norm(), 1e-6);
  // The same things stand a second time 30 m away: nothing tells the two places apart.
  for (Landmark twin : own.landmarks) {
    twin.p_frame.x() += 30.0;
    look_again(twin, random);
    frozen.landmarks.push_back(twin);
  }
  EXPECT_FALSE(localise_in(frozen, own));
}

}  // namespace
}  // namespace roadbook
