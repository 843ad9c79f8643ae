#include <sys/stat.h>

#include <cmath>

#include "drive/tables.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

std::size_t count_lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

void expect_line(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in\n" << text;
}

// Replaces column `column` of the rows `begin` to `end` of a table.
template <typename Value>
void replace_column(
    const fs::path& file, int begin, int end, std::size_t column, const Value& value) {
  std::istringstream in(read_text(file));
  std::string text;
  int row = -1;
  for (std::string line; std::getline(in, line); ++row) {
    if (row >= begin && row < end) {
      std::vector<std::string> fields;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
      if (line.ends_with(',')) fields.emplace_back();
      fields[column] = value(row, fields[column]);
      line.clear();
      for (const auto& field : fields) line += (line.empty() ? "" : ",") + field;
    }
    text += line + "\n";
  }
  write_text(file, text);
}

TEST(ChecksOfStreams, AClockThatGoesBackInAllStreamsIsOneLine) {
  const TemporaryFolder f;
  const fs::path d = write_small_drive(f.path() / "d");
  const auto back = [](int, const std::string& t) {
    return std::to_string(std::stoll(t) - 1'000'000'000);
  };
  for (const char* stream : {"cam0", "cam1", "imu0"})
    replace_column(d / stream / "data.csv", 15, kFrames, 0, back);
  replace_column(d / "wheels0/data.csv", 60, 4 * kFrames, 0, back);
  const std::string text = all_lines(check_drive(d));
  EXPECT_EQ(count_lines(text), 1u) << text;
  expect_line(text, "cam0/data.csv:17: timestamp: got a clock that goes back by ");
  expect_line(text, "; so do cam1, wheels0, imu0");
}

TEST(ChecksOfStreams, FindingsOfOneKindAreOneLineWithTheirNumber) {
  const TemporaryFolder f;
  const fs::path d = write_small_drive(f.path() / "d");
  replace_column(d / "imu0/data.csv", 5, 15, 2, [](int, const std::string&) { return "much"; });
  const std::string text = all_lines(check_drive(d));
  EXPECT_EQ(count_lines(text), 2u) << text;  // and the gap that they leave
  expect_line(text, "imu0/data.csv:7: w_RS_S_y: got much, and the like in 9 more lines up to 16");
}

TEST(ChecksOfStreams, AHangingCameraIsNamedWhileTheWheelsRoll) {
  const TemporaryFolder f;
  const fs::path d = write_small_drive(f.path() / "d");
  EXPECT_EQ(all_lines(check_drive(d)), "");
  for (int i = 11; i < 20; ++i)
    fs::copy_file(d / "cam1/data" / (std::to_string(kStart + 10 * kFrame) + ".png"),
                  d / "cam1/data" / (std::to_string(kStart + i * kFrame) + ".png"),
                  fs::copy_options::overwrite_existing);
  const std::string text = all_lines(check_drive(d));
  EXPECT_EQ(count_lines(text), 1u) << text;
  expect_line(text,
              "cam1/data.csv:12: images: got the same bytes in 10 images, for 0.72 s in which the "
              "wheels roll");
}

TEST(ChecksOfStreams, ImagesOfASceneAtRestMayBeTheSame) {
  const TemporaryFolder f;
  const fs::path d = write_small_drive(f.path() / "d");
  replace_column(d / "wheels0/data.csv", 0, 4 * kFrames, 1,
                 [](int, const std::string&) { return "1"; });
  replace_column(d / "wheels0/data.csv", 0, 4 * kFrames, 2,
                 [](int, const std::string&) { return "1"; });
  for (int i = 11; i < 20; ++i)
    fs::copy_file(d / "cam1/data" / (std::to_string(kStart + 10 * kFrame) + ".png"),
                  d / "cam1/data" / (std::to_string(kStart + i * kFrame) + ".png"),
                  fs::copy_options::overwrite_existing);
  EXPECT_EQ(all_lines(check_drive(d)), "");
}

TEST(ChecksOfStreams, OneWildValueIsNamedInEveryStream) {
  struct Case {
    const char* file;
    std::size_t column;
    const char* part;
  };
  for (const Case& c : {Case{"imu0/data.csv", 4, "a_RS_S_x, _y, _z: got "},
                        {"imu0/data.csv", 1, "w_RS_S_x, _y, _z: got "},
                        {"friction0/data.csv", 1, "friction: got "},
                        {"friction0/data.csv", 2, "sigma: got "},
                        {"wheels0/data.csv", 1, "rear_left: got "},
                        {"wheels0/data.csv", 3, "steering_angle: got "},
                        {"state_groundtruth_estimate0/data.csv", 2, "position: got "}})
    for (const char* value : {"1e6", "1e308"}) {
      const TemporaryFolder f;
      const fs::path d = write_small_drive(f.path() / "d");
      replace_column(d / c.file, 12, 13, c.column, [&](int, const std::string&) { return value; });
      const std::string text = all_lines(check_drive(d));
      expect_line(text, std::string(c.file) + ":14: " + c.part);
    }
}

TEST(ChecksOfStreams, TheDetectorsTablesAreCheckedAndListed) {
  const TemporaryFolder f;
  const fs::path d = write_small_drive(f.path() / "d");
  write_text(d / "detector0/data.csv", "#timestamp [ns],x [m],y [m]\n" + std::to_string(kStart) +
                                           ",1,2\n" + std::to_string(kStart + kFrame) + ",1,2\n");
  const auto good = check_drive(d);
  EXPECT_EQ(all_lines(good), "");
  EXPECT_EQ(good.streams.back().rows, std::size_t{kFrames});  // the truth comes last
  EXPECT_TRUE(std::any_of(good.streams.begin(), good.streams.end(),
                          [](const auto& s) { return s.name == "detector0" && s.rows == 2; }));
  write_text(d / "detector0/data.csv", "#timestamp [ns],x [m],y [m]\n5,1e308,2\n");
  expect_line(all_lines(check_drive(d)), "detector0/data.csv:2: x: got ");
  write_text(d / "detector0/looks.csv", "#timestamp [ns]\nsoon\n");
  expect_line(all_lines(check_drive(d)), "detector0/looks.csv:2: timestamp: got soon");
}

// Turn rates of a drive round bends, in `unit` rad/s.
std::string gyro_found(double unit) {
  const TemporaryFolder f;
  WheelModel wheels;
  DriveWriter writer(f.path() / "d", Rig{}, wheels, {});
  double left = 0.0;
  double right = 0.0;
  for (std::int64_t i = 0; i < 2000; ++i) {
    const double rate = 0.1 * std::sin(0.004 * static_cast<double>(i));  // [rad/s]
    const double way = 2.0 * 0.02;
    left += (way - 0.5 * wheels.track_width_m * rate * 0.02) / wheels.radius_left_m;
    right += (way + 0.5 * wheels.track_width_m * rate * 0.02) / wheels.radius_right_m;
    writer.write_wheels({kStart + i * 20'000'000, left, right, std::nullopt});
    writer.write_imu({kStart + i * 20'000'000, {0.001, -0.002, rate * unit}, {0, 0, 9.8}});
  }
  writer.finish();
  return all_lines(check_drive(f.path() / "d"));
}

TEST(ChecksOfStreams, AGyroInDegreesIsNamedOnAGentleDrive) {
  EXPECT_EQ(gyro_found(1.0), "");
  expect_line(gyro_found(57.29578), "imu0/data.csv: w_RS_S_x, _y, _z: got turns 57.");
  expect_line(gyro_found(57.29578), "(degrees?)");
  expect_line(gyro_found(-1.0), "(the sign, or T_BS?)");
}

TEST(ChecksOfStreams, APipeInPlaceOfAFileIsRefusedAtOnce) {
  for (const char* file : {"wheels0/data.csv", "wheels0/sensor.yaml", "cam0/sensor.yaml",
                           "cam0/data.csv", "imu0/data.csv", "vehicle.yaml", "camchain.yaml",
                           "detector0/data.csv", "state_groundtruth_estimate0/data.csv"}) {
    const TemporaryFolder f;
    const fs::path d = write_small_drive(f.path() / "d");
    fs::create_directories((d / file).parent_path());
    fs::remove(d / file);
    ASSERT_EQ(::mkfifo((d / file).c_str(), 0600), 0);
    const auto report = check_drive(d);
    EXPECT_FALSE(report.usable) << file;
    expect_line(all_lines(report), std::string(file) + ": got a pipe, want ");
  }
}

TEST(ChecksOfStreams, APipeInPlaceOfAnImageCountsAsMissing) {
  const TemporaryFolder f;
  const fs::path d = write_small_drive(f.path() / "d");
  const fs::path image = d / "cam0/data" / (std::to_string(kStart + kFrame) + ".png");
  fs::remove(image);
  ASSERT_EQ(::mkfifo(image.c_str(), 0600), 0);
  const Drive drive = Drive::open(d);
  EXPECT_FALSE(drive.has_image(1, 0));
}

}  // namespace
}  // namespace roadbook::test
