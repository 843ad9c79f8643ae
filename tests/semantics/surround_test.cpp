// One instant of real rigs with four fisheyes: the ground must match across cameras.

#include <gtest/gtest.h>
#include <unistd.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/semantics/overhead_scene.hpp"
#include "tests/semantics/surround_cameras.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::neozhao_camera;
using test::oecs_camera;
using test::PosedCamera;

OverheadInput oecs_instant(const fs::path& data, const std::string& sample) {
  OverheadInput input;
  input.rigs.emplace_back();
  OverheadView view;
  for (const std::string name : {"front", "left", "back", "right"}) {
    input.rigs[0].cameras.push_back(oecs_camera(data / (name + ".yaml"), name));
    const std::string letter(1, static_cast<char>(std::toupper(name[0])));
    const cv::Mat image = cv::imread((data / "samples" / (sample + " " + letter + ".jpg")).string(),
                                     cv::IMREAD_GRAYSCALE);
    view.images.emplace_back([image] { return image; });
  }
  input.views.push_back(view);
  // The data set does not give the car's size. The cameras are 3.4 m apart along the car and 1.3 m
  // across.
  input.bodies.emplace_back(Eigen::Vector3d(-1.6, -0.6, 0.15), Eigen::Vector3d(1.6, 0.6, 1.5));
  return input;
}

OverheadOptions instant_options() {
  OverheadOptions options;
  options.max_range_m = 6.0;
  return options;
}

// Median shift [m] between the images that two cameras alone make of the same ground, by phase
// correlation of 1.3 m squares.
struct Join {
  double median_m = 0.0;
  int patches = 0;
};

Join join_of(const OverheadInput& input,
             std::size_t a,
             std::size_t b,
             OverheadOptions options,
             const fs::path& out) {
  options.area = Eigen::AlignedBox2d(Eigen::Vector2d(-7, -7), Eigen::Vector2d(7, 7));
  cv::Mat_<double> image[2];
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    OverheadInput alone = input;
    for (std::size_t c = 0; c < 4; ++c)
      if (c != (i == 0 ? a : b)) alone.views[0].images[c] = [] { return cv::Mat(); };
    image[i] = test::read_band(make_overhead(alone, out, options).image);
  }
  constexpr int kSide = 64;
  cv::Mat window;
  cv::createHanningWindow(window, {kSide, kSide}, CV_64F);
  std::vector<double> shifts;
  for (int r = 0; r + kSide <= image[0].rows; r += kSide / 2) {
    for (int c = 0; c + kSide <= image[0].cols; c += kSide / 2) {
      const cv::Rect patch(c, r, kSide, kSide);
      const cv::Mat_<double> p = image[0](patch);
      const cv::Mat_<double> q = image[1](patch);
      if (cv::countNonZero(p) < kSide * kSide || cv::countNonZero(q) < kSide * kSide) continue;
      double response = 0.0;
      const cv::Point2d shift = cv::phaseCorrelate(p, q, window, &response);
      if (response < 0.25) continue;
      shifts.push_back(std::hypot(shift.x, shift.y) * options.resolution_m);
    }
  }
  if (shifts.empty()) return {};
  std::ranges::nth_element(shifts, shifts.begin() + static_cast<std::ptrdiff_t>(shifts.size() / 2));
  return {shifts[shifts.size() / 2], static_cast<int>(shifts.size())};
}

// The authors of the data set calibrated the cameras. Their calibration leaves errors of 10 cm at
// 3-5 m from the cameras.
TEST(Surround, TheTiledFloorOfARealInstantJoinsAcrossCameras) {
  ROADBOOK_REQUIRE_DATA(data, "oecs_surround");
  const test::Scratch out("oecs");
  const OverheadInput input = oecs_instant(data, "000000");
  const char* const keep = std::getenv("ROADBOOK_KEEP_IMAGES");
  const fs::path folder = keep != nullptr ? fs::path(keep) : out.path() / "all";
  const auto s = make_overhead(input, folder, instant_options());
  EXPECT_EQ(s.images_used, 4U);
  EXPECT_GT(s.covered_m2, 60.0);
  int patches = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    const Join join = join_of(input, a, (a + 1) % 4, instant_options(), out.path() / "pair");
    RecordProperty("join_cm_" + std::to_string(a), std::to_string(100 * join.median_m));
    std::printf("cameras %zu-%zu: %.1f cm over %d patches\n", a, (a + 1) % 4, 100 * join.median_m,
                join.patches);
    patches += join.patches;
    EXPECT_LT(join.median_m, 0.10) << a;
  }
  EXPECT_GT(patches, 8);
}

// Straight segments of the joints between floor tiles in the image: direction modulo 90 degrees,
// and length.
struct Joint {
  double angle_rad;
  double length_m;
};

std::vector<Joint> tile_joints(const cv::Mat_<double>& grey, double resolution_m) {
  cv::Mat image;
  grey.convertTo(image, CV_8U);
  std::vector<cv::Vec4f> segments;
  cv::createLineSegmentDetector()->detect(image, segments);
  std::vector<Joint> joints;
  for (const cv::Vec4f& s : segments) {
    const double dx = s[2] - s[0];
    const double dy = s[3] - s[1];
    joints.push_back({std::atan2(dy, dx), std::hypot(dx, dy) * resolution_m});
  }
  return joints;
}

// Mean direction of a family of segments near `near_rad`, weighted by length, and its standard
// deviation.
struct Family {
  double mean_rad = 0.0;
  double sigma_rad = 0.0;
  double length_m = 0.0;
};

Family family(const std::vector<Joint>& joints, double near_rad, double within_rad) {
  Family f;
  f.mean_rad = near_rad;
  for (int round = 0; round < 3; ++round) {
    double sum = 0.0;
    double square = 0.0;
    double weight = 0.0;
    for (const Joint& joint : joints) {
      const double d = std::remainder(joint.angle_rad - f.mean_rad, M_PI);
      if (joint.length_m < 0.6 || std::abs(d) > within_rad) continue;
      sum += joint.length_m * d;
      square += joint.length_m * d * d;
      weight += joint.length_m;
    }
    if (weight == 0.0) return {};
    f.mean_rad += sum / weight;
    f.sigma_rad = std::sqrt(std::max(0.0, square / weight - sum * sum / (weight * weight)));
    f.length_m = weight;
  }
  return f;
}

// In sample 000000, the floor has square tiles. Their joints are straight and meet at right angles.
// The ends of a 0.6 m segment are accurate to a pixel of 2 cm, which is 2 degrees in direction. The
// mean of tens of segments gives the direction of a family to a few tenths of a degree. The
// calibration leaves rotation errors between the cameras about as large as the gaps at their
// borders (4 cm at 4 m: 0.6 degrees).
TEST(Surround, JointsOfTheTilesAreStraightAndMeetAtRightAngles) {
  ROADBOOK_REQUIRE_DATA(data, "oecs_surround");
  const test::Scratch out("oecs_tiles");
  const auto s = make_overhead(oecs_instant(data, "000000"), out.path(), instant_options());
  const auto joints = tile_joints(test::read_band(s.image), s.resolution_m);
  // The direction of the grid: the bin of one degree, modulo 90 degrees, with most length.
  std::array<double, 90> length{};
  for (const Joint& joint : joints) {
    const double degrees = std::fmod(joint.angle_rad * 180.0 / M_PI + 360.0, 90.0);
    if (joint.length_m > 0.6) length[static_cast<std::size_t>(degrees) % 90] += joint.length_m;
  }
  const auto peak = std::ranges::max_element(length) - length.begin();
  const double grid_rad = (static_cast<double>(peak) + 0.5) * M_PI / 180.0;
  const double within_rad = 5.0 * M_PI / 180.0;
  const Family a = family(joints, grid_rad, within_rad);
  const Family b = family(joints, grid_rad + 0.5 * M_PI, within_rad);
  const double right_deg =
      90.0 + std::remainder(b.mean_rad - a.mean_rad - 0.5 * M_PI, M_PI) * 180.0 / M_PI;
  std::printf("joints: %.0f m and %.0f m, directions spread by %.2f and %.2f degrees, %.2f apart\n",
              a.length_m, b.length_m, a.sigma_rad * 180.0 / M_PI, b.sigma_rad * 180.0 / M_PI,
              right_deg);
  EXPECT_GT(a.length_m, 10.0);
  EXPECT_GT(b.length_m, 10.0);
  EXPECT_NEAR(right_deg, 90.0, 1.0);
  EXPECT_LT(a.sigma_rad * 180.0 / M_PI, 2.0);
  EXPECT_LT(b.sigma_rad * 180.0 / M_PI, 2.0);
}

// Each homography comes from four clicked corners, without the constraint that a pose exists. The
// test measures the remaining error. The images must match within the error of such a pose.
TEST(Surround, PosesFromHomographiesGiveOnePictureOfARealCarPark) {
  ROADBOOK_REQUIRE_DATA(data, "surround4_neozhao");
  const test::Scratch out("neozhao");
  OverheadInput input;
  input.rigs.emplace_back();
  OverheadView view;
  for (const std::string name : {"front", "left", "back", "right"}) {
    const PosedCamera posed = neozhao_camera(data, name);
    const Eigen::Vector3d at = posed.mounted.T_vehicle_camera.translation();
    std::printf("%s at %.2f %.2f %.2f m, axes %.3f, cosine %.3f\n", name.c_str(), at.x(), at.y(),
                at.z(), posed.scale_ratio, posed.cosine);
    // On the outside of the car, at the height of a bumper or a mirror.
    EXPECT_GT(at.z(), 0.4) << name;
    EXPECT_LT(at.z(), 1.6) << name;
    EXPECT_LT(at.head<2>().norm(), 3.0) << name;
    input.rigs[0].cameras.push_back(posed.mounted);
    const cv::Mat image =
        cv::imread((data / "images" / (name + ".png")).string(), cv::IMREAD_GRAYSCALE);
    ASSERT_EQ(image.cols, 960);
    view.images.emplace_back([image] { return image; });
  }
  input.views.push_back(view);
  OverheadOptions options;
  options.max_range_m = 5.0;
  input.bodies.emplace_back(Eigen::Vector3d(-2.5, -1.0, 0.1), Eigen::Vector3d(2.5, 1.0, 1.5));
  const char* const keep = std::getenv("ROADBOOK_KEEP_IMAGES");
  const fs::path folder = keep != nullptr ? fs::path(keep) / "neozhao" : out.path() / "all";
  const auto s = make_overhead(input, folder, options);
  EXPECT_EQ(s.images_used, 4U);
  EXPECT_GT(s.covered_m2, 40.0);
  for (std::size_t a = 0; a < 4; ++a) {
    const Join join = join_of(input, a, (a + 1) % 4, options, out.path() / "pair");
    std::printf("cameras %zu-%zu: %.1f cm over %d patches\n", a, (a + 1) % 4, 100 * join.median_m,
                join.patches);
    EXPECT_LT(join.median_m, 0.15) << a;  // 0 if there is nothing to compare
  }
}

}  // namespace
}  // namespace roadbook
