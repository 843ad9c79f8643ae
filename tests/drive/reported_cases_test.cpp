#include <cstdlib>
#include <numbers>

#include "tests/drive/foreign_recordings.hpp"
#include "tests/support/source_tree.hpp"

namespace roadbook::test {
namespace {

// Small recordings that an earlier version read wrongly, one folder for each fault: `shared/cases`
// next to the source tree or next to $ROADBOOK_DATA. Other tests generate inputs of the same kinds;
// these tests read the original files.

class ReportedCases : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const data = std::getenv("ROADBOOK_DATA");
    cases_ = data != nullptr ? fs::path(data).parent_path() / "cases"
                             : source_tree().parent_path() / "shared" / "cases";
    if (!fs::exists(cases_ / "BH07")) GTEST_SKIP() << "no reported cases in " << cases_;
  }
  [[nodiscard]] ImportOutcome import_case(const std::string& format, const std::string& source) {
    return try_import(format, cases_ / source, folder_.path() / "out");
  }
  [[nodiscard]] std::string check_case(const std::string& drive) const {
    return all_lines(check_drive(cases_ / drive));
  }
  [[nodiscard]] fs::path out() const { return folder_.path() / "out"; }
  TemporaryFolder folder_;
  fs::path cases_;
};

const std::string kSequence = "/k360/data_2d_raw/2013_05_28_drive_0000_sync";

TEST_F(ReportedCases, OrderByNumber) {
  EXPECT_EQ(import_case("kitti", "BH07/seq").text, "");
  const auto values = greys(out());
  ASSERT_EQ(values.size(), 12u);
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(values[i], 10 * static_cast<int>(i) + 1);
}

TEST_F(ReportedCases, CalibrationOfAnotherImageSize) {
  EXPECT_FALSE(import_case("kitti", "BH08/seq").refused);
  ROADBOOK_EXPECT_TEXT(all_lines(check_drive(out())), "principal point (607.19, 185.22)");
}

TEST_F(ReportedCases, FrameThatWasLost) {
  EXPECT_FALSE(import_case("kitti360", "BH09" + kSequence).refused);
  const auto stamps = frame_stamps_ns(out());
  ASSERT_EQ(stamps.size(), 5u);
  EXPECT_EQ(stamps[2] - stamps[0], 300'000'000);
  const auto truth = Drive::open(out()).truth();
  ASSERT_EQ(truth.size(), 5u);
  EXPECT_EQ(truth[2].t_ns, stamps[2]);
  EXPECT_NEAR(truth[2].T_world_vehicle.translation().x(), 3.0, 1e-9);
}

TEST_F(ReportedCases, SteeringInDegrees) {
  ROADBOOK_EXPECT_TEXT(check_case("BH16"), "steering_angle: got 32.896");
}

TEST_F(ReportedCases, VideoLongerThanItsStamps) {
  ROADBOOK_EXPECT_TEXT(import_case("video", "BH17/recording").text, "frames: got 14 for 10 stamps");
}

TEST_F(ReportedCases, CounterThatBeginsAgain) {
  EXPECT_EQ(import_case("kaist", "BH24/kaist").text, "");
  const auto rows = Drive::open(out()).wheel_readings();
  for (std::size_t i = 1; i < rows.size(); ++i)
    EXPECT_NEAR(rows[i].left_angle_rad - rows[i - 1].left_angle_rad,
                40 * 2 * std::numbers::pi / 4096, 1e-6);
}

TEST_F(ReportedCases, ExtensionInCapitals) {
  EXPECT_FALSE(import_case("kitti360", "BH25" + kSequence).refused);
  EXPECT_EQ(frame_stamps_ns(out()).size(), 6u);
}

TEST_F(ReportedCases, Semicolons) {
  ROADBOOK_EXPECT_TEXT(import_case("euroc", "BH26/drive").text, "semicolons between them");
}

TEST_F(ReportedCases, RadiusInMillimetres) {
  ROADBOOK_EXPECT_TEXT(check_case("BH30"), "wheel_radius_left: got 310 m (millimetres?)");
}

TEST_F(ReportedCases, CamchainUnderKalibrsName) {
  ROADBOOK_EXPECT_TEXT(check_case("BH31/drive"), "camchain-imucam-bag.yaml: cam0.intrinsics: got");
}

}  // namespace
}  // namespace roadbook::test
