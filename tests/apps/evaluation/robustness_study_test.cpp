#include "apps/evaluation/robustness/robustness_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "apps/evaluation/robustness/alike_places.hpp"
#include "apps/evaluation/robustness/recorded_table.hpp"
#include "apps/evaluation/robustness/removed_loops.hpp"
#include "base/messages.hpp"
#include "base/temporary_folder.hpp"
#include "mapping/store/map_file.hpp"
#include "sim/simulate.hpp"
#include "tests/pipeline/shared_round.hpp"
#include "workflows/map_drives.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

DriveFault fault_named(const std::string& name) {
  for (const auto& list : {wheel_faults(), camera_faults()})
    for (const DriveFault& fault : list)
      if (fault.name == name) return fault;
  throw std::logic_error("no fault " + name);
}

// A recorded drive with tiny images: what the faults of wheels and calibrations need. The tests
// share the clean drive, and each damages its own copy.
class DamagedFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<TemporaryFolder>();
    SimulateOptions options;
    options.max_duration_s = 12.0;
    simulate(load_scenario("zurich", {.size = "small", .image_scale = 0.1}), clean(), options);
  }
  static void TearDownTestSuite() { shared_.reset(); }

  void SetUp() override {
    fs::copy(clean(), drive(), fs::copy_options::recursive | fs::copy_options::create_hard_links);
  }

  PlantedFault plant(const std::string& name, std::uint64_t seed = 1) {
    Random random(seed);
    return fault_named(name).plant(drive(), random);
  }

  [[nodiscard]] static fs::path clean() { return shared_->path() / "clean"; }
  [[nodiscard]] fs::path drive() const { return folder_.path() / "damaged"; }
  [[nodiscard]] static RecordedTable wheels(const fs::path& drive) {
    return RecordedTable(drive / "wheels0" / "data.csv");
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> shared_;
  TemporaryFolder folder_;
};

TEST_F(DamagedFiles, ACounterThatWrapsKeepsItsAngleWithinATurn) {
  const RecordedTable before = wheels(clean());
  EXPECT_EQ(plant("wheels: wraps at one turn").sensors, std::vector<std::string>{"wheels0"});
  const RecordedTable after = wheels(drive());
  const std::size_t left = after.column("rear_left_angle");
  ASSERT_EQ(after.rows(), before.rows());
  const double turn = 2.0 * std::numbers::pi;
  double largest_step = 0.0;
  for (std::size_t row = 0; row < after.rows(); ++row) {
    ASSERT_GE(after.number(row, left), 0.0);
    ASSERT_LT(after.number(row, left), turn);
    const double moved = (after.number(row, left) - before.number(row, left)) -
                         (after.number(0, left) - before.number(0, left));
    EXPECT_NEAR(std::remainder(moved, turn), 0.0, 1e-9);
    if (row > 0)
      largest_step =
          std::max(largest_step, std::abs(after.number(row, left) - after.number(row - 1, left)));
  }
  EXPECT_GT(largest_step, 0.9 * turn);
}

TEST_F(DamagedFiles, AStuckWheelLosesTheWayOfItsTimeAndNoMore) {
  plant("wheels: stuck 2.0 s, both");
  const RecordedTable before = wheels(clean());
  const RecordedTable after = wheels(drive());
  const std::size_t right = after.column("rear_right_angle");
  std::size_t still = 0;
  for (std::size_t row = 1; row < after.rows(); ++row) {
    const double moved = after.number(row, right) - after.number(row - 1, right);
    if (std::abs(moved) < 1e-12)
      ++still;
    else
      EXPECT_NEAR(moved, before.number(row, right) - before.number(row - 1, right), 1e-9);
  }
  EXPECT_NEAR(static_cast<double>(still), 100.0, 1.0);  // rows of 2 s at 50 Hz
}

TEST_F(DamagedFiles, TheCleanDriveStaysAsItIs) {
  const std::string yaml = value_of(clean() / "cam0" / "sensor.yaml", "intrinsics");
  const double radius =
      numbers_of(value_of(clean() / "wheels0" / "sensor.yaml", "wheel_radius_left")).front();
  for (const char* name : {"wheels: radius x 2", "cameras: intrinsics of twice the size"})
    plant(name);
  EXPECT_EQ(value_of(clean() / "cam0" / "sensor.yaml", "intrinsics"), yaml);
  EXPECT_NE(value_of(drive() / "cam0" / "sensor.yaml", "intrinsics"), yaml);
  EXPECT_DOUBLE_EQ(
      numbers_of(value_of(drive() / "wheels0" / "sensor.yaml", "wheel_radius_left")).front(),
      2.0 * radius);
}

TEST_F(DamagedFiles, ALateCameraIsLateInEveryRow) {
  const PlantedFault planted = plant("camera: 20 ms late", 3);
  const RecordedTable before(clean() / planted.sensors.front() / "data.csv");
  const RecordedTable after(drive() / planted.sensors.front() / "data.csv");
  ASSERT_GT(after.rows(), 10U);
  for (std::size_t row = 0; row < after.rows(); ++row)
    EXPECT_EQ(after.stamp_ns(row) - before.stamp_ns(row), 20'000'000);
}

// The short version of `roadbook evaluate robustness`.
TEST(Robustness, ADamagedDriveMakesARightMapOrNoneOrIsNamed) {
  std::vector<DriveFault> faults;
  for (const char* name :
       {"wheels: stuck 2.0 s, both", "wheels: reversed, one", "wheels: radius x 2",
        "camera: turned 2 degrees", "cameras: T_BS inverted", "cameras: 12 bits in 16"})
    faults.push_back(fault_named(name));
  const RobustnessResult result = study_robustness({.seconds = 20.0}, faults, 1, 0);
  EXPECT_TRUE(result.clean.messages.empty()) << result.clean.messages.front();
  for (const RobustnessRun& run : result.runs) {
    SCOPED_TRACE(run.fault + ": " + name_of(run.outcome));
    EXPECT_NE(run.outcome, RobustnessOutcome::kWrongSilent);
    EXPECT_NE(run.outcome, RobustnessOutcome::kRefusedElse);
    EXPECT_FALSE(run.error_ratio > 4.0) << run.error_ratio;  // NaN: no map
    if (run.fault.starts_with("wheels")) {  // used where they are right, or corrected
      EXPECT_EQ(run.outcome, RobustnessOutcome::kRight) << run.error_ratio;
      EXPECT_TRUE(run.is_named);
    }
  }
  EXPECT_EQ(result.runs[5].outcome, RobustnessOutcome::kRight);  // greys are scaled
}

// Half of every image shows things that move with another speed than the place. No landmark may
// stand on them for long.
TEST(Robustness, NoLandmarkStaysOnMovingThings) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive";
  test::give_beginning_of_round(12.0, drive);
  Random random(1);
  (void)fault_named("cameras: moving things over half the view").plant(drive, random);
  MapRequest request;
  request.drives = {drive};
  request.map = folder.path() / "place.gpkg";
  NoMessages messages;
  const MapSummary summary = map_drives(request, messages).summary;
  const Map map = load_map(request.map);
  const double middle =
      0.5 * numbers_of(value_of(drive / "cam0" / "sensor.yaml", "resolution")).front();
  std::map<int, int> views;
  std::map<int, int> covered;
  for (const Observation& seen : map.observations) {
    ++views[seen.landmark];
    if (seen.pixel.x() > middle) ++covered[seen.landmark];
  }
  int standing = 0;
  for (const auto& [landmark, count] : covered)
    if (2 * count > views[landmark] && count > 5) ++standing;
  EXPECT_EQ(standing, 0);
  EXPECT_GT(views.size(), 500U);
  EXPECT_LT(summary.ate_median_m.value(), 0.03);
}

// The upper of two equal storeys: every corner looks as below, and all false loops agree.
TEST(AlikePlaces, NoLoopJoinsTwoStoreys) {
  const AlikeDrive drive = drive_alike_place({.scenario = "storeys", .size = "small"}, 1, 0);
  const AlikeResult result = judge_loops(drive, 200, {});
  EXPECT_GT(result.verified.wrong, 20);
  EXPECT_EQ(result.kept.wrong, 0);
  EXPECT_LT(result.largest_bend_m, 1e-6);
}

// Equal bays beside each other: the drive ends where it began, so that true loops lie among false
// ones. No true loop may carry the map alone.
TEST(AlikePlaces, NoLoopJoinsTwoBaysAndNoneCarriesTheMapAlone) {
  AlikeDrive drive = drive_alike_place({.scenario = "bays", .size = "small"}, 1, 0);
  const MapOptions options;
  const AlikeResult result = judge_loops(drive, 100, options);
  EXPECT_GT(result.verified.wrong, 10);
  EXPECT_EQ(result.kept.wrong, 0);
  EXPECT_GT(result.kept.all, 5);
  const LoopedMap map = map_with_loops(std::move(drive.input), options);
  const auto loops = drawn_loops(map, 4, 1);
  ASSERT_FALSE(loops.empty());
  for (const std::size_t loop : loops) {
    const RemovedLoop removed = remove_loop(map, loop, loop == loops.front(), options);
    EXPECT_LT(removed.position, 3.0);
    EXPECT_LT(removed.heading, 3.0);
  }
}

}  // namespace
}  // namespace roadbook
