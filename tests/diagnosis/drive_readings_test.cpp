#include <gtest/gtest.h>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "drive/writer.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook {
namespace {

constexpr double kSpeed = 2.0;      // [m/s]
constexpr double kPosesLate = 0.4;  // [s]

std::int64_t stamp_after(double t_s) {
  return test::kStart + static_cast<std::int64_t>(std::llround(1e9 * t_s));
}

// A straight drive of 20 s. The stamps of the poses are late; the stamps of friction and of a beam
// to the left are right.
std::filesystem::path write_straight_drive(const std::filesystem::path& folder) {
  DriveWriter writer(folder, {}, std::nullopt);
  RangeModel model;
  model.azimuth_rad = {1.0};
  writer.set_range_model(model);
  std::vector<TimedPose> truth;
  for (int k = 0; k < 250; ++k) {
    const double t = 0.08 * k;
    TimedPose pose;
    pose.t_ns = stamp_after(t);
    pose.T_world_vehicle.translation().x() = kSpeed * (t - kPosesLate);
    truth.push_back(pose);
    writer.write_friction({stamp_after(t), 0.8, 0.05, 1, 20.0});
    writer.write_range({stamp_after(t), 0, 5.0});
  }
  writer.write_truth(truth);
  writer.finish();
  return folder;
}

TEST(DriveReadings, OfADriveWhoseLatePosesAreKnownAreTakenWhereTheyWereRead) {
  const test::TemporaryFolder folder;
  const Drive drive = Drive::open(write_straight_drive(folder.path() / "d"));
  const std::vector<PoseSample> poses = motion_streams(drive).poses;
  for (const double known : {0.0, kPosesLate}) {
    SCOPED_TRACE(known);
    const DriveReadings readings = drive_readings(drive, poses, {{"cam.latency", known}});
    ASSERT_GT(readings.friction.samples.size(), 200U);
    // Stamps of the samples are those of the poses.
    for (const FrictionSample& s : readings.friction.samples)
      EXPECT_NEAR(s.x, kSpeed * (s.t_s - kPosesLate), 1e-6);
    EXPECT_NEAR(readings.friction.samples.front().t_s, known, 0.081);
    ASSERT_EQ(readings.ranges.beams.size(), 1U);
    const RangeBeam& first = readings.ranges.beams[0].front();
    EXPECT_NEAR(first.t_s, known, 0.081);
    EXPECT_NEAR(first.origin.x(), kSpeed * (first.t_s - kPosesLate), 1e-6);
  }
}

}  // namespace
}  // namespace roadbook
