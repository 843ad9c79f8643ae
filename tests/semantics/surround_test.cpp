// One instant of real four-fisheye rigs: the ground must join across cameras.

#include <gtest/gtest.h>
#include <unistd.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/semantics/overhead_scene.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

Eigen::MatrixXd matrix(const cv::FileStorage& file, const std::string& name) {
  cv::Mat values;
  file[name] >> values;
  Eigen::MatrixXd m(values.rows, values.cols);
  for (int r = 0; r < m.rows(); ++r)
    for (int c = 0; c < m.cols(); ++c) m(r, c) = values.at<double>(r, c);
  return m;
}

// oecs_surround: p_cam = R p_ground + t, ground x right, y forward, t in decimetres.
MountedCamera oecs_camera(const fs::path& yaml, const std::string& name) {
  const cv::FileStorage file(yaml.string(), cv::FileStorage::READ);
  const Eigen::MatrixXd K = matrix(file, "camera_matrix");
  const Eigen::MatrixXd k = matrix(file, "dist_coeffs");
  MountedCamera mounted;
  mounted.name = name;
  mounted.camera.model = CameraModel::kKannalaBrandt;
  mounted.camera.parameters = {K(0, 0), K(1, 1), K(0, 2), K(1, 2), k(0), k(1), k(2), k(3)};
  mounted.camera.width = 1280;
  mounted.camera.height = 1080;
  mounted.camera.max_angle_rad = 1.5;
  Eigen::Isometry3d T_camera_ground = Eigen::Isometry3d::Identity();
  T_camera_ground.linear() = nearest_rotation(matrix(file, "R_cam_ground"));
  T_camera_ground.translation() = 0.1 * matrix(file, "t_cam_ground");
  Eigen::Isometry3d T_ground_vehicle = Eigen::Isometry3d::Identity();
  T_ground_vehicle.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  mounted.T_vehicle_camera = (T_camera_ground * T_ground_vehicle).inverse();
  return mounted;
}

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
  return input;
}

OverheadOptions instant_options() {
  OverheadOptions options;
  options.max_range_m = 6.0;
  // The car's size is not given: cameras sit 3.4 m apart along it and 1.3 m across.
  options.own_car = {Eigen::Vector3d(-1.6, -0.6, 0.15), Eigen::Vector3d(1.6, 0.6, 1.5)};
  return options;
}

// Median shift [m] between what two cameras alone show of the same ground, by phase correlation of
// 1.3 m squares.
struct Join {
  double median_m = 0.0;
  int patches = 0;
};

Join join_of(const OverheadInput& input, std::size_t a, std::size_t b, const fs::path& out) {
  OverheadOptions options = instant_options();
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

// The set's calibration is its authors'; 10 cm is what it leaves 3-5 m away from the cameras.
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
    const Join join = join_of(input, a, (a + 1) % 4, out.path() / "pair");
    RecordProperty("join_cm_" + std::to_string(a), std::to_string(100 * join.median_m));
    std::printf("cameras %zu-%zu: %.1f cm over %d patches\n", a, (a + 1) % 4, 100 * join.median_m,
                join.patches);
    patches += join.patches;
    EXPECT_LT(join.median_m, 0.10) << a;
  }
  EXPECT_GT(patches, 8);
}

}  // namespace
}  // namespace roadbook
