#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

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

struct RoadsResult {
  int map_status = -1;
  test::CommandResult roads;
};

RoadsResult roads_of(const ShortWay& way, const std::string& options = "") {
  const test::ScratchFolder folder;
  write_blank_drive(folder.path() / "drive", way);
  RoadsResult result;
  result.map_status =
      test::run_command("roadbook map drive -m m.gpkg -q --threads 1", folder.path()).status;
  result.roads = test::run_command("roadbook roads -m m.gpkg " + options, folder.path());
  return result;
}

ShortWay straight_way(double metres) {
  const auto angle = [metres](double a) { return a * metres / 0.3; };
  return {angle, angle};
}

TEST(ShortDrive, StraightAheadIsOneLane) {
  for (const double metres : {5.8, 7.0, 12.0}) {
    const auto made = roads_of(straight_way(metres));
    EXPECT_EQ(made.map_status, 0);
    EXPECT_EQ(made.roads.status, 0) << made.roads.err;
    EXPECT_NE(made.roads.out.find("1 lanes, 0 intersections"), std::string::npos) << made.roads.out;
  }
}

TEST(ShortDrive, WithinTheReachIsRefusedWithItsLengthAndTheOption) {
  const auto made = roads_of(straight_way(2.4));
  EXPECT_EQ(made.roads.status, 4);
  EXPECT_TRUE(made.roads.err.starts_with("error: m.gpkg: driven length: got 2.")) << made.roads.err;
  EXPECT_NE(made.roads.err.find("a reach of 3.00 m (--reach-m)"), std::string::npos);
  // The command succeeds with the option that its message advised.
  const auto finer = roads_of(straight_way(2.4), "--reach-m 0.5");
  EXPECT_EQ(finer.roads.status, 0) << finer.roads.err;
}

TEST(ShortDrive, ATurnOnTheSpotIsRefusedAndACarThatStandsHasNoMap) {
  const double rad = 0.75 * std::numbers::pi / 0.3;
  const auto spot =
      roads_of({[&](double a) { return -a * rad; }, [&](double a) { return a * rad; }});
  EXPECT_EQ(spot.map_status, 0);
  EXPECT_EQ(spot.roads.status, 4);
  EXPECT_NE(spot.roads.err.find("driven length: got 0.00 m"), std::string::npos) << spot.roads.err;
  EXPECT_EQ(roads_of(straight_way(0.0)).map_status, 4);
}

}  // namespace
}  // namespace roadbook
