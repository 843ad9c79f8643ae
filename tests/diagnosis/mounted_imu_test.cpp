#include <gtest/gtest.h>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

// Readings of an IMU that is mounted with x down and y backwards and stamps 0.1 s too early.
void mount_otherwise(Recording& recording) {
  for (ImuReading& r : recording.imu) {
    r.t_ns -= 100'000'000;
    for (Eigen::Vector3d* v : {&r.angular_velocity_rad_s, &r.specific_force_m_s2})
      *v = Eigen::Vector3d(-v->z(), -v->x(), v->y());
  }
}

void state_mounting(const fs::path& drive) {
  write_text(drive / "imu0/sensor.yaml",
             "sensor_type: imu\n"
             "T_BS: [[0, -1, 0, 0.7], [0, 0, 1, -0.2], [-1, 0, 0, 0.4], [0, 0, 0, 1]]\n"
             "time_offset: 0.1\n");
}

// A correct T_BS and time_offset change no result; no latency is found.
TEST(MountedImu, HoweverItIsMountedAndStampedTheSameIsFound) {
  HiddenDriveOptions options;
  options.length_m = 150.0;
  options.secret["imu0.gyro_bias"] = 0.004;
  Recording recording = record_drive(options);
  const TemporaryFolder folder;
  write_recording(recording, folder.path() / "straight");
  mount_otherwise(recording);
  write_recording(recording, folder.path() / "aside");
  state_mounting(folder.path() / "aside");

  const Diagnosis straight = diagnose(motion_streams(Drive::open(folder.path() / "straight")), "a");
  const Diagnosis aside = diagnose(motion_streams(Drive::open(folder.path() / "aside")), "b");
  ASSERT_EQ(straight.causes.size(), 1U);
  EXPECT_EQ(straight.causes[0].effect, "imu0.gyro_bias");
  ASSERT_EQ(aside.causes.size(), 1U);
  EXPECT_EQ(aside.causes[0].effect, "imu0.gyro_bias");
  EXPECT_EQ(aside.causes[0].size, straight.causes[0].size);
  EXPECT_EQ(aside.causes[0].gain.total, straight.causes[0].gain.total);
  EXPECT_TRUE(aside.unknown.empty());
}

// Correct stamps with a stated offset of 0.1 s: the readings then show the past.
TEST(MountedImu, AStatedOffsetThatIsNoneIsFoundAsLatency) {
  HiddenDriveOptions options;
  options.length_m = 150.0;
  const TemporaryFolder folder;
  write_recording(record_drive(options), folder.path() / "d");
  write_text(folder.path() / "d/imu0/sensor.yaml", "sensor_type: imu\ntime_offset: 0.1\n");
  const Diagnosis found = diagnose(motion_streams(Drive::open(folder.path() / "d")), "d");
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].effect, "imu0.latency");
  EXPECT_NEAR(found.causes[0].size, 0.1, 0.005);
}

}  // namespace
}  // namespace roadbook::test
