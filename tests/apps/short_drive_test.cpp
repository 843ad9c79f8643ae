#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "base/se3.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::write_text;

// Angles of the rear wheels as functions of the fraction `a` of a drive.
struct ShortWay {
  std::function<double(double)> left, right;
};

// A drive of 3 s in front of a blank wall.
void write_blank_drive(const fs::path& drive, const ShortWay& way) {
  std::ostringstream wheels, images;
  wheels << "#timestamp [ns],rear_left_angle [rad],rear_right_angle [rad]\n";
  images << "#timestamp [ns],filename\n";
  for (int i = 0; i <= 60; ++i)
    wheels << 50'000'000LL * i << "," << way.left(i / 60.0) << "," << way.right(i / 60.0) << "\n";
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(90)), bytes);
  fs::create_directories(drive / "cam0/data");
  for (int i = 0; i <= 30; ++i) {
    const std::string name = std::to_string(100'000'000LL * i) + ".png";
    write_text(drive / "cam0/data" / name, std::string(bytes.begin(), bytes.end()));
    images << 100'000'000LL * i << "," << name << "\n";
  }
  fs::create_directories(drive / "wheels0");
  write_text(drive / "cam0/data.csv", images.str());
  write_text(drive / "wheels0/data.csv", wheels.str());
  write_text(drive / "wheels0/sensor.yaml",
             "sensor_type: wheels\nwheel_radius_left: 0.3\nwheel_radius_right: 0.3\n"
             "track_width: 1.5\nwheelbase: 2.6\n");
  write_text(drive / "cam0/sensor.yaml",
             "sensor_type: camera\nT_BS: {rows: 4, cols: 4, data: [0,0,1,1.5, -1,0,0,0, 0,-1,0,1, "
             "0,0,0,1]}\nresolution: [64, 48]\ncamera_model: pinhole\nintrinsics: [40, 40, 31.5, "
             "23.5]\ndistortion_model: none\n");
}

// The map of the drive by its wheels: a keyframe each 0.2 m or 5 degrees.
Map map_of(const ShortWay& way) {
  constexpr int kSteps = 600;
  constexpr double kRadius = 0.3;
  constexpr double kTrack = 1.5;
  Map map;
  Session session;
  session.name = "drive";
  map.sessions.push_back(session);
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();  // x, y, heading
  Eigen::Vector3d last = pose;
  double travelled = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double from = std::max(0, i - 1) / double(kSteps);
    const double to = i / double(kSteps);
    const double left = kRadius * (way.left(to) - way.left(from));
    const double right = kRadius * (way.right(to) - way.right(from));
    pose.head<2>() +=
        0.5 * (left + right) * Eigen::Vector2d(std::cos(pose.z()), std::sin(pose.z()));
    pose.z() += (right - left) / kTrack;
    const bool is_far = (pose - last).head<2>().norm() >= 0.2 - 1e-9;
    if (i > 0 && !is_far && std::abs(pose.z() - last.z()) < 0.0873) continue;
    travelled += (pose - last).head<2>().norm();
    last = pose;
    Keyframe keyframe;
    keyframe.t_ns = 5'000'000LL * i;
    keyframe.drive_frame = keyframe.map_frame = static_cast<int>(map.keyframes.size());
    keyframe.travelled_m = travelled;
    map.map_frames.push_back({pose_from_planar(pose.x(), pose.y(), pose.z())});
    map.keyframes.push_back(keyframe);
    map.sessions[0].t_end_ns = keyframe.t_ns;
  }
  return map;
}

test::CommandResult roads_of(const ShortWay& way, const std::string& options = "") {
  const test::ScratchFolder folder;
  MapFileBuilder(folder.path() / "m.gpkg", "drive").finish(map_of(way), {});
  return test::run_command("roadbook roads -m m.gpkg " + options, folder.path());
}

ShortWay straight_way(double metres) {
  const auto angle = [metres](double a) { return a * metres / 0.3; };
  return {angle, angle};
}

TEST(ShortDrive, StraightAheadIsOneLane) {
  for (const double metres : {5.8, 7.0, 12.0}) {
    const auto made = roads_of(straight_way(metres));
    EXPECT_EQ(made.status, 0) << made.err;
    EXPECT_NE(made.out.find("1 lanes, 0 intersections"), std::string::npos) << made.out;
  }
}

TEST(ShortDrive, WithinTheReachIsRefusedWithItsLengthAndTheOption) {
  const auto made = roads_of(straight_way(2.4));
  EXPECT_EQ(made.status, 4);
  EXPECT_TRUE(made.err.starts_with("error: m.gpkg: driven length: got 2.")) << made.err;
  EXPECT_NE(made.err.find("a reach of 3.00 m (--reach-m)"), std::string::npos);
  // The command succeeds with the option that its message advised.
  const auto finer = roads_of(straight_way(2.4), "--reach-m 0.5");
  EXPECT_EQ(finer.status, 0) << finer.err;
}

TEST(ShortDrive, ATurnOnTheSpotIsRefusedAndACarThatStandsHasNoMap) {
  const double rad = 0.75 * std::numbers::pi / 0.3;
  const auto spot =
      roads_of({[&](double a) { return -a * rad; }, [&](double a) { return a * rad; }});
  EXPECT_EQ(spot.status, 4);
  EXPECT_NE(spot.err.find("driven length: got 0.00 m"), std::string::npos) << spot.err;
  const test::ScratchFolder folder;
  write_blank_drive(folder.path() / "drive", straight_way(0.0));
  const auto stands = test::run_command("roadbook map drive -m m.gpkg -q", folder.path());
  EXPECT_EQ(stands.status, 4);
  EXPECT_NE(stands.err.find("does the car move?"), std::string::npos) << stands.err;
}

}  // namespace
}  // namespace roadbook
