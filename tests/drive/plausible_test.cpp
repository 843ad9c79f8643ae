#include <cmath>
#include <functional>
#include <numbers>
#include <opencv2/imgcodecs.hpp>

#include "tests/drive/foreign_recordings.hpp"

namespace roadbook::test {
namespace {

// Implausible values: `check` names the value and a possible reason.

struct WheelCase {
  std::string sizes = "wheel_radius_left: 0.31\nwheel_radius_right: 0.31\ntrack_width: 1.5\n";
  std::string steering = "steering_angle [rad]";
  std::function<double(int)> angle = [](int i) { return 0.5 * std::sin(0.1 * i); };
  std::string wheel = "rear_left_angle [rad],rear_right_angle [rad]";
  double turn = 0.1;  ///< a row of 20 ms
};

// Returns the output of `check` for a drive with these wheels. The text begins with "unusable" if
// `check` refuses them.
std::string check_of_wheels(const WheelCase& wheels) {
  const TemporaryFolder f;
  write_text(f.path() / "wheels0/sensor.yaml", "sensor_type: wheels\n" + wheels.sizes);
  std::ostringstream text;
  text << "#timestamp [ns]," << wheels.wheel << "," << wheels.steering << "\n";
  for (int i = 0; i < 200; ++i)
    text << std::int64_t{i} * 20'000'000 << "," << wheels.turn * i << "," << wheels.turn * i << ","
         << wheels.angle(i) << "\n";
  write_text(f.path() / "wheels0/data.csv", text.str());
  const auto report = check_drive(f.path());
  return (report.usable ? "" : "unusable ") + all_lines(report);
}

TEST(Plausible, SteeringOfAVehicleIsLeftAlone) {
  EXPECT_EQ(check_of_wheels({}), "");
  WheelCase sharp;
  sharp.angle = [](int i) { return 1.1 * std::sin(0.1 * i); };
  EXPECT_EQ(check_of_wheels(sharp), "");
  WheelCase degrees;
  degrees.steering = "steering_angle [deg]";
  degrees.angle = [](int i) { return 40.0 * std::sin(0.1 * i); };
  EXPECT_EQ(check_of_wheels(degrees), "");
  WheelCase wheel;
  wheel.sizes += "steering_ratio: 16\n";
  wheel.steering = "steering_wheel_angle [deg]";
  wheel.angle = [](int i) { return 540.0 * std::sin(0.1 * i); };
  EXPECT_EQ(check_of_wheels(wheel), "");
}

TEST(Plausible, DegreesUnderRadiansAreAnErrorThatNamesColumnValueAndLine) {
  WheelCase wheels;
  wheels.angle = [](int i) { return i == 100 ? -31.5 : 30.0 * std::sin(0.1 * i); };
  const auto text = check_of_wheels(wheels);
  EXPECT_TRUE(text.starts_with("unusable error: ")) << text;
  ROADBOOK_EXPECT_TEXT(text, "data.csv:102: steering_angle: got -31.5, beyond the bound in ");
  ROADBOOK_EXPECT_TEXT(text, "of 200 rows (degrees?), want at most 1.2 rad");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

TEST(Plausible, ASteeringWheelWithoutARatioOrUnderTheRoadWheelsNameIsSaid) {
  WheelCase no_ratio;
  no_ratio.steering = "steering_wheel_angle [rad]";
  no_ratio.angle = [](int i) { return 8.0 * std::sin(0.1 * i); };
  ROADBOOK_EXPECT_TEXT(check_of_wheels(no_ratio), "no steering_ratio in sensor.yaml?");
  WheelCase wheel_as_road;
  wheel_as_road.steering = "steering_angle [deg]";
  wheel_as_road.angle = [](int i) { return 400.0 * std::sin(0.1 * i); };
  ROADBOOK_EXPECT_TEXT(check_of_wheels(wheel_as_road),
                       "(steering_wheel_angle?), want at most 68.8 deg");
  WheelCase degrees;
  degrees.sizes += "steering_ratio: 16\n";
  degrees.steering = "steering_wheel_angle [rad]";
  degrees.angle = [](int i) { return 500.0 * std::sin(0.1 * i); };
  ROADBOOK_EXPECT_TEXT(check_of_wheels(degrees), "(degrees?), want at most 19.2 rad");
}

TEST(Plausible, ASingleWildSteeringAngleIsAWarning) {
  WheelCase wheels;
  wheels.angle = [](int i) { return i == 7 ? 99.0 : 0.1; };
  const auto text = check_of_wheels(wheels);
  EXPECT_TRUE(text.starts_with("warning: ")) << text;
  ROADBOOK_EXPECT_TEXT(text, "data.csv:9: steering_angle: got 99, beyond the bound in 1 of 200");
}

// Wheels on curves of 8 m and more. The recorded steering is `scale` times the true steering.
std::string check_of_curves(const std::string& column,
                            double scale,
                            const std::string& sizes = "") {
  const TemporaryFolder f;
  write_text(f.path() / "wheels0/sensor.yaml",
             "sensor_type: wheels\nwheel_radius_left: 0.3\nwheel_radius_right: 0.3\n"
             "track_width: 1.5\nwheelbase: 2.6\n" +
                 sizes);
  std::ostringstream text;
  text << "#timestamp [ns],rear_left_angle [rad],rear_right_angle [rad]," << column << "\n";
  Random random(4, "curves");
  double left = 0.0, right = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double steering = 0.3 * std::sin(0.01 * i);
    const double turn = 0.1 * std::tan(steering) / 2.6;  // 0.1 m a row
    left += (0.1 - 0.75 * turn) / 0.3 + random.uniform(-0.002, 0.002);
    right += (0.1 + 0.75 * turn) / 0.3 + random.uniform(-0.002, 0.002);
    text << std::int64_t{i} * 20'000'000 << "," << left << "," << right << "," << scale * steering
         << "\n";
  }
  write_text(f.path() / "wheels0/data.csv", text.str());
  return all_lines(check_drive(f.path()));
}

TEST(Plausible, SteeringThatTheWheelsContradictIsSaidThoughItIsWithinTheBound) {
  const double degrees = 180.0 / std::numbers::pi;
  EXPECT_EQ(check_of_curves("steering_angle [rad]", 1.0), "");
  EXPECT_EQ(check_of_curves("steering_angle [rad]", 1.3), "");
  EXPECT_EQ(check_of_curves("steering_angle [deg]", degrees), "");
  ROADBOOK_EXPECT_TEXT(check_of_curves("steering_angle [deg]", 1.0),
                       "(radians taken for degrees?), want angles");
  ROADBOOK_EXPECT_TEXT(check_of_curves("steering_angle [rad]", -1.0), "(the sign?)");
  ROADBOOK_EXPECT_TEXT(check_of_curves("steering_angle [rad]", 3.5), "(steering_ratio?)");
  ROADBOOK_EXPECT_TEXT(
      check_of_curves("steering_wheel_angle [rad]", degrees / 30, "steering_ratio: 30\n"),
      "times as much");
}

TEST(Plausible, AWheelThatIsAlwaysTooFastIsOneErrorAboutItsUnit) {
  WheelCase wheels;
  wheels.turn = 0.2 * 180.0 / std::numbers::pi;
  const auto text = check_of_wheels(wheels);
  EXPECT_TRUE(text.starts_with("unusable ")) << text;
  ROADBOOK_EXPECT_TEXT(text,
                       "data.csv:3: rear_left: got a turn of 11.4592 rad in 0.02 s, and the like "
                       "in 199 of 199 rows");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
}

TEST(Plausible, SizesInOtherUnitsAreErrorsThatNameTheUnit) {
  const auto sizes = [](const std::string& text) {
    WheelCase wheels;
    wheels.sizes = text;
    return check_of_wheels(wheels);
  };
  const std::string track = "track_width: 1.5\n";
  const auto radius = [&](const std::string& value) {
    return sizes("wheel_radius_left: " + value + "\nwheel_radius_right: " + value + "\n" + track);
  };
  const auto mm = radius("310");
  ROADBOOK_EXPECT_TEXT(mm, "unusable error: ");
  ROADBOOK_EXPECT_TEXT(mm,
                       "sensor.yaml: wheel_radius_left: got 310 m (millimetres?), want 0.04 to "
                       "0.6 m as vehicles have");
  EXPECT_EQ(std::count(mm.begin(), mm.end(), '\n'), 2) << mm;  // each wheel once, no row
  ROADBOOK_EXPECT_TEXT(radius("31"), "got 31 m (centimetres?)");
  ROADBOOK_EXPECT_TEXT(radius("12.2"), "inches");
  ROADBOOK_EXPECT_TEXT(radius("0.75"), "warning: ");
  const std::string wheels = "wheel_radius_left: 0.31\nwheel_radius_right: 0.31\n";
  ROADBOOK_EXPECT_TEXT(sizes(wheels + "track_width: 1520\n"),
                       "track_width: got 1520 m (millimetres?)");
  ROADBOOK_EXPECT_TEXT(sizes(wheels + track + "wheelbase: 2580\n"),
                       "wheelbase: got 2580 m (millimetres?)");
  ROADBOOK_EXPECT_TEXT(sizes(wheels + track + "steering_ratio: 0.06\n"), "warning: ");
}

TEST(Plausible, PosesInMillimetresAreSaid) {
  const TemporaryFolder f;
  const auto d = write_small_drive(f.path() / "d");
  std::string poses = "#t,x,y,z,w,x,y,z\n";
  for (int i = 0; i < kFrames; ++i)  // 1 m/s
    poses += std::to_string(kStart + i * kFrame) + "," + std::to_string(80 * i) + ",0,0,1,0,0,0\n";
  write_text(d / "state_groundtruth_estimate0/data.csv", poses);
  ROADBOOK_EXPECT_TEXT(all_lines(check_drive(d)),
                       "state_groundtruth_estimate0/data.csv:3: position: got a way of 80 m in "
                       "0.08 s, and the like in 24 of 24 rows, want less than 100 m/s (metres?)");
}

// The unit is doubted only where most rows are too far apart.
TEST(Plausible, JumpsOfTheReferenceAreNoQuestionOfUnits) {
  const TemporaryFolder f;
  const auto d = write_small_drive(f.path() / "d");
  std::string poses = "#t,x,y,z,w,x,y,z\n";
  for (int i = 0; i < kFrames; ++i)  // jumps by 80 m before rows 6, 12 and 18
    poses += std::to_string(kStart + i * kFrame) + "," + std::to_string(80 * std::min(3, i / 6)) +
             ",0,0,1,0,0,0\n";
  write_text(d / "state_groundtruth_estimate0/data.csv", poses);
  const std::string lines = all_lines(check_drive(d));
  ROADBOOK_EXPECT_TEXT(lines, "and the like in 3 of 24 rows, want less than 100 m/s");
  EXPECT_EQ(lines.find("metres?"), std::string::npos) << lines;
}

std::string check_of_imu(double gravity, double rate) {
  const TemporaryFolder f;
  std::ostringstream text;
  text << "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x "
          "[m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
  for (int i = 0; i < 100; ++i)
    text << i * 10'000'000 << ",0,0," << rate * std::sin(0.1 * i) << ",0.03," << 0.02 << ","
         << gravity << "\n";
  write_text(f.path() / "imu0/data.csv", text.str());
  return all_lines(check_drive(f.path()));
}

TEST(Plausible, AccelerationsInOtherUnitsAndRatesInDegreesAreSaid) {
  EXPECT_EQ(check_of_imu(9.79, 0.5), "");
  ROADBOOK_EXPECT_TEXT(check_of_imu(1.0, 0.5),
                       "a mean length of 1.0006 m/s^2 (g?), want about 9.8");
  ROADBOOK_EXPECT_TEXT(check_of_imu(0.0, 0.5), "(gravity taken out?)");
  ROADBOOK_EXPECT_TEXT(check_of_imu(9810, 0.5), "(mm/s^2?)");
  ROADBOOK_EXPECT_TEXT(check_of_imu(9.79, 30.0), "error: ");
  ROADBOOK_EXPECT_TEXT(check_of_imu(9.79, 30.0), "(degrees?), want at most 10 rad/s");
}

// Returns the output of `check` for one camera with these intrinsics and images of 64x48.
std::string check_of_camera(const std::string& model,
                            const std::string& intrinsics,
                            int width = 64,
                            int height = 48,
                            const std::string& resolution = "[64, 48]",
                            const std::string& position = "0") {
  const TemporaryFolder f;
  write_flat_image(f.path() / "cam0/data/100.png", 7, width, height);
  write_text(f.path() / "cam0/data.csv", "#timestamp [ns],filename\n100,100.png\n");
  write_text(f.path() / "cam0/sensor.yaml",
             "sensor_type: camera\nT_BS: {rows: 4, cols: 4, data: [0,0,1," + position +
                 ", -1,0,0,0, 0,-1,0,1, 0,0,0,1]}\nresolution: " + resolution + "\ncamera_model: " +
                 model + "\nintrinsics: " + intrinsics + "\ndistortion_model: none\n");
  return all_lines(check_drive(f.path()));
}

TEST(Plausible, ACalibrationOfImagesOfAnotherSizeIsSaid) {
  EXPECT_EQ(check_of_camera("pinhole", "[40, 40, 31.5, 23.5]"), "");
  EXPECT_EQ(check_of_camera("pinhole", "[40, 40, 26, 29]"), "");  // lenses are off by some per cent
  const auto far = check_of_camera("pinhole", "[718.9, 718.9, 607.2, 185.2]");
  ROADBOOK_EXPECT_TEXT(far,
                       "cam0/sensor.yaml: intrinsics: got principal point (607.2, 185.2) "
                       "outside images of 64x48");
  // Twice, half, three quarters and one and a half times the size.
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[80, 80, 63.5, 47.5]"),
                       "a calibration of images 2 times their size?");
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[20, 20, 15.5, 11.5]"),
                       "a calibration of images 0.5 times their size?");
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[30, 30, 23.5, 17.5]"), "0.75 times");
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[60, 60, 47.5, 35.5]"), "1.5 times");
  ROADBOOK_EXPECT_TEXT(check_of_camera("omni", "[1, 80, 80, 63.5, 47.5]"), "2 times their size?");
  ROADBOOK_EXPECT_TEXT(check_of_camera("ds", "[0.1, 0.5, 80, 80, 63.5, 47.5]"), "2 times");
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[4000, 4000, 31.5, 23.5]"),
                       "intrinsics: got focal lengths (4000, 4000) for images of 64x48");
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[0.7, 0.7, 31.5, 23.5]"), "focal lengths");
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[40, 100, 31.5, 23.5]"), "focal lengths");
  // A fisheye's smaller focal length counts: at least 0.2 times the shorter side.
  ROADBOOK_EXPECT_TEXT(check_of_camera("ds", "[0, 0.5, 9, 10, 31.5, 23.5]"),
                       "focal lengths (9, 10)");
  EXPECT_EQ(check_of_camera("ds", "[0, 0.5, 10, 9.7, 31.5, 23.5]"), "");
  ROADBOOK_EXPECT_TEXT(
      check_of_camera("pinhole", "[40, 40, 31.5, 23.5]", 64, 48, "[64, 48]", "1500"),
      "T_BS: got a camera 1500 m from the vehicle (millimetres?)");
}

TEST(Plausible, ImagesOfHalfTheStatedSizeAreSaidToBeSo) {
  const auto half = check_of_camera("pinhole", "[80, 80, 63.5, 47.5]", 64, 48, "[128, 96]");
  ROADBOOK_EXPECT_TEXT(half,
                       "got 64x48 pixels (half the size: resolution and intrinsics times "
                       "0.5?), want 128x96 as sensor.yaml states");
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[40, 40, 31.5, 23.5]", 128, 96),
                       "twice the size: resolution and intrinsics times 2?");
  ROADBOOK_EXPECT_TEXT(check_of_camera("pinhole", "[40, 40, 31.5, 23.5]", 48, 64),
                       "(turned by 90 degrees?)");
}

TEST(Plausible, ImagesOfAnotherSizeAreOneLine) {
  const TemporaryFolder f;
  const auto d = write_small_drive(f.path() / "d");
  std::string yaml = read_text(d / "cam0/sensor.yaml");
  yaml.replace(yaml.find("[16, 12]"), 8, "[32, 24]");
  write_text(d / "cam0/sensor.yaml", yaml);
  const auto report = check_drive(d);
  EXPECT_FALSE(report.usable);
  EXPECT_EQ(lines_with(report, "error: ").size(), 1u) << all_lines(report);
  ROADBOOK_EXPECT_TEXT(all_lines(report),
                       "cam0/data.csv:2: " + std::to_string(kStart) +
                           ".png: got 16x12 pixels (half the size: resolution and intrinsics times "
                           "0.5?), as 24 more images have, want 32x24 as sensor.yaml states");
}

TEST(Plausible, AnImportedCalibrationOfAnotherSizeIsSaidWithTheDrive) {
  const TemporaryFolder f;
  const auto s = write_kitti(f.path() / "s", {"0.png", "1.png"}, kitti_times(2));
  write_text(s / "calib.txt", "P0: 718.856 0 607.1928 0 0 718.856 185.2157 0 0 0 1 0\n");
  EXPECT_FALSE(try_import("kitti", s, f.path() / "out").refused);
  ROADBOOK_EXPECT_TEXT(all_lines(check_drive(f.path() / "out")),
                       "principal point (607.19, 185.22)");
}

}  // namespace
}  // namespace roadbook::test
