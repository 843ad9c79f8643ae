#include <numbers>

#include "drive/tables.hpp"
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

}  // namespace
}  // namespace roadbook::test
