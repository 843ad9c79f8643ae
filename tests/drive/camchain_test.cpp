#include "drive/camchain.hpp"

#include "sensors/calibration/calibration_io.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

// Writes a camera chain of the drive's rig after `change`, and returns the errors of opening the
// drive.
template <typename Change>
std::string faults(const Change& change) {
  const TemporaryFolder folder;
  const fs::path drive = write_small_drive(folder.path() / "d");
  Rig rig = small_rig();
  change(rig);
  write_text(drive / "camchain.yaml", kalibr_camchain_text(rig));
  return all_lines(check_drive(drive));
}

TEST(Camchain, OfTheSameRigAgreesWithTheSensorFiles) {
  EXPECT_EQ(faults([](Rig&) {}), "");
}

TEST(Camchain, ThatDiffersIsAnErrorThatNamesFileCameraAndField) {
  const auto focal = faults([](Rig& rig) { rig.cameras[1].camera.parameters[1] *= 1.0 + 2e-6; });
  EXPECT_NE(focal.find("camchain.yaml: cam1.intrinsics: got "), std::string::npos) << focal;
  const auto distortion = faults([](Rig& rig) { rig.cameras[0].camera.parameters[7] = 0.2; });
  EXPECT_NE(distortion.find("cam0.distortion_coeffs: got 0.2, want 0.1 as in sensor.yaml"),
            std::string::npos)
      << distortion;
  const auto pose =
      faults([](Rig& rig) { rig.cameras[0].T_vehicle_camera.translation().y() += 2e-6; });
  EXPECT_NE(pose.find("cam0.T_cam_imu"), std::string::npos) << pose;
  const auto time = faults([](Rig& rig) { rig.cameras[1].time_offset_s += 1e-5; });
  EXPECT_NE(time.find("cam1.timeshift_cam_imu"), std::string::npos) << time;
  const auto size = faults([](Rig& rig) { rig.cameras[1].camera.width = 17; });
  EXPECT_NE(size.find("cam1.resolution: got 17x12, want 16x12"), std::string::npos) << size;
}

TEST(Camchain, WithoutOneOfTheCamerasIsAWarning) {
  const auto text = faults([](Rig& rig) { rig.cameras.pop_back(); });
  EXPECT_TRUE(text.starts_with("warning: ")) << text;
  EXPECT_NE(text.find("cam1"), std::string::npos);
}

// Kalibr writes no timeshift_cam_imu where it calibrated the cameras without an IMU.
TEST(Camchain, WithoutATimeOffsetSaysNothingOfTime) {
  const TemporaryFolder folder;
  const fs::path drive = write_small_drive(folder.path() / "d");
  Rig rig = small_rig();
  ASSERT_NE(rig.cameras[1].time_offset_s, 0.0);
  std::string text = kalibr_camchain_text(rig);
  for (std::size_t at; (at = text.find("  timeshift_cam_imu")) != std::string::npos;)
    text.erase(at, text.find('\n', at) + 1 - at);
  write_text(drive / "camchain.yaml", text);
  EXPECT_EQ(all_lines(check_drive(drive)), "");
  rig.cameras[1].time_offset_s = 0.0;
  write_text(drive / "camchain.yaml", kalibr_camchain_text(rig));
  EXPECT_NE(all_lines(check_drive(drive)).find("error: "), std::string::npos);
}

// The files of an earlier calibration often stay in the folder.
TEST(Camchain, OfWhichOneAgreesTurnsTheFaultsOfTheOthersIntoWarnings) {
  const TemporaryFolder folder;
  const fs::path drive = write_small_drive(folder.path() / "d");
  Rig rig = small_rig();
  rig.cameras[0].camera.parameters[0] *= 1.1;
  write_text(drive / "2021-camchain.yaml", kalibr_camchain_text(rig));
  const auto alone = all_lines(check_drive(drive));
  EXPECT_TRUE(alone.starts_with("error: ")) << alone;
  write_text(drive / "2022-camchain.yaml", kalibr_camchain_text(small_rig()));
  const auto both = all_lines(check_drive(drive));
  EXPECT_EQ(both.find("error: "), std::string::npos) << both;
  EXPECT_NE(both.find("2021-camchain.yaml: cam0.intrinsics: got 11.11, want 10.1"),
            std::string::npos)
      << both;
}

// Kalibr writes a file of the cameras alone first, and one with times and the body later.
TEST(Camchain, ThatStatesLessDoesNotExcuseTheFaultsOfAnother) {
  const TemporaryFolder folder;
  const fs::path drive = write_small_drive(folder.path() / "d");
  Rig rig = small_rig();
  std::string without_times = kalibr_camchain_text(rig);
  for (std::size_t at; (at = without_times.find("  timeshift_cam_imu")) != std::string::npos;)
    without_times.erase(at, without_times.find('\n', at) + 1 - at);
  write_text(drive / "bag-camchain.yaml", without_times);
  rig.cameras[1].time_offset_s += 0.02;
  write_text(drive / "bag-camchain-imucam.yaml", kalibr_camchain_text(rig));
  const auto text = all_lines(check_drive(drive));
  EXPECT_NE(text.find("error: " + (drive / "bag-camchain-imucam.yaml").string() +
                      ": cam1.timeshift_cam_imu"),
            std::string::npos)
      << text;
}

// Kalibr's own file names.
TEST(Camchain, UnderTheNamesThatKalibrGivesIsReadAndCompared) {
  for (const char* const name : {"camchain-imucam-bag.yaml", "camchain-2021-01-01.yaml",
                                 "bag-camchain.yaml", "bag-camchain-imucam.yaml"})
    for (const bool beside_mav0 : {false, true}) {
      const TemporaryFolder folder;
      write_small_drive(folder.path() / "d" / "mav0");
      Rig rig = small_rig();
      rig.cameras[0].camera.parameters[0] *= 2.0;
      write_text(folder.path() / (beside_mav0 ? "d" : "d/mav0") / name, kalibr_camchain_text(rig));
      const auto text = all_lines(check_drive(folder.path() / "d"));
      EXPECT_NE(text.find(std::string(name) + ": cam0.intrinsics: got 20.2, want 10.1"),
                std::string::npos)
          << text;
    }
  EXPECT_FALSE(is_camchain_name("notcamchain.yaml"));
  EXPECT_FALSE(is_camchain_name("camchains.yaml"));
}

}  // namespace
}  // namespace roadbook::test
