#include <gtest/gtest.h>

#include <cmath>

#include "mapping/occupancy/cell_rules.hpp"
#include "mapping/occupancy/place_patches.hpp"
#include "mapping/occupancy/reading_dependence.hpp"
#include "tests/mapping/occupancy/hall_scans.hpp"

namespace roadbook {
namespace {

using test::hall_drive;
using test::HallDrive;
using test::kHallMax_m;

InverseRangeModel hall_inverse() {
  return {mixture_of({0.02, 0.02, 0.01, 0.5}, 0.03),
          kHallMax_m,
          {.cell_m = 0.1, .surfaces_per_m = 0.2}};
}

BuiltPatches patches_of(const HallDrive& drive, const BuildPatchesOptions& options = {}) {
  return build_patches(drive.scans, drive.anchor_of, drive.anchors, "hall", hall_inverse(),
                       options);
}

PoseOfKeyframe poses_of(const HallDrive& drive) {
  return [&drive](const std::string&, std::int64_t t) -> std::optional<PlanePose> {
    for (const PatchAnchor& anchor : drive.anchors)
      if (anchor.t_ns == t) return anchor.map_vehicle;
    return std::nullopt;
  };
}

double probability_at(const OccupancyGrid& grid, const Eigen::Vector2d& p) {
  const Eigen::Vector2d cell = (p - grid.shape.low) / grid.shape.cell_m;
  const int column = static_cast<int>(std::floor(cell.x()));
  const int row = static_cast<int>(std::floor(cell.y()));
  if (!grid.shape.holds(column, row)) return NAN;
  const std::size_t i = grid.shape.index(column, row);
  static const double prior = hall_inverse().prior_log_odds();
  return grid.seen[i] == 0 ? NAN : grid.probability(i, prior);
}

// The judge walks the same columns with plain arithmetic.
TEST(PatchGrid, ABeamChangesTheCellsThatAPlainWalkFinds) {
  const InverseRangeModel inverse = hall_inverse();
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    PatchGrid grid(CellShape::over({-6.0, -5.0}, {7.0, 6.0}, 0.1));
    const Eigen::Vector2d origin(random.uniform(-5.0, 5.0), random.uniform(-4.0, 4.0));
    const double a = random.uniform(0.0, 6.3);
    const Eigen::Vector2d along(std::cos(a), std::sin(a));
    const double read = random.uniform(0.3, 5.0);
    const std::size_t changed = add_beam(grid, origin, along, read, inverse);
    const bool by_x = std::abs(along.x()) >= std::abs(along.y());
    const auto row = inverse.changes(read, 0.1 / along.cwiseAbs().maxCoeff());
    std::size_t found = 0, wrong = 0;
    for (int major = 0; major < (by_x ? grid.columns : grid.rows); ++major) {
      const double middle = (by_x ? grid.low.x() : grid.low.y()) + (major + 0.5) * 0.1;
      const double distance =
          by_x ? (middle - origin.x()) / along.x() : (middle - origin.y()) / along.y();
      if (distance < 0.0) continue;
      const double entry = distance / inverse.step_m() + 0.5;
      const Eigen::Vector2d p = (origin + distance * along - grid.low) / 0.1;
      const int column = by_x ? major : static_cast<int>(std::floor(p.x()));
      const int line = by_x ? static_cast<int>(std::floor(p.y())) : major;
      if (!(entry < static_cast<double>(row.size())) || !grid.holds(column, line)) continue;
      ++found;
      const OccupancyCell& cell = grid.cells[grid.index(column, line)];
      wrong +=
          cell.seen != 1.0F || std::abs(cell.change - row[static_cast<std::size_t>(entry)]) > 0.0F
              ? 1
              : 0;
    }
    // Fixed-point numbers may round a cell at a line into its neighbour, and cut at the edge.
    EXPECT_LE(wrong, 2U) << i;
    EXPECT_LE(std::abs(static_cast<int>(changed) - static_cast<int>(found)), 1) << i;
  }
}

TEST(OccupancyPatches, WallsAreOccupiedAndTheHallIsFree) {
  const HallDrive drive = hall_drive(1, {0.02, 0.02, 0.01, 0.5});
  auto built = patches_of(drive);
  const OccupancyGrid grid = place_patches(built.patches, poses_of(drive), {});
  EXPECT_EQ(grid.moved, 0U);
  EXPECT_EQ(grid.without_pose, 0U);
  for (double x = 2.0; x < 28.0; x += 0.5) {
    EXPECT_LT(probability_at(grid, {x, 1.5}), 0.02) << x;
    EXPECT_GT(probability_at(grid, {x, 3.05}), 0.9) << x;
    EXPECT_GT(probability_at(grid, {x, -2.05}), 0.9) << x;
  }
}

TEST(OccupancyPatches, GroundBehindAWallStaysUnknown) {
  const HallDrive drive = hall_drive(1);
  auto built = patches_of(drive);
  const OccupancyGrid grid = place_patches(built.patches, poses_of(drive), {});
  for (double x = 2.0; x < 28.0; x += 0.5)
    EXPECT_TRUE(std::isnan(probability_at(grid, {x, 3.6}))) << x;
}

// A tenth of the readings has lost its echo and passes the wall: some thirty beams a metre of it.
TEST(OccupancyPatches, LostEchoesDoNotFreeTheGroundBehindAMappedWall) {
  const HallDrive drive = hall_drive(1, {0.0, 0.1, 0.0, 0.5});
  auto built = patches_of(drive);
  const OccupancyGrid grid = place_patches(built.patches, poses_of(drive), {});
  int known = 0, cells = 0;
  for (double x = 2.0; x < 28.0; x += 0.1, ++cells)
    known += std::isnan(probability_at(grid, {x, 3.6})) ? 0 : 1;
  EXPECT_LT(known, cells / 4);
  for (double x = 2.0; x < 28.0; x += 0.5) EXPECT_GT(probability_at(grid, {x, 3.05}), 0.9) << x;
}

TEST(OccupancyPatches, AreTheSameOnAnyNumberOfThreads) {
  const HallDrive drive = hall_drive(2);
  const auto one = patches_of(drive, {.num_threads = 1});
  const auto four = patches_of(drive, {.num_threads = 4});
  ASSERT_EQ(one.patches.size(), four.patches.size());
  EXPECT_EQ(one.updates, four.updates);
  for (std::size_t i = 0; i < one.patches.size(); ++i) {
    EXPECT_EQ(one.patches[i].log_odds, four.patches[i].log_odds);
    EXPECT_EQ(one.patches[i].seen, four.patches[i].seen);
    EXPECT_EQ(one.patches[i].vehicle_patch.x_m, four.patches[i].vehicle_patch.x_m);
  }
}

// Rounding of the stored numbers: half a thousandth, and the float sum of some 500 readings.
TEST(OccupancyPatches, TheRatioFormGivesTheSameGrid) {
  const HallDrive drive = hall_drive(3);
  const auto by_sum = patches_of(drive);
  const auto by_ratio = patches_of(drive, {.update = OccupancyUpdate::kBayes});
  ASSERT_EQ(by_sum.patches.size(), by_ratio.patches.size());
  for (std::size_t i = 0; i < by_sum.patches.size(); ++i)
    for (std::size_t c = 0; c < by_sum.patches[i].log_odds.size(); ++c)
      ASSERT_NEAR(by_sum.patches[i].log_odds[c], by_ratio.patches[i].log_odds[c], 3);
}

// One short reading in front of a wall frees nothing; one maximum reading through a wall does, for
// good, with the naive rule alone.
TEST(OccupancyPatches, TheNaiveRuleLosesAWallToOneWrongReading) {
  HallDrive drive = hall_drive(4, {}, 0.001);
  for (ScanBeam& b : drive.scans[60].beams) b.read_m = kHallMax_m;
  const auto cells_of_wall = [&](OccupancyUpdate update) {
    auto built = patches_of(drive, {.update = update});
    const OccupancyGrid grid = place_patches(built.patches, poses_of(drive), {});
    int occupied = 0;
    for (int i = 0; i < 40; ++i)
      occupied += probability_at(grid, {13.05 + 0.1 * i, 3.05}) > 0.5 ? 1 : 0;
    return occupied;
  };
  EXPECT_LT(cells_of_wall(OccupancyUpdate::kNaive), 36);
  EXPECT_EQ(cells_of_wall(OccupancyUpdate::kLogOdds), 40);
}

// A hall that is turned against the cells of the map, as walls are.
const Eigen::Rotation2Dd kTurn(0.11);

// Poses and beams of a drive under a motion that depends on the scan.
template <typename Motion>
HallDrive moved_by(const HallDrive& drive, const Motion& motion) {
  HallDrive moved = drive;
  for (std::size_t s = 0; s < drive.scans.size(); ++s) {
    const Eigen::Isometry2d T = motion(s);
    moved.anchors[s].map_vehicle =
        plane_pose(Eigen::Isometry2d(T * drive.anchors[s].map_vehicle.isometry()));
    moved.scans[s].origin = T * drive.scans[s].origin;
    for (std::size_t b = 0; b < drive.scans[s].beams.size(); ++b)
      moved.scans[s].beams[b].along =
          (T.linear() * drive.scans[s].beams[b].along.cast<double>()).cast<float>();
  }
  return moved;
}

// Mean thickness of the upper wall of the turned hall [m].
double wall_thickness(const OccupancyGrid& grid) {
  constexpr double kStep = 0.02;
  double occupied = 0.0, lines = 0.0;
  for (double x = 3.0; x < 27.0; x += 0.05) {
    lines += 1.0;
    for (double y = 2.4; y < 3.8; y += kStep)
      occupied += probability_at(grid, kTurn * Eigen::Vector2d(x, y)) > 0.65 ? kStep : 0.0;
  }
  return occupied / lines;
}

// The drive bends by odometry's error; then a loop closure makes it straight. Patches that follow
// their poses draw the wall at the place of a grid that is built again from the readings.
TEST(OccupancyPatches, FollowTheirPosesWhenALoopClosureMovesThem) {
  const HallDrive straight = hall_drive(5);
  const HallDrive right = moved_by(straight, [](std::size_t) {
    Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
    T.linear() = kTurn.toRotationMatrix();
    return T;
  });
  const HallDrive bent = moved_by(straight, [](std::size_t s) {
    Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
    T.linear() = Eigen::Rotation2Dd(0.0008 * static_cast<double>(s)).toRotationMatrix();
    T.translation() = Eigen::Vector2d(0.002 * static_cast<double>(s), -0.6);
    return T;
  });
  const std::map<std::string, double> temper{{"hall", 0.2}};
  auto built_again = patches_of(right);
  const OccupancyGrid again = place_patches(built_again.patches, poses_of(right), temper);
  auto built_bent = patches_of(bent);
  const std::size_t count = built_bent.patches.size();
  EXPECT_EQ(place_patches(built_bent.patches, poses_of(bent), temper).moved, 0U);
  const OccupancyGrid moved = place_patches(built_bent.patches, poses_of(right), temper);
  EXPECT_GT(moved.moved, count / 2);
  const double thick = wall_thickness(moved);
  const double judge = wall_thickness(again);
  RecordProperty("ratio", std::to_string(thick / judge));
  EXPECT_GT(judge, 0.08);
  EXPECT_GT(thick, 0.9 * judge);
  // A turned patch rounds the place of a cell once more, by up to half a cell to either side.
  EXPECT_LT(thick, judge + 0.1);
  // Placed again at the same poses: nothing moves any more.
  EXPECT_EQ(place_patches(built_bent.patches, poses_of(right), temper).moved, 0U);
}

TEST(OccupancyPatches, APoseThatTheMapNoLongerHasLeavesItsPatchOut) {
  const HallDrive drive = hall_drive(6);
  auto built = patches_of(drive);
  const std::int64_t gone = built.patches[1].t_ns;
  const auto poses = poses_of(drive);
  const OccupancyGrid grid = place_patches(built.patches,
                                           [&](const std::string& session, std::int64_t t) {
                                             return t == gone ? std::nullopt : poses(session, t);
                                           },
                                           {});
  EXPECT_EQ(grid.without_pose, 1U);
}

// The first reading of a cell counts in full, each further one as a fifth; two drives are
// independent of each other.
TEST(OccupancyPatches, FurtherReadingsOfADriveAreTempered) {
  const HallDrive drive = hall_drive(8);
  auto built = patches_of(drive);
  const OccupancyGrid whole = place_patches(built.patches, poses_of(drive), {});
  const OccupancyGrid fifth = place_patches(built.patches, poses_of(drive), {{"hall", 0.2}});
  auto twice = built.patches;
  for (OccupancyPatch patch : built.patches) {
    patch.drive = "again";
    twice.push_back(patch);
  }
  const OccupancyGrid both = place_patches(twice, poses_of(drive), {{"hall", 0.2}, {"again", 0.2}});
  for (std::size_t i = 0; i < whole.seen.size(); ++i) {
    const double n = whole.seen[i];
    if (n == 0.0) continue;
    ASSERT_NEAR(fifth.effective[i], 1.0 + 0.2 * (n - 1.0), 1e-3);
    ASSERT_NEAR(fifth.change[i], whole.change[i] * (1.0 + 0.2 * (n - 1.0)) / n, 1e-3);
    ASSERT_NEAR(both.change[i], 2.0F * fifth.change[i], 1e-3);
    ASSERT_EQ(both.drives[i], 2);
  }
}

// Readings drawn from the sensor model itself in a hall are nearly independent; the same scans,
// each repeated five times, are not.
TEST(ReadingDependence, CountsRepeatedReadingsOnce) {
  const HallDrive drive = hall_drive(7, {0.05, 0.02, 0.02, 0.5}, 0.03, 240);
  const RangeMixture mixture = mixture_of({0.05, 0.02, 0.02, 0.5}, 0.03);
  const InverseRangeModel inverse(mixture, kHallMax_m, {.cell_m = 0.1, .surfaces_per_m = 0.2});
  const auto once = reading_dependence(drive.scans, mixture, inverse, 0.1, 0.0);
  std::vector<RangeScan> repeated;
  for (const RangeScan& scan : drive.scans)
    for (int i = 0; i < 5; ++i) repeated.push_back(scan);
  const auto five = reading_dependence(repeated, mixture, inverse, 0.1, 0.0);
  EXPECT_GT(once.innovations, 10000U);
  EXPECT_GT(once.effective_share, 0.05);
  EXPECT_LT(five.effective_share, 0.5 * once.effective_share);
}

}  // namespace
}  // namespace roadbook
