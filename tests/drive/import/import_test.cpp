#include "drive/import/import.hpp"

#include <cmath>
#include <cstring>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "base/se3.hpp"
#include "drive/import/import_support.hpp"
#include "drive/import/npy.hpp"
#include "tests/drive/drive_fixture.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook::test {
namespace {

void write_image(const fs::path& file, std::uint64_t seed, int width = 20, int height = 10) {
  fs::create_directories(file.parent_path());
  cv::imwrite(file.string(), noise_image(width, height, seed));
}

void expect_image(const Drive& drive, std::size_t frame, std::size_t camera, std::uint64_t seed) {
  const cv::Mat got = drive.read_image(frame, camera);
  ASSERT_FALSE(got.empty());
  EXPECT_EQ(cv::norm(got, noise_image(20, 10, seed), cv::NORM_INF), 0.0);
}

TEST(Import, SecondsBecomeNanosecondsDigitByDigit) {
  EXPECT_EQ(seconds_to_ns("1403636579.763555584"), 1'403'636'579'763'555'584);
  EXPECT_EQ(seconds_to_ns("1.036224e-01"), 103'622'400);
  EXPECT_EQ(seconds_to_ns("0.000000e+00"), 0);
  EXPECT_EQ(seconds_to_ns("2.9999999995"), 3'000'000'000);
  for (const char* const bad : {"", "-1", "nan", "1e40", "0x10", "1.2.3", "."})
    EXPECT_FALSE(seconds_to_ns(bad)) << bad;
  EXPECT_EQ(date_to_ns("1970-01-02 00:00:01.5"), 86'401'500'000'000);
  EXPECT_EQ(date_to_ns("2013-05-28 08:46:02.904939008"), 1'369'730'762'904'939'008);
  EXPECT_FALSE(date_to_ns("2013-02-30 08:46:02.9"));
}

TEST(Import, AnUnknownFormatNamesTheNearest) {
  const TemporaryFolder f;
  try {
    import_drive("kity", f.path(), f.path() / "o");
    FAIL();
  } catch (const BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("did you mean kitti?"), std::string::npos) << bad.what();
  }
}

TEST(Import, KittiKeepsStampsPosesBaselineAndPixels) {
  const TemporaryFolder f;
  const fs::path s = f.path() / "sequences" / "03";
  for (int i = 0; i < 2; ++i)
    for (int c = 0; c < 2; ++c)
      write_image(s / ("image_" + std::to_string(c)) / ("00000" + std::to_string(i) + ".png"),
                  static_cast<std::uint64_t>(10 * c + i));
  write_text(s / "times.txt", "0.000000e+00\n1.036224e-01\n");
  write_text(s / "calib.txt",
             "P0: 100 0 9.5 0 0 100 4.5 0 0 0 1 0\nP1: 100 0 9.5 -54 0 100 4.5 0 0 0 1 0\n");
  // One metre ahead along the camera's z while turning the camera about its y (down) by 0.1 rad.
  const double c = std::cos(0.1);
  const double n = std::sin(0.1);
  std::ostringstream poses;
  poses.precision(17);
  poses << "1 0 0 0 0 1 0 0 0 0 1 0\n"
        << c << " 0 " << n << " 0 0 1 0 0 " << -n << " 0 " << c << " 1\n";
  write_text(f.path() / "poses" / "03.txt", poses.str());
  ImportOptions options;
  options.camera_forward_m = 0.0;
  const auto result = import_drive("kitti", s, f.path() / "out", options);
  EXPECT_EQ(result.images, 4u);
  EXPECT_EQ(result.poses, 2u);
  const Drive drive = Drive::open(f.path() / "out");
  EXPECT_EQ(drive.frame_stamp_ns(1), 103'622'400);
  expect_image(drive, 1, 1, 11);
  const auto truth = drive.truth();
  EXPECT_TRUE(truth[0].T_world_vehicle.isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  // Camera z is the vehicle's x; a turn to the camera's right is one to the vehicle's right.
  EXPECT_TRUE(truth[1].T_world_vehicle.translation().isApprox(Eigen::Vector3d(1, 0, 0), 1e-12));
  EXPECT_NEAR(heading_of(truth[1].T_world_vehicle), -0.1, 1e-12);
  const Eigen::Vector3d baseline = drive.rig().cameras[1].T_vehicle_camera.translation() -
                                   drive.rig().cameras[0].T_vehicle_camera.translation();
  EXPECT_TRUE(baseline.isApprox(Eigen::Vector3d(0, -0.54, 0), 1e-12));  // camera 1 is the right one
}

TEST(Import, EurocIsTakenOverWithStampsCalibrationAndPoses) {
  const TemporaryFolder f;
  write_small_drive(f.path() / "s" / "mav0");
  const auto result = import_drive("euroc", f.path() / "s", f.path() / "out");
  EXPECT_EQ(result.images, std::size_t{2 * kFrames});
  const Drive a = Drive::open(f.path() / "s");
  const Drive b = Drive::open(f.path() / "out");
  EXPECT_EQ(b.frame_count(), a.frame_count());
  EXPECT_EQ(b.frame_stamp_ns(7), a.frame_stamp_ns(7));
  EXPECT_EQ(b.rig().cameras[1].camera.parameters, a.rig().cameras[1].camera.parameters);
  EXPECT_EQ(b.wheel_readings().size(), a.wheel_readings().size());
  EXPECT_LT((b.truth()[9].T_world_vehicle.matrix() - a.truth()[9].T_world_vehicle.matrix()).norm(),
            1e-12);
}

TEST(Import, EurocKeepsTheVehicleAndTheMasks) {
  const TemporaryFolder f;
  write_small_drive(f.path() / "s" / "mav0");
  write_text(f.path() / "s" / "vehicle.yaml", "length: 4.5\nwidth: 1.8\n");
  write_image(f.path() / "s" / "mav0" / "cam1" / "mask.png", 4, 16, 12);
  (void)import_drive("euroc", f.path() / "s", f.path() / "out");
  const Drive drive = Drive::open(f.path() / "out");
  ASSERT_TRUE(drive.vehicle());
  EXPECT_EQ(drive.vehicle()->length_m, 4.5);
  EXPECT_FALSE(drive.mask_path(0));
  ASSERT_TRUE(drive.mask_path(1));
  EXPECT_EQ(read_text(*drive.mask_path(1)), read_text(f.path() / "s/mav0/cam1/mask.png"));
}

TEST(Import, KaistTicksBecomeAngles) {
  const TemporaryFolder f;
  write_text(f.path() / "calibration/EncoderParameter.txt",
             "Encoder resolution: 4096\nEncoder left wheel diameter: 0.62\nEncoder right wheel "
             "diameter: 0.60\nEncoder wheel base: 1.52\n");
  write_text(f.path() / "sensor_data/encoder.csv",
             "1544590798702073000,0,0\n1544590798712073000,2048,-4096\n");
  write_text(f.path() / "global_pose.csv",
             "1544590798702073000,1,0,0,332524.5,0,1,0,4140839.25,0,0,1,20.5\n");
  const auto result = import_drive("kaist", f.path(), f.path() / "out");
  EXPECT_EQ(result.wheel_rows, 2u);
  const Drive drive = Drive::open(f.path() / "out");
  const auto rows = drive.wheel_readings();
  EXPECT_EQ(rows[1].t_ns, 1'544'590'798'712'073'000);
  EXPECT_DOUBLE_EQ(rows[1].left_angle_rad, std::numbers::pi);
  EXPECT_DOUBLE_EQ(rows[1].right_angle_rad, -2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(drive.wheel_model()->radius_left_m, 0.31);
  EXPECT_EQ(drive.truth()[0].T_world_vehicle.translation(),
            Eigen::Vector3d(332524.5, 4140839.25, 20.5 - 0.305));
}

TEST(Import, Kitti360PlacesTheSideFisheyes) {
  const TemporaryFolder f;
  const fs::path s = f.path() / "data_2d_raw" / "seq";
  write_image(s / "image_02/data_rgb/0000000001.png", 5);
  write_text(s / "image_02/timestamps.txt",
             "2013-05-28 08:46:02.904939008\n2013-05-28 08:46:03.008700160\n");
  write_text(
      f.path() / "calibration/image_02.yaml",
      "%YAML:1.0\n---\nmodel_type: MEI\ncamera_name: image_02\nimage_width: 20\nimage_height: 10\n"
      "mirror_parameters:\n   xi: 2.2\ndistortion_parameters:\n   k1: 0.01\n   k2: 1.6\n   p1: "
      "0.0001\n   p2: 0.0002\n"
      "projection_parameters:\n   gamma1: 13.3\n   gamma2: 13.4\n   u0: 9.5\n   v0: 4.5\n");
  // The left fisheye looks to the left: its z is -y of the IMU (forward, right, down).
  write_text(f.path() / "calibration/calib_cam_to_pose.txt",
             "image_02: 1 0 0 0.7 0 0 -1 -0.5 0 1 0 -1.0\n");
  write_text(f.path() / "data_poses/seq/poses.txt", "1 1 0 0 10 0 -1 0 20 0 0 -1 30\n");
  import_drive("kitti360", s, f.path() / "out");
  const Drive drive = Drive::open(f.path() / "out");
  ASSERT_EQ(drive.frame_count(), 1u);
  EXPECT_EQ(drive.frame_stamp_ns(0), 1'369'730'763'008'700'160);
  expect_image(drive, 0, 0, 5);
  const auto& camera = drive.rig().cameras[0];
  EXPECT_EQ(camera.camera.model, CameraModel::kOmni);
  EXPECT_EQ(camera.camera.parameters[0], 2.2);
  EXPECT_EQ(camera.camera.parameters[8], 0.0002);
  EXPECT_TRUE((camera.T_vehicle_camera.linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_NEAR(camera.T_vehicle_camera.translation().z(), 1.93, 1e-12);
  EXPECT_TRUE(drive.truth()[0].T_world_vehicle.translation().isApprox(
      Eigen::Vector3d(10, 20, 30 - 0.93), 1e-12));
}

TEST(Import, Kitti360ReadsTheSizeAndLensOfThePerspectiveCameras) {
  const TemporaryFolder f;
  const fs::path s = f.path() / "data_2d_raw" / "seq";
  write_image(s / "image_00/data_rect/0000000000.png", 5);
  write_text(s / "image_00/timestamps.txt", "2013-05-28 08:46:02.904939008\n");
  write_text(f.path() / "calibration/calib_cam_to_pose.txt",
             "image_00: 0 0 1 1.6 1 0 0 0.3 0 1 0 -0.9\n");
  const auto import_with = [&](const std::string& size) {
    write_text(f.path() / "calibration/perspective.txt",
               "calib_time: 25-May-2018\nS_rect_00: " + size +
                   "\nP_rect_00: 13.3 0 9.5 0 0 13.4 4.5 0 0 0 1 0\n");
    ImportOptions options;
    options.overwrite = true;
    import_drive("kitti360", s, f.path() / "out", options);
  };
  import_with("20 10");
  const Camera camera = Drive::open(f.path() / "out").rig().cameras[0].camera;
  EXPECT_EQ(camera.model, CameraModel::kPinholeRadtan);
  EXPECT_EQ(camera.width, 20);
  EXPECT_EQ(camera.height, 10);
  const std::array wanted{13.3, 13.4, 9.5, 4.5};
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_EQ(camera.parameters[i], wanted[i]);
  EXPECT_THROW(import_with("0 10"), BadInput);
  EXPECT_THROW(import_with("20 200000"), BadInput);
}

void write_npy(const fs::path& file, const std::string& shape, const std::vector<double>& values) {
  const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': " + shape + ", }\n";
  std::string bytes = "\x93NUMPY";
  bytes += std::string("\x01\x00", 2);
  bytes += static_cast<char>(header.size());
  bytes += std::string(1, '\0') + header;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  write_text(file, bytes);
}

TEST(Import, Comma2k19ReadsNumpySignals) {
  const TemporaryFolder f;
  const fs::path can = f.path() / "s/processed_log/CAN";
  write_npy(can / "wheel_speed/t", "(3,)", {100.0, 100.5, 101.0});
  write_npy(can / "wheel_speed/value", "(3, 4)", {9, 9, 1, 2, 9, 9, 1, 2, 9, 9, 1, 2});
  write_npy(can / "steering_angle/t", "(2,)", {99.0, 102.0});
  write_npy(can / "steering_angle/value", "(2, 1)", {0, 3});
  const auto result = import_drive("comma2k19", f.path() / "s", f.path() / "out");
  EXPECT_EQ(result.wheel_rows, 3u);
  const Drive drive = Drive::open(f.path() / "out");
  const auto rows = drive.wheel_readings();
  EXPECT_EQ(rows[1].t_ns, 100'500'000'000);
  EXPECT_NEAR(rows[2].left_angle_rad * drive.wheel_model()->radius_left_m, 1.0, 1e-12);
  EXPECT_NEAR(rows[2].right_angle_rad * drive.wheel_model()->radius_right_m, 2.0, 1e-12);
  EXPECT_NEAR(*rows[1].steering_rad * drive.wheel_model()->steering_ratio,
              1.5 * std::numbers::pi / 180, 1e-12);
}

TEST(Import, AShapeThatIsNoNumberIsNamed) {
  const TemporaryFolder f;
  write_npy(f.path() / "t.npy", "(three,)", {1.0, 2.0, 3.0});
  try {
    (void)read_npy(f.path() / "t.npy");
    FAIL();
  } catch (const BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("shape: got three, want"), std::string::npos)
        << bad.what();
  }
}

TEST(Import, TheRealComma2k19MinuteImports) {
  ROADBOOK_REQUIRE_DATA(source, "comma2k19_example");
  const TemporaryFolder f;
  const auto result = import_drive("comma2k19", source, f.path() / "out");
  const Drive drive = Drive::open(f.path() / "out");
  EXPECT_EQ(drive.frame_count(), 0u);
  EXPECT_GT(result.wheel_rows, 4900u);
  EXPECT_GT(result.imu_rows, 6200u);
  // The wheels' distance and the reference's length are two measurements of one road.
  const auto rows = drive.wheel_readings();
  const double wheels = 0.5 * drive.wheel_model()->radius_left_m *
                        (rows.back().left_angle_rad + rows.back().right_angle_rad);
  double length = 0.0;
  const auto truth = drive.truth();
  for (std::size_t i = 1; i < truth.size(); ++i)
    length += (truth[i].T_world_vehicle.translation() - truth[i - 1].T_world_vehicle.translation())
                  .norm();
  EXPECT_NEAR(wheels / length, 1.0, 0.03);
  // At rest or not, gravity presses upwards on the mean.
  double up = 0.0;
  drive.for_each_imu_reading([&](const ImuReading& r) { up += r.specific_force_m_s2.z(); });
  EXPECT_NEAR(up / static_cast<double>(result.imu_rows), 9.8, 0.5);
}

TEST(Import, VideoFramesComeInOrder) {
  const TemporaryFolder f;
  const fs::path s = f.path() / "s";
  fs::create_directories(s);
  cv::VideoWriter video((s / "v.avi").string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0,
                        {64, 48}, false);
  ASSERT_TRUE(video.isOpened());
  for (int i = 0; i < 3; ++i) video.write(cv::Mat(48, 64, CV_8UC1, cv::Scalar(50 + 60 * i)));
  video.release();
  write_text(s / "frames.csv", "#timestamp [ns]\n100\n100000100\n200000100\n");
  std::string yaml = read_text(write_small_drive(f.path() / "d") / "cam0/sensor.yaml");
  yaml.replace(yaml.find("[16, 12]"), 8, "[64, 48]");
  write_text(s / "sensor.yaml", yaml);
  EXPECT_EQ(import_drive("video", s, f.path() / "out").images, 3u);
  const Drive drive = Drive::open(f.path() / "out");
  ASSERT_EQ(drive.frame_count(), 3u);
  EXPECT_EQ(drive.frame_stamp_ns(2), 200'000'100);
  // A flat JPEG keeps its grey to the quantisation of its mean: a few levels.
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(cv::mean(drive.read_image(static_cast<std::size_t>(i), 0))[0], 50 + 60 * i, 4.0);
  write_text(s / "frames.csv", "#timestamp [ns]\n100\n\n200000100\n");
  const auto without_stamp = import_drive("video", s, f.path() / "out3");
  EXPECT_EQ(without_stamp.images, 2u);
  ASSERT_EQ(without_stamp.warnings.size(), 1u);
  EXPECT_NE(to_line(without_stamp.warnings[0]).find("frames.csv: frames: got 1 of 3 frames"),
            std::string::npos)
      << to_line(without_stamp.warnings[0]);
  write_text(s / "frames.csv", "#timestamp [ns]\n1\n2\n3\n4\n");
  EXPECT_THROW(import_drive("video", s, f.path() / "out2"), BadInput);
}

}  // namespace
}  // namespace roadbook::test
