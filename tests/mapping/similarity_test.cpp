#include "mapping/similarity.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "base/se3.hpp"

namespace roadbook {
namespace {

std::vector<Eigen::Vector3d> cloud(std::uint64_t seed) {
  Random random(seed, "cloud");
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 50; ++i)
    points.emplace_back(random.normal(), 3 * random.normal(), random.normal());
  return points;
}

TEST(Similarity, UndoesAKnownScaleTurnAndShift) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed, "similarity");
    const std::vector<Eigen::Vector3d> b = cloud(seed);
    const double scale = random.uniform(0.2, 5.0);
    const Eigen::Matrix3d R =
        so3_exp(Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
    const Eigen::Vector3d t(random.normal(), random.normal(), random.normal());
    std::vector<Eigen::Vector3d> a;
    for (const auto& p : b) a.emplace_back(scale * (R * p) + t);
    const Similarity found = align(a, b, true);
    EXPECT_TRUE(found.unique);
    EXPECT_NEAR(found.scale, scale, 1e-12 * scale);
    EXPECT_LT((found.R - R).norm(), 1e-11);
    EXPECT_LT((found.t - t).norm(), 1e-11);
  }
}

TEST(Similarity, NeverMirrors) {
  const std::vector<Eigen::Vector3d> b = cloud(1);
  std::vector<Eigen::Vector3d> a;
  for (const auto& p : b) a.emplace_back(p.x(), p.y(), -p.z());
  EXPECT_NEAR(align(a, b, false).R.determinant(), 1.0, 1e-12);
}

TEST(Similarity, SaysWhenALineLeavesTheTurnOpen) {
  const std::vector<Eigen::Vector3d> line = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}};
  EXPECT_FALSE(align(line, line, false).unique);
}

TEST(Similarity, TrajectoryErrorOfOnePoseOff) {
  std::vector<Eigen::Vector3d> a;
  for (int i = 0; i < 100; ++i) a.emplace_back(i, 0.01 * i * i, 0.0);
  const TrajectoryError error = trajectory_error(a, a, false);
  EXPECT_EQ(error.count, 100u);
  EXPECT_LT(error.max_m, 1e-12 * 100);
}

TEST(Similarity, AssociatesEachStampOnceWithItsNearest) {
  const std::vector<std::int64_t> a = {0, 10, 20, 30, 100};
  const std::vector<std::int64_t> b = {1, 19, 22, 60};
  const auto pairs = associate_stamps(a, b, 5);
  const std::vector<std::pair<std::size_t, std::size_t>> want = {{0, 0}, {2, 1}};
  EXPECT_EQ(pairs, want);
}

}  // namespace
}  // namespace roadbook
