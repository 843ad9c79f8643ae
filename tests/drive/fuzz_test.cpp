#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "base/yaml.hpp"
#include "drive/images/image_header.hpp"
#include "drive/images/png_grey.hpp"
#include "drive/import/import_support.hpp"
#include "drive/sensor_yaml.hpp"
#include "drive/tables.hpp"
#include "tests/drive/foreign_recordings.hpp"

namespace roadbook::test {
namespace {

// Flips, deletes, doubles and inserts bytes. The inserted texts are known to cause errors in
// readers.
std::string mutated(std::string text, Random& random) {
  static const std::vector<std::string> kInserts = {"nan",
                                                    "-",
                                                    "e999",
                                                    ",",
                                                    "\n",
                                                    "\r",
                                                    "#",
                                                    "[",
                                                    "{",
                                                    "&a",
                                                    "*a",
                                                    ": ",
                                                    "\xEF\xBB\xBF",
                                                    "9223372036854775808",
                                                    "0x1p3",
                                                    std::string(1, '\0')};
  const std::uint64_t count = 1 + random.below(4);
  for (std::uint64_t i = 0; i < count && !text.empty(); ++i) {
    const std::size_t at = random.below(text.size());
    switch (random.below(5)) {
      case 0:
        text[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        text.erase(at, 1 + random.below(8));
        break;
      case 2:
        text.insert(at, text.substr(random.below(text.size()), 1 + random.below(40)));
        break;
      case 3:
        text.insert(at, kInserts[random.below(kInserts.size())]);
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

TEST(Fuzz, AMutatedWheelTableGivesFaultsOrFiniteAscendingRows) {
  const TemporaryFolder folder;
  const auto source =
      read_text(write_small_drive(folder.path() / "d") / "wheels0/data.csv").substr(0, 900);
  const auto file = folder.path() / "data.csv";
  std::size_t refused = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Random random(1, "wheels", i);
    write_text(file, mutated(source, random));
    ProblemList problems;
    std::int64_t last = -1;
    std::size_t rows = 0;
    (void)read_wheel_table(file, WheelModel{}, {}, problems, [&](const WheelReading& r) {
      ASSERT_GT(r.t_ns, last);
      ASSERT_TRUE(std::isfinite(r.left_angle_rad) && std::isfinite(r.right_angle_rad));
      last = r.t_ns;
      ++rows;
    });
    ASSERT_TRUE(rows > 0 || problems.has_errors());
    refused += problems.has_errors();
  }
  EXPECT_GT(refused, 1000u);
}

TEST(Fuzz, AMutatedTruthTableGivesFaultsOrRotations) {
  const TemporaryFolder folder;
  const auto source =
      read_text(write_small_drive(folder.path() / "d") / "state_groundtruth_estimate0/data.csv")
          .substr(0, 900);
  const auto file = folder.path() / "data.csv";
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Random random(2, "truth", i);
    write_text(file, mutated(source, random));
    ProblemList problems;
    (void)read_truth_table(file, problems, [&](const TimedPose& pose) {
      const Eigen::Matrix3d R = pose.T_world_vehicle.linear();
      ASSERT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-9);
      ASSERT_TRUE(pose.T_world_vehicle.translation().allFinite());
    });
  }
}

TEST(Fuzz, AMutatedCameraFileIsRefusedOrGivesAUsableCamera) {
  const TemporaryFolder folder;
  const auto source = read_text(write_small_drive(folder.path() / "d") / "cam0/sensor.yaml");
  const auto file = folder.path() / "sensor.yaml";
  std::size_t refused = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Random random(3, "camera", i);
    write_text(file, mutated(source, random));
    ProblemList problems;
    const auto camera = read_camera_yaml(file, "cam0", 64.0, problems);
    ASSERT_EQ(camera.has_value(), !problems.has_errors());
    refused += !camera;
    if (!camera) continue;
    const Camera& lens = camera->camera.camera;
    ASSERT_TRUE(lens.width > 0 && lens.height > 0);
    for (const double p : lens.parameters) ASSERT_TRUE(std::isfinite(p));
    ASSERT_NEAR(camera->camera.T_vehicle_camera.linear().determinant(), 1.0, 1e-9);
  }
  EXPECT_GT(refused, 1000u);
}

TEST(Fuzz, MutatedFrameLinesGiveAscendingStampsOrAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "times.txt";
  std::size_t refused = 0;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    Random random(6, "frame lines", i);
    const bool dates = random.below(2) == 0;
    write_text(file, mutated(dates ? "2013-05-28 08:46:02.9\n\n2013-05-28 08:46:03.0\n"
                                     "2013-05-28 08:46:03.1\n"
                                   : "0.0\n1.0e-01\n\n0.3\n0.4\n",
                             random));
    try {
      const FrameLines lines = read_frame_lines(file);
      const auto stamps = frame_stamps(file, lines, dates ? &date_to_ns : &seconds_to_ns, "time");
      ASSERT_EQ(stamps.size(), lines.text.size());
      std::int64_t last = -1;
      for (std::size_t k = 0; k < stamps.size(); ++k) {
        ASSERT_EQ(stamps[k].has_value(), !lines.text[k].empty());
        if (stamps[k]) {
          ASSERT_GT(*stamps[k], last);
          last = *stamps[k];
        }
      }
    } catch (const BadInput&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 500u);
}

// Mutates each file of recordings of other layouts, one file at a time.
TEST(Fuzz, AMutatedRecordingIsRefusedOrBecomesADriveThatOpens) {
  const TemporaryFolder folder;
  const fs::path kitti = write_kitti(folder.path() / "kitti", {"0.png", "1.png"}, kitti_times(2));
  write_text(kitti / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n");
  const fs::path kaist = write_kaist(folder.path() / "kaist", "100,1,2\n200,3,4\n300,5,6\n");
  write_text(kaist / "global_pose.csv", "100,1,0,0,5,0,1,0,6,0,0,1,7\n");
  const fs::path kitti360 = write_kitti360(folder.path() / "kitti360", {"0.png", "1.png"},
                                           "2013-05-28 08:46:02.9\n2013-05-28 08:46:03.0\n");
  const struct {
    const char* format;
    fs::path source;
    std::vector<fs::path> files;
  } kRecordings[] = {
      {"kitti", kitti, {kitti / "times.txt", kitti / "calib.txt", kitti / "poses.txt"}},
      {"kaist",
       kaist,
       {kaist / "sensor_data/encoder.csv", kaist / "global_pose.csv",
        kaist / "calibration/EncoderParameter.txt"}},
      {"kitti360",
       kitti360,
       {kitti360 / "image_02/timestamps.txt", folder.path() / "kitti360/calibration/image_02.yaml",
        folder.path() / "kitti360/calibration/calib_cam_to_pose.txt"}}};
  for (const auto& [format, source, files] : kRecordings)
    for (const auto& file : files) {
      const std::string text = read_text(file);
      for (std::uint64_t i = 0; i < 60; ++i) {
        Random random(8, file.filename().string(), i);
        write_text(file, mutated(text, random));
        ImportOptions options;
        options.overwrite = true;
        const auto made = try_import(format, source, folder.path() / "out", options);
        if (!made.refused) {
          ASSERT_NO_THROW((void)check_drive(folder.path() / "out")) << file;
        }
      }
      write_text(file, text);
    }
}

TEST(Fuzz, YamlNestedTenThousandDeepIsRefused) {
  EXPECT_THROW((void)YamlMap::parse("a: " + std::string(10'000, '['), "deep.yaml"), BadInput);
}

TEST(Fuzz, AMutatedPngNeverDecodesToOtherPixels) {
  cv::Mat image = noise_image(31, 23, 1);
  std::vector<std::uint8_t> file;
  cv::imencode(".png", image, file);
  const std::string source(file.begin(), file.end());
  std::size_t refused = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    Random random(4, "png", i);
    const std::string text = mutated(source, random);
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    const ImageHeader header = inspect_image(std::span<const std::uint8_t>(bytes));
    if (header.state == ImageState::kGood && (header.width != 31 || header.height != 23)) {
      ++refused;  // as the drive does, which knows the size, before decoding
      continue;
    }
    const auto got = decode_grey_png(bytes, header);
    refused += !got;
    if (got) {
      ASSERT_EQ(cv::norm(*got, image, cv::NORM_INF), 0.0) << i;
    }
  }
  EXPECT_GT(refused, 4000u);
}

TEST(Fuzz, AMutatedJpegHeaderIsReadWithoutHarm) {
  std::vector<std::uint8_t> file;
  cv::imencode(".jpg", noise_image(31, 23, 1), file);
  const std::string source(file.begin(), file.end());
  for (std::uint64_t i = 0; i < 5000; ++i) {
    Random random(5, "jpeg", i);
    const std::string text = mutated(source, random);
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    const ImageHeader header = inspect_image(std::span<const std::uint8_t>(bytes));
    if (header.state == ImageState::kGood) {
      ASSERT_TRUE(header.width > 0 && header.height > 0);
    }
  }
}

TEST(Fuzz, StampsThatIntegersDoNotHoldAreRefused) {
  EXPECT_EQ(seconds_to_ns("9000000000.000000000"), 9'000'000'000'000'000'000);
  for (const char* text :
       {"1e-9223372036854775808", "1e31", "9223372036.8547758079", "9000000000.1"})
    EXPECT_FALSE(seconds_to_ns(text)) << text;
  EXPECT_TRUE(date_to_ns("2016-12-31 23:59:60.5"));
  for (const char* text :
       {"2240-01-01 00:00:9000000000", "2013-05-28 08:46:61", "9999-05-28 08:46:01"})
    EXPECT_FALSE(date_to_ns(text)) << text;
  const TemporaryFolder folder;
  const auto file = folder.path() / "data.csv";
  write_text(file,
             "#timestamp [ns],rear_left_angle [rad],rear_right_angle [rad]\n"
             "9223372036854775807,1,1\n");
  ProblemList problems;
  (void)read_wheel_table(file, WheelModel{}, {}, problems, [](const WheelReading&) {});
  ASSERT_TRUE(problems.has_errors());
  ROADBOOK_EXPECT_TEXT(to_line(problems.problems().front()),
                       "want nanoseconds before the year 2255");
}

}  // namespace
}  // namespace roadbook::test
