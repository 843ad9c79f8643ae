#include <cmath>
#include <initializer_list>
#include <numbers>

#include "drive/tables.hpp"
#include "sensors/calibration/calibration_fields.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

std::vector<WheelReading> read(const std::string& text,
                               const WheelModel& model,
                               std::string* faults = nullptr) {
  const TemporaryFolder folder;
  write_text(folder.path() / "data.csv", text);
  ProblemList problems;
  std::vector<WheelReading> rows;
  (void)read_wheel_table(folder.path() / "data.csv", model, {}, problems,
                         [&](const WheelReading& r) { rows.push_back(r); });
  for (const auto& p : problems.problems())
    if (faults != nullptr) *faults += to_line(p) + "\n";
  return rows;
}

TEST(WheelTable, ColumnsCountByNameInAnyOrder) {
  const auto rows =
      read("#rear_right_angle [deg],timestamp [ns],rear_left_angle [rad]\n180,5,2\n", {});
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].t_ns, 5);
  EXPECT_EQ(rows[0].left_angle_rad, 2.0);
  EXPECT_DOUBLE_EQ(rows[0].right_angle_rad, std::numbers::pi);
}

TEST(WheelTable, SpeedsThatGrowLinearlyIntegrateToTheSquareOfTime) {
  WheelModel model;
  model.radius_left_m = 0.5;
  std::string text = "#timestamp [ns],rear_left_speed [m s^-1],rear_right_speed [rad s^-1]\n";
  for (int i = 0; i <= 50; ++i)
    text += std::to_string(std::int64_t{i} * 20'000'000) + "," + std::to_string(0.02 * i) + "," +
            std::to_string(0.04 * i) + "\n";
  const auto rows = read(text, model);
  // v = t [m/s], so s = t^2 / 2 = 0.5 m after 1 s; the trapezoid rule is exact for it.
  EXPECT_NEAR(rows.back().left_angle_rad, 0.5 / 0.5, 1e-12);
  EXPECT_NEAR(rows.back().right_angle_rad, 1.0, 1e-12);
}

TEST(WheelTable, TicksNeedTicksPerTurn) {
  const std::string text =
      "#timestamp [ns],rear_left_ticks [],rear_right_ticks []\n0,0,0\n20000000,512,1024\n";
  WheelModel model;
  std::string faults;
  EXPECT_TRUE(read(text, model, &faults).empty());
  EXPECT_NE(faults.find("ticks_per_turn"), std::string::npos);
  model.ticks_per_turn = 1024;
  const auto rows = read(text, model);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_DOUBLE_EQ(rows[1].left_angle_rad, std::numbers::pi);
  EXPECT_DOUBLE_EQ(rows[1].right_angle_rad, 2.0 * std::numbers::pi);
}

TEST(WheelTable, CountersOfSixteenAndThirtyTwoBitsGoOnWhereTheyWrap) {
  WheelModel model;
  model.ticks_per_turn = 1024;
  constexpr std::int64_t kStep = 300;  // forwards on the left, backwards on the right
  for (const std::int64_t range : {std::int64_t{1} << 16, std::int64_t{1} << 32}) {
    std::string text = "#timestamp [ns],rear_left_ticks [],rear_right_ticks []\n";
    for (int i = 0; i < 500; ++i) {
      const std::int64_t left = (range - 1000 + i * kStep) % range;
      const std::int64_t right = ((1000 - i * kStep) % range + range) % range;
      text += std::to_string(std::int64_t{i} * 10'000'000) + "," + std::to_string(left) + "," +
              std::to_string(right) + "\n";
    }
    const auto rows = read(text, model);
    ASSERT_EQ(rows.size(), 500u);
    const double radians = 499 * kStep * 2.0 * std::numbers::pi / 1024;
    // Angles of 2^32 ticks have 53 bits: one part in 2^52 of 2.6e7 rad.
    EXPECT_NEAR(rows.back().left_angle_rad - rows[0].left_angle_rad, radians, 1e-7);
    EXPECT_NEAR(rows.back().right_angle_rad - rows[0].right_angle_rad, -radians, 1e-7);
  }
}

TEST(WheelTable, ALongWayAfterAGapIsNoWrap) {
  WheelModel model;
  model.ticks_per_turn = 4096;
  // 60000 ticks of 0.3 m wheels are 27.6 m, which a car does in 2 s.
  const auto rows = read(
      "#timestamp [ns],rear_left_ticks [],rear_right_ticks []\n0,0,0\n2000000000,60000,60000\n",
      model);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_DOUBLE_EQ(rows[1].left_angle_rad, 60000 * 2.0 * std::numbers::pi / 4096);
}

TEST(WheelTable, TheSteeringWheelGoesThroughTheRatioAndAnEmptyCellIsAbsent) {
  WheelModel model;
  model.steering_ratio = 16.0;
  const auto rows = read(
      "#timestamp [ns],rear_left_angle [rad],rear_right_angle [rad],steering_wheel_angle [deg]\n"
      "0,0,0,180\n20000000,1,1,\n",
      model);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_DOUBLE_EQ(*rows[0].steering_rad, std::numbers::pi / 16.0);
  EXPECT_FALSE(rows[1].steering_rad);
}

// The wheels of a car on a circle of 12 m to the left at 3 m/s (middle of the rear axle), by hand:
// every wheel's speed is its distance from the centre times the yaw rate.
struct Circle {
  WheelModel model;
  double yaw_rate = 3.0 / 12.0;
  double rear_left = yaw_rate * (12.0 - 0.75);
  double rear_right = yaw_rate * (12.0 + 0.75);
  double front_left = yaw_rate * std::hypot(12.0 - 0.75, 2.6);
  double front_right = yaw_rate * std::hypot(12.0 + 0.75, 2.6);
  double steering = std::atan(2.6 / 12.0);
};

std::string cells(std::initializer_list<std::string> fields) {
  std::string row;
  for (const auto& field : fields) row += (row.empty() ? "" : ",") + field;
  return row + "\n";
}

TEST(WheelTable, FourSpeedsGiveTheRearWheelsAndTheFrontOnesWhereThoseAreAbsent) {
  const Circle c;
  std::string text =
      "#timestamp [ns],v_FL [m s^-1],v_FR [m s^-1],v_RL [m s^-1],v_RR [m s^-1],steering [rad]\n";
  for (int i = 0; i <= 100; ++i) {
    const bool rear = i % 3 != 0;
    text += cells({std::to_string(i * 10'000'000), decimal(c.front_left), decimal(c.front_right),
                   rear ? decimal(c.rear_left) : "", rear ? decimal(c.rear_right) : "",
                   decimal(c.steering)});
  }
  const auto rows = read(text, c.model);
  ASSERT_EQ(rows.size(), 101u);
  EXPECT_NEAR(rows.back().left_angle_rad, c.rear_left / c.model.radius_left_m, 1e-11);
  EXPECT_NEAR(rows.back().right_angle_rad, c.rear_right / c.model.radius_right_m, 1e-11);
  EXPECT_DOUBLE_EQ(rows.back().steering_rad.value(), c.steering);
}

TEST(WheelTable, FrontSpeedsAloneDo) {
  const Circle c;
  std::string text = "#timestamp [ns],v_FL [m s^-1],v_FR [m s^-1],steering_angle [rad]\n";
  for (int i = 0; i <= 10; ++i)
    text += cells({std::to_string(i * 100'000'000), decimal(c.front_left), decimal(c.front_right),
                   decimal(c.steering)});
  const auto rows = read(text, c.model);
  ASSERT_EQ(rows.size(), 11u);
  EXPECT_NEAR(rows.back().left_angle_rad, c.rear_left / c.model.radius_left_m, 1e-11);
  EXPECT_NEAR(rows.back().right_angle_rad, c.rear_right / c.model.radius_right_m, 1e-11);
}

TEST(WheelTable, TicksUnderTheShortNamesCount) {
  WheelModel model;
  model.ticks_per_turn = 1024;
  const auto rows =
      read("#timestamp [ns],ticks_RL [],ticks_RR []\n0,0,0\n20000000,512,1024\n", model);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_DOUBLE_EQ(rows[1].left_angle_rad, std::numbers::pi);
  EXPECT_DOUBLE_EQ(rows[1].right_angle_rad, 2.0 * std::numbers::pi);
}

TEST(WheelTable, ARowWithAnEmptyWheelIsBridgedByItsNeighbours) {
  const auto rows = read(
      "#timestamp [ns],rear_left_speed [rad s^-1],rear_right_speed [rad s^-1]\n"
      "0,1,2\n100000000,,2\n200000000,1,2\n",
      {});
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NEAR(rows[1].left_angle_rad, 0.2, 1e-15);
  EXPECT_NEAR(rows[1].right_angle_rad, 0.4, 1e-15);
}

TEST(WheelTable, NothingButEmptyWheelsAndCellsThatAreNoNumberAreErrors) {
  std::string faults;
  EXPECT_TRUE(
      read("#timestamp [ns],v_RL [m s^-1],v_RR [m s^-1]\n0,,\n10000000,,\n", {}, &faults).empty());
  EXPECT_NE(faults.find("no row with both wheels"), std::string::npos) << faults;
  faults.clear();
  (void)read("#timestamp [ns],v_RL [m s^-1],v_RR [m s^-1]\n0,1,1\n10000000,x,1\n", {}, &faults);
  EXPECT_NE(faults.find("data.csv:3: v_RL: got x"), std::string::npos) << faults;
  faults.clear();
  (void)read("#timestamp [ns],v_RL [km/h],v_RR [m s^-1]\n0,1,1\n", {}, &faults);
  EXPECT_NE(faults.find("v_RL"), std::string::npos) << faults;
}

}  // namespace
}  // namespace roadbook::test
