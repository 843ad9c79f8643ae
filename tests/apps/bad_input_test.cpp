#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <regex>

#include "base/random.hpp"
#include "drive/writer.hpp"
#include "tests/apps/run_command.hpp"

// Each case damages a drive in one way that real recordings are damaged. The command must name the
// place of the damage, end with the documented status, and leave no map that is marked complete.

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::ScratchFolder;
using test::write_text;

constexpr int kFrames = 24;
constexpr std::int64_t kStart_ns = 1'600'000'000'000'000'000;
constexpr std::int64_t kFrame_ns = 80'000'000;

MountedCamera camera(const std::string& name) {
  MountedCamera result;
  result.name = name;
  result.camera.model = CameraModel::kKannalaBrandt;
  result.camera.parameters = {20.0, 20.0, 31.5, 23.5, 0.0, 0.0, 0.0, 0.0};
  result.camera.width = 64;
  result.camera.height = 48;
  result.T_vehicle_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  result.T_vehicle_camera.translation() << 3.0, 0.0, 0.8;
  return result;
}

void write_drive(const fs::path& folder) {
  DriveWriter writer(folder, Rig{{camera("cam0"), camera("cam1")}}, WheelModel{});
  Random random(1, "images");
  for (int i = 0; i < kFrames; ++i)
    for (std::size_t c = 0; c < 2; ++c) {
      cv::Mat image(48, 64, CV_8U);
      for (int k = 0; k < image.rows * image.cols; ++k)
        image.data[k] = static_cast<unsigned char>(random.below(256));
      writer.write_image(c, kStart_ns + i * kFrame_ns, image);
    }
  for (int i = 0; i < 4 * kFrames; ++i) {
    WheelReading reading;
    reading.t_ns = kStart_ns + i * kFrame_ns / 4;
    reading.left_angle_rad = reading.right_angle_rad = 0.1 * i;
    writer.write_wheels(reading);
  }
  writer.finish();
}

fs::path image_file(const fs::path& drive, int frame) {
  return drive / "cam0" / "data" / (std::to_string(kStart_ns + frame * kFrame_ns) + ".png");
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

void write_lines(const fs::path& file, const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  write_text(file, text);
}

void replace_in(const fs::path& file, const std::string& pattern, const std::string& with) {
  const std::string text = read_text(file);
  const std::string changed =
      std::regex_replace(text, std::regex(pattern), with, std::regex_constants::format_first_only);
  ASSERT_NE(text, changed) << file << " has no " << pattern;
  write_text(file, changed);
}

void cut(const fs::path& file, double share) {
  const auto size = fs::file_size(file);
  fs::resize_file(file, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
}

// Header of a PNG of the given size; the rest is missing, but the size alone must be enough.
std::string png_header(std::uint32_t width, std::uint32_t height) {
  std::string text("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
  for (const std::uint32_t value : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8)
      text += static_cast<char>((value >> static_cast<unsigned>(shift)) & 255U);
  return text + std::string("\x08\0\0\0\0", 5) + std::string(200, '\0');
}

enum class Outcome { kRefused, kSurvived };

struct Damage {
  const char* name;
  std::function<void(const fs::path&)> apply;
  Outcome outcome;
  const char* says;  ///< pattern of the line that must be there
};

const std::vector<Damage>& damages() {
  static const std::vector<Damage> all = {
      {"MissingImage", [](const fs::path& d) { fs::remove(image_file(d, 5)); }, Outcome::kSurvived,
       "warning: .*cam0"},
      {"TruncatedImage", [](const fs::path& d) { cut(image_file(d, 5), 0.5); }, Outcome::kSurvived,
       "warning: .*cam0"},
      {"EmptyImage", [](const fs::path& d) { write_text(image_file(d, 5), ""); },
       Outcome::kSurvived, "warning: .*cam0"},
      {"HugeImage",
       [](const fs::path& d) { write_text(image_file(d, 5), png_header(32000, 32000)); },
       Outcome::kRefused, "error: .*cam0/data.csv:7: .*32000x32000"},
      {"CutJpeg",
       [](const fs::path& d) {
         cv::imwrite((d / "x.jpg").string(), cv::imread(image_file(d, 5).string(), 0));
         cut(d / "x.jpg", 0.6);
         fs::rename(d / "x.jpg", image_file(d, 5));
       },
       Outcome::kSurvived, "warning: .*cam0"},
      {"DyingCamera",
       [](const fs::path& d) {
         auto lines = lines_of(d / "cam0" / "data.csv");
         lines.resize(lines.size() / 2);
         write_lines(d / "cam0" / "data.csv", lines);
       },
       Outcome::kSurvived, "warning: .*cam0"},
      {"TruncatedCsv",
       [](const fs::path& d) {
         // Ends in the middle of a row.
         const std::string text = read_text(d / "wheels0" / "data.csv");
         write_text(d / "wheels0" / "data.csv", text.substr(0, text.find(',', text.size() / 2)));
       },
       Outcome::kRefused, "error: .*wheels0/data.csv:\\d+: "},
      {"MissingCsv", [](const fs::path& d) { fs::remove(d / "cam0" / "data.csv"); },
       Outcome::kRefused, "error: .*cam0/data.csv: "},
      {"TruncatedYaml",
       [](const fs::path& d) { replace_in(d / "cam0" / "sensor.yaml", "intrinsics[^]*", "intr"); },
       Outcome::kRefused, "error: .*cam0/sensor.yaml:\\d+: "},
      {"MissingYaml", [](const fs::path& d) { fs::remove(d / "cam0" / "sensor.yaml"); },
       Outcome::kRefused, "error: .*cam0/sensor.yaml: "},
      {"LyingHeader",
       [](const fs::path& d) {
         replace_in(d / "wheels0" / "data.csv", "#[^\n]*", "#timestamp [ns],temperature [K]");
       },
       Outcome::kRefused, "error: .*wheels0/data.csv:1: "},
      {"ReversedStamps",
       [](const fs::path& d) {
         auto lines = lines_of(d / "cam0" / "data.csv");
         std::reverse(lines.begin() + 1, lines.end());
         write_lines(d / "cam0" / "data.csv", lines);
       },
       Outcome::kRefused, "error: .*cam0/data.csv:3: .*timestamp"},
      {"DoubledStamps",
       [](const fs::path& d) {
         auto lines = lines_of(d / "wheels0" / "data.csv");
         lines.insert(lines.begin() + 5, lines[5]);
         write_lines(d / "wheels0" / "data.csv", lines);
       },
       Outcome::kRefused, "error: .*wheels0/data.csv:7: .*timestamp"},
      {"GapInStamps",
       [](const fs::path& d) {
         auto lines = lines_of(d / "wheels0" / "data.csv");
         lines.erase(lines.begin() + 20, lines.begin() + 40);
         write_lines(d / "wheels0" / "data.csv", lines);
       },
       Outcome::kSurvived, "warning: .*wheels0/data.csv.*"},
      {"StampsInMicroseconds",
       [](const fs::path& d) {
         auto lines = lines_of(d / "wheels0" / "data.csv");
         for (std::size_t i = 1; i < lines.size(); ++i) lines[i].erase(lines[i].find(',') - 3, 3);
         write_lines(d / "wheels0" / "data.csv", lines);
       },
       Outcome::kRefused, "error: .*wheels0/data.csv.*"},
      {"NotANumber",
       [](const fs::path& d) {
         auto lines = lines_of(d / "wheels0" / "data.csv");
         lines[9] = std::to_string(kStart_ns + 2 * kFrame_ns) + ",nan,0.8";
         write_lines(d / "wheels0" / "data.csv", lines);
       },
       Outcome::kRefused, "error: .*wheels0/data.csv:10: .*got .*nan"},
      {"LeftHandedCalibration",
       [](const fs::path& d) {
         // Swaps the sign of one row of the rotation.
         write_text(d / "cam0" / "sensor.yaml",
                    std::regex_replace(read_text(d / "cam0" / "sensor.yaml"),
                                       std::regex("data: *\\[[^\\]]*\\]"),
                                       "data: [0.0, 0.0, -1.0, 3.0, -1.0, 0.0, 0.0, 0.0, "
                                       "0.0, -1.0, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0]"));
       },
       Outcome::kRefused, "error: .*cam0/sensor.yaml:\\d+: T_BS"},
      {"NonOrthonormalCalibration",
       [](const fs::path& d) {
         write_text(d / "cam0" / "sensor.yaml",
                    std::regex_replace(read_text(d / "cam0" / "sensor.yaml"),
                                       std::regex("data: *\\[[^\\]]*\\]"),
                                       "data: [0.0, 0.3, 1.0, 3.0, -1.0, 0.0, 0.0, 0.0, "
                                       "0.0, -1.0, 0.0, 0.8, 0.0, 0.0, 0.0, 1.0]"));
       },
       Outcome::kRefused, "error: .*cam0/sensor.yaml:\\d+: T_BS"},
      {"EmptyDrive",
       [](const fs::path& d) {
         fs::remove_all(d);
         fs::create_directory(d);
       },
       Outcome::kRefused, "error: .*drive"},
      {"NoDrive", [](const fs::path& d) { fs::remove_all(d); }, Outcome::kRefused,
       "error: .*drive"},
  };
  return all;
}

class BadInputDrive : public ::testing::TestWithParam<std::size_t> {};

TEST_P(BadInputDrive, IsNamedByTheCommandAndMakesNoMap) {
  const Damage& damage = damages()[GetParam()];
  const ScratchFolder folder;
  write_drive(folder.path() / "drive");
  damage.apply(folder.path() / "drive");
  const auto check = test::run_command("roadbook check drive --json", folder.path());
  const bool refused = damage.outcome == Outcome::kRefused;
  EXPECT_EQ(check.status, refused ? 2 : 0) << check.err;
  EXPECT_TRUE(std::regex_search(check.err, std::regex(damage.says)))
      << "said: " << check.err << "wanted: " << damage.says;
  const auto object = nlohmann::json::parse(check.out, nullptr, false);
  ASSERT_TRUE(object.is_object()) << check.out;
  ASSERT_FALSE(object.at("problems").empty());
  for (const char* key : {"severity", "file", "line", "field", "got", "want"})
    EXPECT_TRUE(object["problems"][0].contains(key)) << key;
  if (!refused) return;
  const auto map = test::run_command("roadbook map drive -m place.gpkg", folder.path());
  EXPECT_EQ(map.status, 2) << map.err;
  EXPECT_TRUE(std::regex_search(map.err, std::regex(damage.says))) << map.err;
  EXPECT_FALSE(fs::exists(folder.path() / "place.gpkg"));
}

INSTANTIATE_TEST_SUITE_P(OfEveryKind,
                         BadInputDrive,
                         ::testing::Range<std::size_t>(0, damages().size()),
                         [](const auto& damaged) { return damages()[damaged.param].name; });

TEST(BadInput, AWholeDriveHasNoProblem) {
  const ScratchFolder folder;
  write_drive(folder.path() / "drive");
  const auto check = test::run_command("roadbook check drive --json", folder.path());
  EXPECT_EQ(check.status, 0) << check.err;
  const auto object = nlohmann::json::parse(check.out);
  EXPECT_TRUE(object.at("problems").empty()) << check.out;
  ASSERT_GE(object.at("streams").size(), 3U);
  for (const auto& stream : object["streams"]) {
    const double rate_hz = stream.at("name").get<std::string>().rfind("cam", 0) == 0 ? 12.5 : 50.0;
    EXPECT_NEAR(stream.at("rate").get<double>(), rate_hz, 1e-9) << stream;
    EXPECT_EQ(stream.at("gaps"), 0);
  }
}

TEST(BadInput, ATextThatIsNoMapIsRefused) {
  const ScratchFolder folder;
  write_text(folder.path() / "place.gpkg", "not a map");
  const auto check = test::run_command("roadbook check place.gpkg", folder.path());
  EXPECT_EQ(check.status, 2);
  EXPECT_EQ(check.err.rfind("error: ", 0), 0U) << check.err;
  EXPECT_NE(check.err.find("place.gpkg"), std::string::npos) << check.err;
}

}  // namespace
}  // namespace roadbook
