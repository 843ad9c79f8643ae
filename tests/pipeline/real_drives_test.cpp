#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "semantics/overhead/overhead.hpp"
#include "tests/pipeline/malaga_pairs.hpp"
#include "tests/pipeline/map_judge.hpp"
#include "tests/semantics/overhead_scene.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

// Returns the share of the keyframes that lie on ground that the image shows. A camera that looks
// ahead sees the road before the vehicle drives over it, except for the first metres of each part
// of the drive.
double share_on_seen_ground(const Map& map, const OverheadSummary& made, double from_m) {
  const auto image = test::read_band(made.image);
  int seen = 0;
  int all = 0;
  double begin_m = 0.0;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Vector3d p = map.T_map_vehicle(static_cast<int>(k)).translation();
    if (map.keyframes[k].after_gap) begin_m = map.keyframes[k].travelled_m;
    if (map.keyframes[k].travelled_m < begin_m + from_m) continue;
    const int row = static_cast<int>((made.north_m - p.y()) / made.resolution_m);
    const int column = static_cast<int>((p.x() - made.west_m) / made.resolution_m);
    ++all;
    seen += row >= 0 && row < image.rows && column >= 0 && column < image.cols &&
                    image(row, column) > 0.0
                ? 1
                : 0;
  }
  return static_cast<double>(seen) / std::max(1, all);
}

OverheadSummary coarse_overhead(const Map& map,
                                const Drive& drive,
                                const std::filesystem::path& out) {
  OverheadOptions options;
  options.resolution_m = 0.1;
  return make_overhead(map, {&drive}, out, options);
}

// KITTI odometry 00 has one rectified camera and no wheels. The shape is right to 1 % of the
// length; the scale comes from the camera's height and is right to 3 %.
TEST(RealDrives, Kitti00HasItsShapeAndTheScaleOfTheCamerasHeight) {
  ROADBOOK_REQUIRE_DATA(folder, "drives/kitti00");
  const auto out = test::fresh_folder("kitti00");
  const auto summary = build_map({folder}, out / "map.gpkg", {});
  EXPECT_EQ(summary.scale_source, ScaleSource::kCameraHeight);
  EXPECT_EQ(summary.components, 1U);
  const Map map = load_map(out / "map.gpkg");
  const Drive drive = Drive::open(folder);
  constexpr double kLength = 91.8;  // of the reference path [m]
  const auto error = test::error_of(map, drive, true);
  EXPECT_GT(error.count, 100U);
  EXPECT_LT(error.median_m, 0.01 * kLength);
  EXPECT_LT(error.p95_m, 0.01 * kLength);
  EXPECT_NEAR(error.T_reference_estimate.scale, 1.0, 0.03);
  // Travelled distances use the scale of the map, not the initial scale of the odometry.
  EXPECT_NEAR(map.keyframes.back().travelled_m, kLength, 0.03 * kLength);

  // The camera is on the roof and sees no part of the car, so the mask must not cover any ground.
  const OverheadSummary made = coarse_overhead(map, drive, out / "overhead");
  EXPECT_EQ(map.sessions.front().vehicle_source, VehicleSource::kNone);
  EXPECT_EQ(made.vehicles.front().masked_share, std::vector<double>{0.0});
  // Row 375 of 376 looks 14.8 degrees down from 1.65 m: the nearest ground lies 6.2 m ahead.
  EXPECT_NEAR(made.max_range_m, 1.5 * 1.65 * 718.856 / (375.0 - 185.2157), 0.15);
  EXPECT_GT(share_on_seen_ground(map, made, 12.0), 0.99);
  EXPECT_GT(made.covered_m2, 8.0 * kLength);
}

// The visible ground, its saturated share, and the strength of the paint edges that the image
// without balance shows.
struct SeenGround {
  double saturated = 0.0;
  double paint_energy = 0.0;
};

// Paint is at least 12 grey values brighter than the mean of the surrounding metre. The mask adds a
// margin of 6 cm.
cv::Mat paint_in(const cv::Mat& image) {
  cv::Mat seen = image > 0;
  cv::Mat sum;
  cv::Mat count;
  cv::Mat in_count;
  seen.convertTo(in_count, CV_32F, 1.0 / 255.0);
  cv::boxFilter(image, sum, CV_32F, {51, 51}, {-1, -1}, false);
  cv::boxFilter(in_count, count, CV_32F, {51, 51}, {-1, -1}, false);
  cv::Mat grey;
  image.convertTo(grey, CV_32F);
  cv::Mat paint = (grey - sum / cv::max(count, 1.0F) > 12.0F) & seen;
  cv::dilate(paint, paint, cv::Mat::ones(7, 7, CV_8U));
  // The rim of the seen area has steps that are not paint.
  cv::erode(seen, seen, cv::Mat::ones(9, 9, CV_8U));
  return paint & seen;
}

SeenGround judge(const cv::Mat& image, const cv::Mat& paint) {
  SeenGround ground;
  ground.saturated = static_cast<double>(cv::countNonZero(image >= 250)) /
                     static_cast<double>(cv::countNonZero(image));
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(image, dx, CV_32F, 1, 0);
  cv::Sobel(image, dy, CV_32F, 0, 1);
  ground.paint_energy = cv::mean(dx.mul(dx) + dy.mul(dy), paint)[0];
  return ground;
}

// In this recording, a far view is brighter than a near view. Gains that followed this difference
// from image to image saturated a quarter of the ground and erased a zebra crossing.
TEST(RealDrives, MalagaIsNotBurntByTheBalanceOfExposure) {
  ROADBOOK_REQUIRE_DATA(a, "drives/malaga07_a");
  ROADBOOK_REQUIRE_DATA(b, "drives/malaga07_b");
  const auto out = test::fresh_folder("malaga_overhead");
  build_map({a, b}, out / "map.gpkg", {});
  const Map map = load_map(out / "map.gpkg");
  const Drive drive_a = Drive::open(a);
  const Drive drive_b = Drive::open(b);
  const auto made = [&](bool balance) {
    OverheadOptions options;
    options.balance_exposure = balance;
    return make_overhead(map, {&drive_a, &drive_b}, out / (balance ? "on" : "off"), options);
  };
  const OverheadSummary balanced = made(true);
  const OverheadSummary recorded = made(false);
  const auto pixels = [](const OverheadSummary& summary) {
    cv::Mat image;
    test::read_band(summary.image).convertTo(image, CV_8U);
    return image;
  };
  const cv::Mat before = pixels(recorded);
  const cv::Mat paint = paint_in(before);
  ASSERT_GT(cv::countNonZero(paint), 20000);
  const SeenGround was = judge(before, paint);
  const SeenGround is = judge(pixels(balanced), paint);
  EXPECT_LE(is.saturated, was.saturated + 0.01);
  EXPECT_GE(is.paint_energy, 0.9 * was.paint_energy);
  RecordProperty("saturated", std::to_string(is.saturated));
  RecordProperty("paint_energy", std::to_string(is.paint_energy / was.paint_energy));
  // The exposure balance was active; the pipeline did not drop it.
  EXPECT_TRUE(balanced.exposure.balanced);
  EXPECT_TRUE(balanced.warnings.empty());
  EXPECT_NEAR(balanced.exposure.saturated, is.saturated, 1e-9);
  EXPECT_NEAR(balanced.exposure.saturated_recorded, was.saturated, 1e-9);
}

// Both recordings in one folder, with the gap of a minute between them.
std::filesystem::path joined_malaga(const std::filesystem::path& a,
                                    const std::filesystem::path& b,
                                    const std::filesystem::path& joined) {
  namespace fs = std::filesystem;
  fs::create_directories(joined / "cam0" / "data");
  fs::copy_file(a / "cam0" / "sensor.yaml", joined / "cam0" / "sensor.yaml");
  std::ofstream table(joined / "cam0" / "data.csv");
  for (const auto& part : {a, b}) {
    std::ifstream rows(part / "cam0" / "data.csv");
    std::string row;
    std::getline(rows, row);
    if (part == a) table << row << '\n';
    while (std::getline(rows, row)) table << row << '\n';
    for (const auto& image : fs::directory_iterator(part / "cam0" / "data"))
      fs::create_symlink(fs::absolute(image.path()),
                         joined / "cam0" / "data" / image.path().filename());
  }
  return joined;
}

// Pairs of frames were found by eye, to about half a second of driving.
constexpr double kPairedTolerance = 5.0;  // frames of the drive, 0.1 s each

// Way [m] that the car drove in a frame of the drive near a keyframe.
double metres_a_frame(const Map& map, int keyframe) {
  const auto k = static_cast<std::size_t>(std::max(keyframe, 1));
  const double way = (map.T_map_vehicle(static_cast<int>(k)).translation() -
                      map.T_map_vehicle(static_cast<int>(k) - 1).translation())
                         .norm();
  return way / (map.keyframes[k].drive_frame - map.keyframes[k - 1].drive_frame);
}

// How far ahead [m] of a keyframe the car was at a frame of the same pass.
double ahead_m(const Map& map, int keyframe, double frame) {
  std::size_t k = 0;
  while (k + 1 < map.keyframes.size() && map.keyframes[k + 1].drive_frame < frame) ++k;
  const auto& before = map.keyframes[k];
  const auto& after = map.keyframes[k + 1];
  const double share = (frame - before.drive_frame) / (after.drive_frame - before.drive_frame);
  const Eigen::Vector3d p = (1.0 - share) * map.T_map_vehicle(static_cast<int>(k)).translation() +
                            share * map.T_map_vehicle(static_cast<int>(k) + 1).translation();
  return (map.T_map_vehicle(keyframe).inverse() * p).x();
}

TEST(RealDrives, MalagaGoesTheSameWayTwiceWithAGapBetween) {
  ROADBOOK_REQUIRE_DATA(a, "drives/malaga07_a");
  ROADBOOK_REQUIRE_DATA(b, "drives/malaga07_b");
  const auto out = test::fresh_folder("malaga");
  const auto summary = build_map({joined_malaga(a, b, out / "drive")}, out / "map.gpkg", {});
  EXPECT_EQ(summary.components, 1U);
  const auto frames_of_a = static_cast<int>(Drive::open(a).frame_count());
  const Map map = load_map(out / "map.gpkg");
  int joined = 0;
  for (const auto& loop : map.loops) {
    if (!loop.accepted) continue;
    const int from = map.keyframes[static_cast<std::size_t>(loop.from)].drive_frame;
    const int to = map.keyframes[static_cast<std::size_t>(loop.to)].drive_frame;
    ASSERT_TRUE(from < frames_of_a && to >= frames_of_a) << "neither part meets itself";
    ++joined;
    // The loop sees as far ahead of frame `from` as the paired frame of `a` was driven after it.
    const double paired = 0.5 * test::frame_of_malaga_a(1600.0 + 2.0 * (to - frames_of_a));
    EXPECT_NEAR(loop.T_from_to.translation().x(), ahead_m(map, loop.from, paired),
                kPairedTolerance * metres_a_frame(map, loop.from))
        << loop.from << " -> " << loop.to;
    EXPECT_LT(std::abs(loop.T_from_to.translation().y()), 4.0) << "more than a lane";
  }
  EXPECT_GT(joined, 20);
  // The two passes coincide: they use the same street, at most a lane apart.
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (map.keyframes[k].drive_frame < frames_of_a) continue;
    const Eigen::Vector3d p = map.T_map_vehicle(static_cast<int>(k)).translation();
    double nearest = std::numeric_limits<double>::max();
    for (std::size_t e = 0; e < map.keyframes.size(); ++e)
      if (map.keyframes[e].drive_frame < frames_of_a)
        nearest =
            std::min(nearest, (map.T_map_vehicle(static_cast<int>(e)).translation() - p).norm());
    EXPECT_LT(nearest, 2.0) << "keyframe " << k;
  }
  // The measured mask covers the visible edge of the bonnet and nothing else.
  const Drive drive = Drive::open(out / "drive");
  const OverheadSummary made = coarse_overhead(map, drive, out / "overhead");
  EXPECT_EQ(made.vehicles.front().source, VehicleSource::kMeasured);
  EXPECT_LT(made.vehicles.front().masked_share.front(), 0.01);
  EXPECT_GT(share_on_seen_ground(map, made, 10.0), 0.99);
}

}  // namespace
}  // namespace roadbook
