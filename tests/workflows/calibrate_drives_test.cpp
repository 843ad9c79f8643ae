#include "workflows/calibration/calibrate_drives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/messages.hpp"
#include "tests/apps/shared_drives.hpp"
#include "tests/mapping/calibration/calibrated_drive.hpp"
#include "workflows/settings/effect_model.hpp"

namespace roadbook {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// The drive is right as stated: a known model that turns a camera and shrinks the wheels is wrong,
// and what is found takes it back.
TEST(CalibrateDrives, FindsAWrongTurnAndRadiusInARenderedDrive) {
  const test::ScratchFolder folder;
  CalibrateRequest request;
  request.drives = {folder.path() / "drive"};
  request.model = folder.path() / "wrong.yaml";
  ASSERT_EQ(test::simulate_drive("zurich --size small --image-scale 0.5 --max-duration-s 20",
                                 request.drives[0])
                .status,
            0);
  test::write_text(request.model, "effects:\n  cam1.rotation: 0.0175\n  wheels0.radius: -0.02\n");
  NoMessages messages;
  const CalibrateResult result = calibrate_drives(request, messages);
  EXPECT_FALSE(result.refusal) << result.refusal->what();
  for (const auto& [name, most] :
       {std::pair("cam1.rotation", 0.25 * kDegree), std::pair("wheels0.radius", 0.008)}) {
    const CalibratedColumn* c = result.calibration.find(name);
    ASSERT_NE(c, nullptr) << name;
    EXPECT_LT(std::abs(c->value), most) << name;
    EXPECT_LT(std::abs(c->value), 2.0 * c->half_width) << name;
  }
  const CalibratedValue& turn = result.values[6];
  EXPECT_EQ(turn.column.column.name, "cam1.rotation");
  EXPECT_NEAR(turn.before, 0.0175 / kDegree, 1e-9);
  EXPECT_LT(result.calibration.reprojection_after_px, result.calibration.reprojection_before_px);

  // The text is a model file with the same effects.
  const auto file = folder.path() / "model.yaml";
  test::write_text(file, calibrated_model_text(result));
  EXPECT_EQ(read_effect_model(file), result.model);
}

TEST(CalibrateDrives, RefusesWhatAStraightDriveDoesNotTell) {
  test::CalibrationDriveOptions straight;
  straight.seconds = 20.0;
  straight.speed_change = 0.0;
  straight.curvature = 0.0;
  test::CalibrationDrive drive = test::calibration_drive({}, 3, straight);
  const EstimatedCalibration found = first_step(drive.data, Eigen::VectorXd::Zero(24));
  const auto refusal = refusal_of(found.columns, "monday");
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->status(), ExitStatus::kRefused);
  const std::string line = refusal->what();
  EXPECT_TRUE(line.starts_with("error: monday: calibration: got cam")) << line;
  EXPECT_NE(line.find(".latency +- "), std::string::npos) << line;
  EXPECT_NE(line.find("starts and stops"), std::string::npos) << line;
  auto columns = found.columns;
  for (CalibratedColumn& c : columns) c.observable = true;
  EXPECT_FALSE(refusal_of(columns, "monday"));
}

TEST(CalibrationRefusal, GivesTheIntervalsInTheUnitsOfTheUser) {
  std::vector<CalibratedColumn> columns(2);
  columns[0].column = {"cam1.latency", CalibrationKind::kImageDelay, 1};
  columns[0].half_width = 0.0123;
  columns[1].column = {"cam1.yaw", CalibrationKind::kYaw, 1};
  columns[1].half_width = 2.0 * kDegree;
  const auto refusal = refusal_of(columns, "monday");
  ASSERT_TRUE(refusal);
  const std::string line = refusal->what();
  EXPECT_NE(line.find("got cam1.latency +- 12.3 ms, cam1.yaw +- 2.00 deg (95 %)"),
            std::string::npos)
      << line;
}

}  // namespace
}  // namespace roadbook
