#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

constexpr std::int64_t kLateNs = 250'000'000;

TEST(StatedMounting, AnImuOnItsSideIsReadAboutTheVehiclesAxesAndOnItsClock) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  // Forward is where the sensor's y points backwards, left is its z, up is its x downwards.
  write_text(d / "imu0/sensor.yaml",
             "sensor_type: imu\n"
             "T_BS: [[0, -1, 0, 0.7], [0, 0, 1, -0.2], [-1, 0, 0, 0.4], [0, 0, 0, 1]]\n"
             "time_offset: 0.25\n");
  int i = 0;
  Drive::open(d).for_each_imu_reading([&](const ImuReading& r) {
    EXPECT_EQ(r.t_ns, kStart + i * kFrame + kLateNs);
    EXPECT_EQ(r.angular_velocity_rad_s, Eigen::Vector3d(-0.2, 0.3, -0.1 * i));
    EXPECT_EQ(r.specific_force_m_s2, Eigen::Vector3d(-0.5, 9.81, -0.4));
    ++i;
  });
  EXPECT_EQ(i, kFrames);
}

TEST(StatedMounting, KnownErrorsOfAGyroAreTakenOutAboutTheVehiclesUpAxis) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  write_text(d / "imu0/sensor.yaml",
             "sensor_type: imu\n"
             "T_BS: [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]\n");
  Drive drive = Drive::open(d);
  drive.correct({{"imu0.gyro_bias", 0.1}});
  drive.for_each_imu_reading(
      [&](const ImuReading& r) { EXPECT_DOUBLE_EQ(r.angular_velocity_rad_s.z(), -0.4); });
}

TEST(StatedMounting, FrictionIsReadOnTheVehiclesClock) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  write_text(d / "friction0/sensor.yaml", "sensor_type: friction\ntime_offset: 0.25\n");
  int i = 0;
  Drive::open(d).for_each_friction_reading([&](const FrictionReading& r) {
    EXPECT_EQ(r.t_ns, kStart + i * kFrame + kLateNs);
    EXPECT_EQ(r.sigma, 0.05 + i++);
  });
  EXPECT_EQ(i, kFrames);
}

}  // namespace
}  // namespace roadbook::test
