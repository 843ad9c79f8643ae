#include "workflows/diagnosis/motion_doubts.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"
#include "tests/diagnosis/hidden_effects/seed_of_today.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook {
namespace {

// A map whose poses are right to 1 cm, every fourth pose a keyframe, and the drive that it is of.
struct Mapped {
  Map map;
  Drive drive;
};

Mapped mapped(const test::HiddenDriveOptions& hidden, const std::filesystem::path& folder) {
  const test::Recording recording = test::record_drive(hidden);
  test::write_recording(recording, folder);
  Mapped m{{}, Drive::open(folder)};
  m.map.map_frames.emplace_back();
  m.map.sessions.emplace_back();
  m.map.sessions[0].drive_digest = m.drive.digest();
  for (std::size_t i = 0; i < recording.poses.size(); i += 4) {
    Keyframe keyframe;
    keyframe.t_ns = recording.poses[i].t_ns;
    keyframe.T_frame_vehicle = recording.poses[i].T_world_vehicle;
    m.map.keyframes.push_back(keyframe);
  }
  return m;
}

test::HiddenDriveOptions drive_with(const std::string& effect, double size, std::uint64_t index) {
  test::HiddenDriveOptions hidden;
  hidden.seed = Random(test::seed_of_today(), "motion doubts", index)() >> 1U;
  hidden.pose_sigma_m = 0.01;
  hidden.pose_sigma_rad = 0.001;
  if (!effect.empty()) hidden.secret[effect] = size;
  return hidden;
}

TEST(MotionDoubts, NameTheSensorWithTheSizeAndItsSign) {
  struct Case {
    std::string effect;
    double size;
    std::string file, says;
  };
  for (const Case& c :
       {Case{"wheels0.left_radius", -0.02, "wheels0", "the left rear wheel is smaller than stated"},
        Case{"wheels0.right_radius", 0.02, "wheels0", "the right rear wheel is larger than stated"},
        Case{"wheels0.latency", 0.1, "wheels0", "the wheels are stamped too late"},
        Case{"imu0.gyro_bias", -0.005, "imu0", "the gyro reads a right turn at rest"}}) {
    SCOPED_TRACE(c.effect);
    const test::TemporaryFolder folder;
    const Mapped m = mapped(drive_with(c.effect, c.size, 0), folder.path() / "drive");
    const std::vector<Problem> doubts = motion_doubts(m.map, m.drive, {});
    ASSERT_EQ(doubts.size(), 1U);
    EXPECT_EQ(doubts[0].severity, Severity::kWarning);
    EXPECT_EQ(doubts[0].file, (folder.path() / "drive" / c.file).string());
    EXPECT_EQ(c.file + "." + doubts[0].field, c.effect);
    EXPECT_NE(doubts[0].got.find(c.says + ", "), std::string::npos) << doubts[0].got;
    // The model that corrects it leaves nothing.
    EXPECT_TRUE(motion_doubts(m.map, m.drive, {{c.effect, c.size}}).empty());
  }
}

// The poses carry the stamps of late images; a model that knows it leaves nothing, without a gyro
// too.
TEST(MotionDoubts, OfImagesThatTheModelKnowsToBeLateSayNothingOfTheWheels) {
  for (const bool with_gyro : {true, false}) {
    const test::TemporaryFolder folder;
    Mapped m = mapped(drive_with("", 0.0, 1), folder.path() / "drive");
    if (!with_gyro) {
      std::filesystem::remove_all(folder.path() / "drive/imu0");
      m.drive = Drive::open(folder.path() / "drive");
      m.map.sessions[0].drive_digest = m.drive.digest();
    }
    for (Keyframe& keyframe : m.map.keyframes) keyframe.t_ns += 100'000'000;
    for (const Problem& p : motion_doubts(m.map, m.drive, {{"cam.latency", 0.1}}))
      ADD_FAILURE() << to_line(p);
    const auto doubts = motion_doubts(m.map, m.drive, {});
    for (const Problem& p : doubts)
      EXPECT_NE(p.got.find("looks the same"), std::string::npos) << to_line(p);
  }
}

TEST(MotionDoubts, OfASoundDriveOrAnotherDriveSayNothing) {
  for (std::uint64_t i = 0; i < 3; ++i) {
    const test::TemporaryFolder folder;
    const Mapped m = mapped(drive_with("", 0.0, i), folder.path() / "drive");
    for (const Problem& p : motion_doubts(m.map, m.drive, {})) ADD_FAILURE() << to_line(p);
  }
  const test::TemporaryFolder folder;
  Mapped m = mapped(drive_with("wheels0.left_radius", -0.02, 0), folder.path() / "drive");
  m.map.sessions[0].drive_digest = "of another drive";
  EXPECT_TRUE(motion_doubts(m.map, m.drive, {}).empty());
}

// The poses of the second half jump away from the truth, but lie more than 400 m from the start.
TEST(MotionDoubts, CompareTheFirst400MetresAlone) {
  const test::TemporaryFolder folder;
  Mapped m = mapped(drive_with("wheels0.left_radius", -0.02, 0), folder.path() / "drive");
  auto& keyframes = m.map.keyframes;
  for (std::size_t k = keyframes.size() / 2; k < keyframes.size(); ++k) {
    keyframes[k].travelled_m = 401.0;
    keyframes[k].T_frame_vehicle.translation() += Eigen::Vector3d(5.0, 1.0, 0.0);
  }
  const std::vector<Problem> doubts = motion_doubts(m.map, m.drive, {});
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].field, "left_radius");
  keyframes.resize(keyframes.size() / 2);
  const std::vector<Problem> without = motion_doubts(m.map, m.drive, {});
  ASSERT_EQ(without.size(), 1U);
  EXPECT_EQ(without[0].got, doubts[0].got);
  for (Keyframe& keyframe : keyframes) keyframe.travelled_m = 401.0;
  EXPECT_TRUE(motion_doubts(m.map, m.drive, {}).empty());
}

}  // namespace
}  // namespace roadbook
