#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "drive/detections.hpp"
#include "drive/images/png_grey.hpp"
#include "drive/sensor_yaml.hpp"
#include "tests/drive/drive_fixture.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook::test {
namespace {

bool same_pixels(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::countNonZero(a != b) == 0;
}

TEST(DriveRoundTrip, ReadsBackExactlyWhatWasWritten) {
  const TemporaryFolder folder;
  const Drive drive = Drive::open(write_small_drive(folder.path() / "d"));
  EXPECT_TRUE(drive.warnings().empty());
  EXPECT_EQ(drive.name(), "d");
  const Rig rig = small_rig();
  ASSERT_EQ(drive.rig().cameras.size(), 2u);
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& got = drive.rig().cameras[c];
    EXPECT_EQ(got.camera.model, rig.cameras[c].camera.model);
    EXPECT_EQ(got.camera.parameters, rig.cameras[c].camera.parameters);
    EXPECT_EQ(got.camera.max_angle_rad, rig.cameras[c].camera.max_angle_rad);
    EXPECT_EQ(got.time_offset_s, rig.cameras[c].time_offset_s);
    EXPECT_LT((got.T_vehicle_camera.matrix() - rig.cameras[c].T_vehicle_camera.matrix()).norm(),
              1e-14);
  }
  ASSERT_EQ(drive.frame_count(), std::size_t{kFrames});
  for (std::size_t i = 0; i < drive.frame_count(); ++i) {
    EXPECT_EQ(drive.frame_stamp_ns(i), kStart + static_cast<std::int64_t>(i) * kFrame);
    for (std::size_t c = 0; c < 2; ++c)
      EXPECT_TRUE(same_pixels(drive.read_image(i, c), noise_image(16, 12, i * 2 + c)));
  }
  EXPECT_TRUE(same_pixels(drive.read_segmentation(0, 1), noise_image(16, 12, 99)));
  EXPECT_TRUE(drive.read_segmentation(0, 0).empty());
  EXPECT_TRUE(drive.read_segmentation(1, 1).empty());
  EXPECT_TRUE(drive.warnings().empty());  // it has no class image there: no damage
  const auto wheels = drive.wheel_readings();
  ASSERT_EQ(wheels.size(), std::size_t{4 * kFrames});
  for (int i = 0; i < 4 * kFrames; ++i) {
    const auto& got = wheels[static_cast<std::size_t>(i)];
    EXPECT_EQ(got.t_ns, wheels_at(i).t_ns);
    EXPECT_EQ(got.left_angle_rad, wheels_at(i).left_angle_rad);
    EXPECT_EQ(got.right_angle_rad, wheels_at(i).right_angle_rad);
    EXPECT_EQ(got.steering_rad, wheels_at(i).steering_rad);
  }
  const auto truth = drive.truth();
  ASSERT_EQ(truth.size(), std::size_t{kFrames});
  for (int i = 0; i < kFrames; ++i)
    EXPECT_LT((truth[static_cast<std::size_t>(i)].T_world_vehicle.matrix() -
               pose_at(i).T_world_vehicle.matrix())
                  .norm(),
              1e-14);
  int imu = 0;
  drive.for_each_imu_reading(
      [&](const ImuReading& r) { EXPECT_EQ(r.angular_velocity_rad_s.x(), 0.1 * imu++); });
  EXPECT_EQ(imu, kFrames);
  int friction = 0;
  drive.for_each_friction_reading(
      [&](const FrictionReading& r) { EXPECT_EQ(r.sigma, 0.05 + friction++); });
  EXPECT_EQ(friction, kFrames);
}

TEST(DriveRoundTrip, RangesWithTheirBeamsAndFrictionWithItsSurfaceReadBack) {
  const TemporaryFolder folder;
  DriveWriter writer(folder.path() / "d", {}, std::nullopt);
  RangeModel model;
  model.azimuth_rad = {-0.1, 0.0, 0.3};
  model.max_m = 12.5;
  model.sigma_m = 0.03;
  model.T_vehicle_sensor.translation() = Eigen::Vector3d(3.5, 0.1, 0.5);
  writer.set_range_model(model);
  for (int i = 0; i < 5; ++i) {
    for (int beam = 0; beam < 3; ++beam)
      writer.write_range({kStart + i * kFrame, beam, 1.0 / (1 + beam + i)});
    writer.write_friction({kStart + i * kFrame, 0.8, 0.05, i, 20.5 + i});
  }
  writer.finish();
  const Drive drive = Drive::open(folder.path() / "d");
  ASSERT_TRUE(drive.range_model());
  EXPECT_EQ(drive.range_model()->azimuth_rad, model.azimuth_rad);
  EXPECT_EQ(drive.range_model()->max_m, 12.5);
  EXPECT_EQ(drive.range_model()->sigma_m, 0.03);
  EXPECT_TRUE(drive.range_model()->T_vehicle_sensor.isApprox(model.T_vehicle_sensor, 1e-15));
  int n = 0;
  drive.for_each_range_reading([&](const RangeReading& r) {
    EXPECT_EQ(r.beam, n % 3);
    EXPECT_EQ(r.range_m, 1.0 / (1 + n % 3 + n / 3));
    ++n;
  });
  EXPECT_EQ(n, 15);
  n = 0;
  drive.for_each_friction_reading([&](const FrictionReading& r) {
    EXPECT_EQ(r.surface, n);
    EXPECT_EQ(r.temperature_c, 20.5 + n++);
  });
  EXPECT_EQ(n, 5);
}

TEST(DriveRoundTrip, TheSameDriveHasTheSameBytesAndTheDigestNoticesAChange) {
  const TemporaryFolder folder;
  const auto a = write_small_drive(folder.path() / "a");
  const auto b = write_small_drive(folder.path() / "b");
  EXPECT_EQ(Drive::open(a).digest(), Drive::open(b).digest());
  write_text(b / "wheels0" / "data.csv", read_text(b / "wheels0" / "data.csv") + "\n");
  EXPECT_NE(Drive::open(a).digest(), Drive::open(b).digest());
}

TEST(DriveRoundTrip, TheDigestNoticesAChangeOfEitherTableOfADetector) {
  const TemporaryFolder folder;
  const auto drive = write_small_drive(folder.path() / "d");
  const auto without = Drive::open(drive).digest();
  write_detections(detector_folder(drive), {}, std::vector<Look>{{100, {12}}, {200, {13}}});
  const auto before = Drive::open(drive).digest();
  EXPECT_NE(before, without);
  for (const char* table : {"data.csv", "looks.csv"}) {
    const auto file = detector_folder(drive) / table;
    const std::string text = read_text(file);
    write_text(file, text + "\n");
    EXPECT_NE(Drive::open(drive).digest(), before) << table;
    write_text(file, text);
    EXPECT_EQ(Drive::open(drive).digest(), before) << table;
  }
}

TEST(DriveRoundTrip, AcceptsTheMav0LevelByteOrderMarksAndWindowsLineEnds) {
  const TemporaryFolder folder;
  write_small_drive(folder.path() / "d" / "mav0");
  const auto table = folder.path() / "d" / "mav0" / "cam0" / "data.csv";
  std::string text = "\xEF\xBB\xBF";
  for (const char c : read_text(table)) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  write_text(table, text);
  const Drive drive = Drive::open(folder.path() / "d");
  EXPECT_EQ(drive.frame_count(), std::size_t{kFrames});
  EXPECT_FALSE(drive.read_image(3, 0).empty());
  EXPECT_TRUE(drive.warnings().empty());
}

TEST(DriveRoundTrip, RefusesToWriteOverOtherFilesButReplacesADriveWhenTold) {
  const TemporaryFolder folder;
  write_small_drive(folder.path() / "d");
  EXPECT_THROW(DriveWriter(folder.path() / "d", small_rig(), {}), InvalidOption);
  DriveWriterOptions options;
  options.overwrite = true;
  write_text(folder.path() / "e" / "diary.txt", "dear diary");
  EXPECT_THROW(DriveWriter(folder.path() / "e", small_rig(), {}, options), InvalidOption);
  EXPECT_EQ(read_text(folder.path() / "e" / "diary.txt"), "dear diary");
  { const DriveWriter writer(folder.path() / "d", small_rig(), {}, options); }
  EXPECT_FALSE(fs::exists(folder.path() / "d" / "wheels0"));
  EXPECT_EQ(lines_with(check_drive(folder.path() / "d"), "broken off").size(), 1u);
}

TEST(DriveRoundTrip, WhatWasBrokenOffIsBegunAfreshWithoutBeingTold) {
  const TemporaryFolder folder;
  { const DriveWriter writer(folder.path() / "d", small_rig(), {}); }
  write_small_drive(folder.path() / "d");
  EXPECT_TRUE(check_drive(folder.path() / "d").usable);
  { const DriveWriter writer(folder.path() / "e", small_rig(), {}); }
  write_text(folder.path() / "e" / "diary.txt", "dear diary");
  EXPECT_THROW(DriveWriter(folder.path() / "e", small_rig(), {}), InvalidOption);
}

TEST(DriveRoundTrip, AFailedWriteNamesTheFileAndTheReason) {
  const TemporaryFolder folder;
  write_text(folder.path() / "file", "");
  try {
    const DriveWriter writer(folder.path() / "file" / "d", small_rig(), {});
    ADD_FAILURE() << "a folder inside a file";
  } catch (const StorageError& error) {
    EXPECT_EQ(std::string(error.what()),
              "error: " + (folder.path() / "file" / "d").string() +
                  ": creating: got Not a directory, want a place that can be written");
  }
}

TEST(DriveRoundTrip, HalfSizeIsTheMeanOfTwoByTwoPixelsAsOpenCvFindsIt) {
  for (const int width : {16, 17, 131}) {
    const cv::Mat image = noise_image(width, 22, 5);
    cv::Mat want;
    cv::resize(image(cv::Rect(0, 0, width / 2 * 2, 22)), want, {width / 2, 11}, 0, 0,
               cv::INTER_AREA);
    EXPECT_TRUE(same_pixels(half_size(image), want)) << width;
  }
}

TEST(GreyPng, OpenCvReadsWhatWeWriteAndWeReadEveryFilterThatLibpngChooses) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    cv::Mat image = noise_image(61, 47, seed);
    if (seed % 2 == 0) cv::GaussianBlur(image, image, {9, 9}, 3.0);
    EXPECT_TRUE(same_pixels(cv::imdecode(encode_grey_png(image), cv::IMREAD_UNCHANGED), image));
    std::vector<std::uint8_t> file;
    cv::imencode(".png", image, file,
                 {cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_FILTERED});
    const auto got = decode_grey_png(file, inspect_image(std::span<const std::uint8_t>(file)));
    ASSERT_TRUE(got);
    EXPECT_TRUE(same_pixels(*got, image));
  }
}

TEST(DriveRoundTrip, ColourAndSixteenBitImagesAreReadAsGrey) {
  const TemporaryFolder folder;
  const auto drive_folder = write_small_drive(folder.path() / "d");
  const auto file = [&](int i) {
    return (drive_folder / "cam0/data" / (std::to_string(kStart + i * kFrame) + ".png")).string();
  };
  cv::Mat grey = noise_image(16, 12, 7);
  cv::Mat colour;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
  cv::imwrite(file(0), colour);
  cv::Mat deep;
  grey.convertTo(deep, CV_16U, 256.0);
  cv::imwrite(file(1), deep);
  const Drive drive = Drive::open(drive_folder);
  EXPECT_TRUE(same_pixels(drive.read_image(0, 0), grey));
  EXPECT_TRUE(same_pixels(drive.read_image(1, 0), grey));
}

TEST(DriveRoundTrip, ImagesDecodeTheSameOnManyThreadsAndDamageIsCountedOnce) {
  const TemporaryFolder folder;
  const auto drive_folder = write_small_drive(folder.path() / "d");
  const auto file = drive_folder / "cam1/data" / (std::to_string(kStart + 4 * kFrame) + ".png");
  std::string bytes = read_text(file);
  bytes[60] = static_cast<char>(bytes[60] ^ 1);  // among the pixels: header and tail stay good
  write_text(file, bytes);
  const Drive drive = Drive::open(drive_folder);
  testing::internal::CaptureStderr();  // libpng also writes there; roadbook writes warnings
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < drive.frame_count(); ++i)
        EXPECT_EQ(drive.read_image(i, 1).empty(), i == 4) << i;
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(drive.warnings().size(), 1u);
}

TEST(RealDrives, OpenWithoutAFault) {
  ROADBOOK_REQUIRE_DATA(drives, "drives");
  const std::vector<std::pair<std::string, std::size_t>> sets = {
      {"kitti00", 120}, {"malaga07_a", 200}, {"malaga07_b", 80}};
  for (const auto& [name, frames] : sets) {
    const DriveReport report = check_drive(drives / name);
    EXPECT_TRUE(report.usable);
    EXPECT_EQ(all_lines(report), "");
    EXPECT_EQ(report.frames, frames);
    const Drive drive = Drive::open(drives / name);
    EXPECT_FALSE(drive.read_image_half(frames - 1, 0).empty());
  }
}

TEST(DriveRoundTrip, ADriveWithoutCamerasOpens) {
  const TemporaryFolder folder;
  const auto d = write_small_drive(folder.path() / "d");
  for (const char* const name : {"cam0", "cam1", "segmentation1"}) fs::remove_all(d / name);
  const Drive drive = Drive::open(d);
  EXPECT_EQ(drive.frame_count(), 0u);
  EXPECT_EQ(drive.wheel_readings().size(), std::size_t{4 * kFrames});
}

TEST(SensorYaml, ACommentStaysAsItIsOnOneLine) {
  const TemporaryFolder folder;
  MountedCamera camera;
  camera.camera.width = 640;
  camera.camera.height = 480;
  camera.camera.parameters = {500.0, 500.0, 320.0, 240.0};
  const auto written = [&](const std::string& comment) {
    write_text(folder.path() / "sensor.yaml", camera_yaml_text(camera, {comment, 20.0}));
    ProblemList problems;
    const auto file = read_camera_yaml(folder.path() / "sensor.yaml", "cam0", 64.0, problems);
    EXPECT_TRUE(file && problems.problems().empty());
    return file ? file->info.comment : "";
  };
  const std::string comment = "front \"left\" \\ G\xC3\xA4rtringen #2";
  EXPECT_EQ(written(comment), comment);
  EXPECT_EQ(written("two\nlines\tof text"), "two lines of text");
}

}  // namespace
}  // namespace roadbook::test
