#include <cmath>
#include <utility>
#include <vector>

#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

constexpr std::int64_t kLateNs = 250'000'000;

TEST(StatedMounting, AnImuOnItsSideIsReadAboutTheVehiclesAxesAndOnItsClock) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  // The forward axis is the negative y of the sensor, left is its z, and up is its negative x.
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

// By hand: the left axis of a mount that is rolled points up by the sine, its up axis to the right.
TEST(StatedMounting, AKnownTiltOfTheImuIsTakenOut) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  std::vector<ImuReading> read, right;
  Drive drive = Drive::open(d);
  drive.for_each_imu_reading([&](const ImuReading& r) { read.push_back(r); });
  drive.correct({{"imu0.tilt_roll", 0.5}});
  drive.for_each_imu_reading([&](const ImuReading& r) { right.push_back(r); });
  ASSERT_EQ(right.size(), read.size());
  const double s = std::sin(0.5), c = std::cos(0.5);
  for (std::size_t i = 0; i < read.size(); ++i)
    for (const auto& [raw, level] :
         {std::pair{read[i].angular_velocity_rad_s, right[i].angular_velocity_rad_s},
          std::pair{read[i].specific_force_m_s2, right[i].specific_force_m_s2}}) {
      EXPECT_DOUBLE_EQ(level.x(), raw.x());
      EXPECT_NEAR(level.y(), c * raw.y() - s * raw.z(), 1e-12);
      EXPECT_NEAR(level.z(), s * raw.y() + c * raw.z(), 1e-12);
    }
  for (const Problem& problem : drive.warnings())
    EXPECT_EQ(to_line(problem).find("tilt"), std::string::npos) << to_line(problem);
}

TEST(StatedMounting, OfAHingeInAModelItIsSaidWhyNothingIsCorrectedByIt) {
  const TemporaryFolder folder;
  Drive drive = Drive::open(write_small_drive(folder.path() / "d"));
  drive.correct({{"ground.hinge", 0.07}});
  std::string said;
  for (const Problem& problem : drive.warnings()) said += to_line(problem);
  EXPECT_NE(said.find("ground.hinge, which is not corrected for"), std::string::npos) << said;
  EXPECT_NE(said.find("a map measures it itself"), std::string::npos) << said;
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

// Writes `lines` into a sensor.yaml in place of its time offset.
void state_times(const fs::path& yaml, const std::string& lines) {
  std::string text = read_text(yaml);
  if (const auto at = text.find("time_offset"); at != std::string::npos)
    text.erase(at, text.find('\n', at) + 1 - at);
  write_text(yaml, text + lines);
}

// The tables of both cameras are late by a quarter of a second; the offset takes it off.
TEST(StatedMounting, ImagesAreReadOnTheSharedClock) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  for (const char* const camera : {"cam0", "cam1"}) {
    state_times(d / camera / "sensor.yaml", "time_offset: -0.25\n");
    std::string late;
    std::istringstream rows(read_text(d / camera / "data.csv"));
    for (std::string row; std::getline(rows, row);) {
      const auto comma = row.find(',');
      late += row.front() == '#'
                  ? row
                  : std::to_string(std::stoll(row.substr(0, comma)) + kLateNs) + row.substr(comma);
      late += '\n';
    }
    write_text(d / camera / "data.csv", late);
  }
  const Drive drive = Drive::open(d);
  ASSERT_EQ(drive.frame_count(), static_cast<std::size_t>(kFrames));
  for (std::size_t i = 0; i < drive.frame_count(); ++i) {
    const std::int64_t true_ns = kStart + static_cast<std::int64_t>(i) * kFrame;
    EXPECT_EQ(drive.frame_stamp_ns(i), true_ns);
    EXPECT_EQ(drive.written_stamp_ns(i, 1), true_ns + kLateNs);
    EXPECT_TRUE(fs::exists(drive.image_path(i, 1))) << drive.image_path(i, 1);
    EXPECT_FALSE(drive.read_image(i, 0).empty());
  }
}

// Triggered together, cam1 stamps its images 30 ms late: they stay images of the same instants.
TEST(StatedMounting, ImagesOfOneTriggerStayTogetherWhereTheirClocksDiffer) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  state_times(d / "cam0/sensor.yaml", "");
  state_times(d / "cam1/sensor.yaml", "time_offset: -0.03\nrolling_shutter: 0.02\n");
  Drive drive = Drive::open(d);
  ASSERT_EQ(drive.frame_count(), static_cast<std::size_t>(kFrames));
  EXPECT_TRUE(drive.has_image(3, 0));
  EXPECT_TRUE(drive.has_image(3, 1));
  EXPECT_EQ(drive.image_stamp_ns(3, 1), drive.frame_stamp_ns(3));
  EXPECT_EQ(drive.written_stamp_ns(3, 1), kStart + 3 * kFrame);
  EXPECT_FALSE(drive.read_image(3, 1).empty());
  EXPECT_DOUBLE_EQ(drive.rig().cameras[1].exposed_after_s, -0.03);
  EXPECT_DOUBLE_EQ(drive.rig().cameras[1].rolling_shutter_s, 0.02);
  EXPECT_EQ(drive.rig().cameras[0].exposed_after_s, 0.0);
  // A latency of all images moves the other sensors, that of one camera its exposure.
  drive.correct({{"cam.latency", 0.5}, {"cam1.latency", 0.01}, {"cam0.rolling_shutter", 0.005}});
  EXPECT_DOUBLE_EQ(drive.rig().cameras[1].exposed_after_s, -0.04);
  EXPECT_DOUBLE_EQ(drive.rig().cameras[1].rolling_shutter_s, 0.02);
  EXPECT_EQ(drive.rig().cameras[0].exposed_after_s, 0.0);
  EXPECT_DOUBLE_EQ(drive.rig().cameras[0].rolling_shutter_s, 0.005);
}

// The poses belong to another body, 1.5 m ahead and turned to the left, with a late clock.
TEST(StatedMounting, ReferencePosesOfAnotherBodyBecomeThoseOfTheVehicle) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  write_text(d / "state_groundtruth_estimate0/sensor.yaml",
             "sensor_type: visual-inertial\n"
             "T_BS: [[0, -1, 0, 1.5], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n"
             "time_offset: 0.25\n");
  const std::vector<TimedPose> poses = Drive::open(d).truth();
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(kFrames));
  Eigen::Isometry3d T_vehicle_body = Eigen::Isometry3d::Identity();
  T_vehicle_body.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  T_vehicle_body.translation() << 1.5, 0, 0;
  for (int i = 0; i < kFrames; ++i) {
    const TimedPose& pose = poses[static_cast<std::size_t>(i)];
    EXPECT_EQ(pose.t_ns, kStart + i * kFrame + kLateNs);
    EXPECT_TRUE((pose.T_world_vehicle * T_vehicle_body).isApprox(pose_at(i).T_world_vehicle, 1e-9));
  }
}

TEST(StatedMounting, ADetectorsOwnMountingOrClockIsRefused) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  const auto problem = [&](const std::string& yaml) {
    write_text(d / "detector0/sensor.yaml", "sensor_type: detector\n" + yaml);
    try {
      static_cast<void>(Drive::open(d));
    } catch (const BadInput& bad) {
      return bad.problems().front().want;
    }
    return std::string("accepted");
  };
  const std::string want = "none: detections lie in a camera's images and carry their stamps";
  EXPECT_EQ(problem("time_offset: 0.25\n"), want);
  EXPECT_EQ(problem("T_BS: [[1, 0, 0, 0.7], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n"), want);
  EXPECT_EQ(problem("time_offset: 0\n"), "accepted");
}

// The images are late, so the correction moves all other streams by the same time.
TEST(StatedMounting, KnownLatencyOfTheCamerasIsTakenOutOfEveryOtherStream) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  write_text(d / "range0/data.csv",
             "#timestamp [ns],beam,range [m]\n" + std::to_string(kStart) + ",0,2.5\n");
  write_text(d / "range0/sensor.yaml",
             "sensor_type: range\nbeam_azimuths: [0.1]\nmax_range: 9\nsigma: 0.02\n"
             "time_offset: 0.01\n");
  Drive drive = Drive::open(d);
  drive.correct({{"cam.latency", 0.25}});
  EXPECT_EQ(drive.wheel_model()->time_offset_s, 0.25);
  ASSERT_TRUE(drive.range_model());
  EXPECT_DOUBLE_EQ(drive.range_model()->time_offset_s, 0.26);
  int imu = 0, friction = 0;
  drive.for_each_imu_reading(
      [&](const ImuReading& r) { EXPECT_EQ(r.t_ns, kStart + imu++ * kFrame + kLateNs); });
  drive.for_each_friction_reading(
      [&](const FrictionReading& r) { EXPECT_EQ(r.t_ns, kStart + friction++ * kFrame + kLateNs); });
  EXPECT_EQ(imu, kFrames);
  EXPECT_EQ(friction, kFrames);
}

// Drives without images: drifting clocks agree at the first pose.
TEST(StatedMounting, WithoutImagesWhatIsKnownIsTakenOutAsWell) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  for (const char* images : {"cam0", "cam1", "segmentation1"}) fs::remove_all(d / images);
  Drive drive = Drive::open(d);
  ASSERT_EQ(drive.frame_count(), 0U);
  drive.correct({{"clock.drift", 0.001}, {"imu0.latency", 0.25}, {"steering0.offset", 0.01}});
  int i = 0;
  drive.for_each_wheel_reading([&](const WheelReading& r) {
    const WheelReading written = wheels_at(i++);
    const auto since = static_cast<double>(written.t_ns - kStart);
    EXPECT_NEAR(static_cast<double>(r.t_ns - kStart), since / 1.001, 1.0);
    EXPECT_NEAR(r.left_angle_rad, written.left_angle_rad, 1e-9);
    EXPECT_NEAR(r.steering_rad.value_or(0.0), written.steering_rad.value_or(0.01) - 0.01, 1e-9);
  });
  EXPECT_EQ(i, 4 * kFrames);
  i = 0;
  drive.for_each_imu_reading([&](const ImuReading& r) {
    const double since = static_cast<double>(i++ * kFrame) / 1.001;
    EXPECT_NEAR(static_cast<double>(r.t_ns - kStart), since - static_cast<double>(kLateNs), 1.0);
  });
}

// Without images and poses, no reference clock exists.
TEST(StatedMounting, WithoutImagesAndPosesStampsStayAsTheyAre) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  for (const char* gone : {"cam0", "cam1", "segmentation1", "state_groundtruth_estimate0"})
    fs::remove_all(d / gone);
  Drive drive = Drive::open(d);
  drive.correct({{"clock.drift", 0.001}});
  int i = 0;
  for (const WheelReading& r : drive.wheel_readings()) EXPECT_EQ(r.t_ns, wheels_at(i++).t_ns);
  EXPECT_EQ(i, 4 * kFrames);
}

}  // namespace
}  // namespace roadbook::test
