#include <functional>
#include <opencv2/imgcodecs.hpp>

#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void edit(const fs::path& file, const std::string& from, const std::string& to) {
  write_text(file, replaced(read_text(file), from, to));
}

std::string stamp(int i) { return std::to_string(kStart + i * kFrame); }

struct Case {
  const char* name;
  std::function<void(const fs::path&)> damage;
  const char* line;  ///< with D for the drive's folder
  bool usable;
};

class BadInputTest : public ::testing::TestWithParam<Case> {};

TEST_P(BadInputTest, GivesOneLineThatSaysWhereAndWhat) {
  const TemporaryFolder folder;
  const auto drive = write_small_drive(folder.path() / "d");
  GetParam().damage(drive);
  const DriveReport report = check_drive(drive);
  std::string lines = all_lines(report);
  for (auto at = lines.find(drive.string()); at != std::string::npos;
       at = lines.find(drive.string()))
    lines.replace(at, drive.string().size(), "D");
  EXPECT_NE(lines.find(GetParam().line), std::string::npos) << lines;
  EXPECT_EQ(report.usable, GetParam().usable) << lines;
  if (report.usable) {
    EXPECT_NO_THROW((void)Drive::open(drive));
  } else {
    EXPECT_THROW((void)Drive::open(drive), BadInput);
  }
}

fs::path image(const fs::path& d, int i) { return d / "cam0/data" / (stamp(i) + ".png"); }

void truncate(const fs::path& file) {
  const auto bytes = read_text(file);
  write_text(file, bytes.substr(0, bytes.size() / 2));
}

void scale_stamps(const fs::path& file, std::int64_t divisor) {
  std::istringstream in(read_text(file));
  std::string out;
  std::string line;
  for (std::getline(in, line), out = line + "\n"; std::getline(in, line);) {
    const auto comma = line.find(',');
    out += std::to_string(std::stoll(line.substr(0, comma)) / divisor) + line.substr(comma) + "\n";
  }
  write_text(file, out);
}

const std::vector<Case> kCases = {
    {"MissingImage", [](const fs::path& d) { fs::remove(image(d, 3)); },
     "warning: D/cam0/data.csv:5: 1403636580003555584.png: got no such file, want an image\n",
     true},
    {"TruncatedImage", [](const fs::path& d) { truncate(image(d, 3)); },
     "warning: D/cam0/data.csv:5: 1403636580003555584.png: got a file cut short, want an image\n",
     true},
    {"ImageOfText", [](const fs::path& d) { write_text(image(d, 3), "not an image at all"); },
     "1403636580003555584.png: got neither PNG nor JPEG, want an image\n", true},
    {"TruncatedJpeg",
     [](const fs::path& d) {
       std::vector<std::uint8_t> bytes;
       cv::imencode(".jpg", noise_image(16, 12, 1), bytes);
       write_text(image(d, 3), std::string(bytes.begin(), bytes.end() - 70));
     },
     "1403636580003555584.png: got a file cut short, want an image\n", true},
    {"ImageOfAnotherSize",
     [](const fs::path& d) { cv::imwrite(image(d, 3).string(), noise_image(20, 12, 1)); },
     "error: D/cam0/data.csv:5: 1403636580003555584.png: got 20x12 pixels, want 16x12 as "
     "sensor.yaml states\n",
     false},
    {"HugeImage",
     [](const fs::path& d) {
       std::string bytes = read_text(image(d, 3));
       bytes.replace(16, 8, std::string("\0\0\x7d\0\0\0\x7d\0", 8));
       write_text(image(d, 3), bytes);
     },
     "1403636580003555584.png: got 32000x32000 pixels, want at most 64 megapixels\n", false},
    {"NoImageLeft", [](const fs::path& d) { fs::remove_all(d / "cam0/data"); },
     "error: D/cam0/data.csv: images: got none of 25 usable, want at least one\n", false},
    {"CameraDies",
     [](const fs::path& d) {
       for (int i = 12; i < kFrames; ++i) fs::remove(image(d, i));
     },
     "warning: D/cam0/data.csv: images: got the last at 1403636580643555584 ns, want images until",
     true},
    {"MissingTable", [](const fs::path& d) { fs::remove(d / "cam0/data.csv"); },
     "error: D/cam0/data.csv: got no readable file, want a table\n", false},
    {"EmptyTable", [](const fs::path& d) { write_text(d / "cam0/data.csv", ""); },
     "error: D/cam0/data.csv:1: header: got nothing, want a line like '#timestamp [ns],...'\n",
     false},
    {"HeaderOnly",
     [](const fs::path& d) { write_text(d / "cam0/data.csv", "#timestamp [ns],filename\n"); },
     "error: D/cam0/data.csv: got no rows, want at least one\n", false},
    {"NoHeader",
     [](const fs::path& d) { edit(d / "cam0/data.csv", "#timestamp [ns],filename\n", ""); },
     "error: D/cam0/data.csv:1: header: got 1403636579763555584,1403636579763555584.png", false},
    {"HeaderWithAnotherUnit", [](const fs::path& d) { edit(d / "cam0/data.csv", "[ns]", "[us]"); },
     "error: D/cam0/data.csv:1: timestamp: got unit [us], want [ns]\n", false},
    {"HeaderWithTooManyColumns",
     [](const fs::path& d) { edit(d / "wheels0/data.csv", "\n", ",torque [N m]\n"); },
     "error: D/wheels0/data.csv:2: row: got 4 fields, and the like in 99 more lines up to 101, "
     "want 5 as the header names\n",
     false},
    {"HeaderWithoutTheColumn",
     [](const fs::path& d) { edit(d / "wheels0/data.csv", "rear_left_angle", "rear_lef_angle"); },
     "error: D/wheels0/data.csv:1: header: got column rear_lef_angle, want rear_left_angle [rad]\n",
     false},
    {"RaggedRow",
     [](const fs::path& d) { edit(d / "cam0/data.csv", stamp(2) + ".png", stamp(2) + ".png,1"); },
     "error: D/cam0/data.csv:4: row: got 3 fields, want 2 as the header names\n", false},
    {"ReversedStamps",
     [](const fs::path& d) {
       edit(d / "cam0/data.csv", "\n" + stamp(5) + ",", "\n" + stamp(1) + ",");
     },
     "error: D/cam0/data.csv:7: timestamp: got 1403636579843555584 (goes back), want more than "
     "1403636580083555584 of line 6\n",
     false},
    {"DoubledStamps",
     [](const fs::path& d) {
       edit(d / "cam0/data.csv", "\n" + stamp(5) + ",", "\n" + stamp(4) + ",");
     },
     "error: D/cam0/data.csv:7: timestamp: got 1403636580083555584 again, want more than "
     "1403636580083555584 of line 6\n",
     false},
    {"Gap",
     [](const fs::path& d) {
       for (int i = 5; i < 10; ++i)
         edit(d / "cam1/data.csv", stamp(i) + "," + stamp(i) + ".png\n", "");
     },
     "warning: D/cam1/data.csv:7: timestamp: got a gap of 0.48 s, want about 80000 us\n", true},
    {"StampsInMicroseconds", [](const fs::path& d) { scale_stamps(d / "cam0/data.csv", 1000); },
     "error: D/cam0/data.csv:2: timestamp: got a rate of 12500 Hz, want stamps in nanoseconds "
     "(these look like a larger unit)\n",
     false},
    {"StampsInSeconds",
     [](const fs::path& d) { edit(d / "cam0/data.csv", "\n" + stamp(0), "\n1403636579.763"); },
     "error: D/cam0/data.csv:2: timestamp: got 1403636579.763, want whole nanoseconds >= 0\n",
     false},
    {"NotANumber",
     [](const fs::path& d) {
       edit(d / "wheels0/data.csv", "\n" + std::to_string(kStart) + ",0.0,",
            "\n" + std::to_string(kStart) + ",nan,");
     },
     "error: D/wheels0/data.csv:2: rear_left_angle: got nan, want a finite number\n", false},
    {"TruthWithNineColumns",
     [](const fs::path& d) {
       edit(d / "state_groundtruth_estimate0/data.csv", "\n" + stamp(0), "\n" + stamp(0) + ",1");
     },
     "error: D/state_groundtruth_estimate0/data.csv:2: row: got 9 fields, want 8 or 17\n", false},
    {"TruthWithoutRotation",
     [](const fs::path& d) {
       write_text(d / "state_groundtruth_estimate0/data.csv", "# p q\n5,1,2,3,0,0,0,0\n");
     },
     "error: D/state_groundtruth_estimate0/data.csv:2: quaternion: got length 0.000000, want 1 (w "
     "first)\n",
     false},
    {"LeftHandedRotation",
     [](const fs::path& d) {
       write_text(d / "cam0/sensor.yaml",
                  replaced(read_text(d / "cam0/sensor.yaml"),
                           "T_BS:", "T_BS: [[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]\ncomment2:"));
     },
     "error: D/cam0/sensor.yaml:3: T_BS: got a left-handed rotation (determinant -1), want a "
     "right-handed one\n",
     false},
    {"RotationNotOrthonormal",
     [](const fs::path& d) {
       write_text(d / "cam0/sensor.yaml",
                  replaced(read_text(d / "cam0/sensor.yaml"), "T_BS:",
                           "T_BS: [[1,0.1,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]\ncomment2:"));
     },
     "error: D/cam0/sensor.yaml:3: T_BS: got a rotation off orthonormal by 0.1, want orthonormal "
     "axes\n",
     false},
    {"UnknownKey",
     [](const fs::path& d) { edit(d / "wheels0/sensor.yaml", "track_width", "track_widht"); },
     "track_widht: got an unknown key, want a known one (did you mean track_width?)\n", false},
    {"UnknownModel",
     [](const fs::path& d) {
       edit(d / "cam0/sensor.yaml", "camera_model: pinhole", "camera_model: fisheye");
     },
     "camera_model: got fisheye, want pinhole, omni or ds\n", false},
    {"YamlCutShort",
     [](const fs::path& d) {
       write_text(d / "cam0/sensor.yaml", "sensor_type: camera\nT_BS: [1, 2");
     },
     "error: D/cam0/sensor.yaml:2: got invalid YAML", false},
    {"MissingYaml", [](const fs::path& d) { fs::remove(d / "cam0/sensor.yaml"); },
     "error: D/cam0/sensor.yaml: got ", false},
    {"TableCutShort",
     [](const fs::path& d) {
       const std::string text = read_text(d / "wheels0/data.csv");
       write_text(d / "wheels0/data.csv", text.substr(0, text.rfind('\n', text.size() - 2) + 30));
     },
     "error: D/wheels0/data.csv:101: row: got 3 fields, want 4 as the header names\n", false},
    {"NotANumberInTheCalibration",
     [](const fs::path& d) { edit(d / "cam0/sensor.yaml", "10.1", ".nan"); },
     "error: D/cam0/sensor.yaml:10: intrinsics[0]: got .nan, want a finite number\n", false},
    {"PathInAFileName",
     [](const fs::path& d) { edit(d / "cam0/data.csv", "," + stamp(2), ",../" + stamp(2)); },
     "error: D/cam0/data.csv:4: filename: got ../1403636579923555584.png, want a plain file name\n",
     false},
    {"WheelsOfAnotherClock",
     [](const fs::path& d) {
       write_text(d / "wheels0/data.csv",
                  "#timestamp [ns],rear_left_angle [rad],rear_right_angle [rad]\n0,0,0\n"
                  "20000000,0.1,0.1\n40000000,0.2,0.2\n");
     },
     "error: D/wheels0/data.csv: timestamp: got 0 to 40000000 ns, want the time of the images, "
     "1403636579763555584 to 1403636581683555584 ns\n",
     false},
    {"WheelsEndBeforeTheImages",
     [](const fs::path& d) {
       const std::string text = read_text(d / "wheels0/data.csv");
       write_text(d / "wheels0/data.csv", text.substr(0, text.find(stamp(8))));
     },
     "warning: D/wheels0/data.csv: timestamp: got 1403636579763555584 to 1403636580383555584 ns, "
     "want the time of the images, ",
     true},
    {"TruthOfAnotherClock",
     [](const fs::path& d) {
       write_text(d / "state_groundtruth_estimate0/data.csv", "# p q\n5,1,2,3,1,0,0,0\n");
     },
     "warning: D/state_groundtruth_estimate0/data.csv: timestamp: got 5 to 5 ns, want the time of",
     true},
    {"WheelThatJumps",
     [](const fs::path& d) {
       const std::string text = read_text(d / "wheels0/data.csv");
       const auto row = text.find(stamp(10) + ",");
       const auto cell = text.find(',', row) + 1;
       write_text(d / "wheels0/data.csv",
                  std::string(text).replace(cell, text.find(',', cell) - cell, "9999"));
     },
     "warning: D/wheels0/data.csv:42: rear_left: got a turn of 9986 rad in 0.02 s, want less than "
     "a car at 70 m/s\n",
     true},
    {"NotANumberInAPose",
     [](const fs::path& d) {
       const std::string text = read_text(d / "cam0/sensor.yaml");
       const auto cell = text.find("data: [") + 7;
       write_text(d / "cam0/sensor.yaml",
                  std::string(text).replace(cell, text.find(',', cell) - cell, ".nan"));
     },
     "error: D/cam0/sensor.yaml:6: T_BS.data[0]: got .nan, want a finite number\n", false},
    {"EmptyDrive",
     [](const fs::path& d) {
       fs::remove_all(d);
       fs::create_directories(d);
     },
     "error: D: got no sensor folder, want cam0, wheels0 or another stream\n", false},
};

INSTANTIATE_TEST_SUITE_P(Drive, BadInputTest, ::testing::ValuesIn(kCases), [](const auto& p) {
  return std::string(p.param.name);
});

TEST(BadInput, AllFaultsAreGatheredAndLongListsAreCounted) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  std::string rows = "#timestamp [ns],filename\n";
  for (int i = 0; i < 1254; ++i) rows += "x,y.png\n";
  write_text(d / "cam0/data.csv", rows);
  edit(d / "wheels0/sensor.yaml", "track_width: 1.5", "track_width: -1");
  const auto report = check_drive(d);
  EXPECT_EQ(lines_with(report, "cam0/data.csv").size(), 2u);
  EXPECT_EQ(lines_with(report,
                       "cam0/data.csv:2: timestamp: got x, and the like in 1253 more lines up to "
                       "1255")
                .size(),
            1u)
      << all_lines(report);
  EXPECT_EQ(lines_with(report, "track_width: got -1").size(), 1u);
}

TEST(BadInput, AFaultInAMatrixBringsNoOthersWithIt) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  edit(d / "cam0/sensor.yaml", "data: [", "data: [.inf, ");
  EXPECT_EQ(lines_with(check_drive(d), "cam0/sensor.yaml").size(), 1u) << all_lines(check_drive(d));
}

}  // namespace
}  // namespace roadbook::test
