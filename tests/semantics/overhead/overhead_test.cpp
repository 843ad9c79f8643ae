#include "semantics/overhead/overhead.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/error.hpp"
#include "base/random.hpp"
#include "tests/semantics/overhead_scene.hpp"

namespace roadbook {
namespace {

using test::bytes_of;
using test::drive_over;
using test::PaintedGround;
using test::quick_overhead;
using test::read_band;
using test::Scratch;

// Finds the places where the image crosses middle grey along y near `y0`, at many x between the
// cross lines. The result is the largest distance of the line's two edges from their true places,
// and the number of places.
struct Edges {
  double worst_m = 0.0;
  int found = 0;
};

Edges edges_of_line(const OverheadSummary& s, const cv::Mat_<double>& image, double y0) {
  Edges edges;
  const auto column_of = [&](double x) {
    return static_cast<int>((x - s.west_m) / s.resolution_m);
  };
  const auto row_of = [&](double y) { return static_cast<int>((s.north_m - y) / s.resolution_m); };
  for (double x = 0.5; x < 3.6; x += 0.1) {
    if (std::abs(x - 2.0 * std::round(x / 2.0)) < 0.3) continue;
    const int c = column_of(x);
    std::vector<double> crossings;
    for (int r = row_of(y0 + 0.6); r < row_of(y0 - 0.6); ++r) {
      const double a = image(r, c) - 140.0;
      const double b = image(r + 1, c) - 140.0;
      if (image(r, c) == 0 || image(r + 1, c) == 0 || (a < 0) == (b < 0)) continue;
      crossings.push_back(s.north_m - (r + 0.5 + a / (a - b)) * s.resolution_m);
    }
    if (crossings.size() != 2) continue;
    ++edges.found;
    edges.worst_m = std::max({edges.worst_m, std::abs(crossings[0] - (y0 + 0.05)),
                              std::abs(crossings[1] - (y0 - 0.05))});
  }
  return edges;
}

// Offset of the drawn line along x near `y0`: the offset of the brightest row. Grey values are
// averaged over the x between two cross lines. NaN if the ground was not seen.
double shift_of_line(const OverheadSummary& s, const cv::Mat_<double>& image, double y0) {
  double best = 0.0;
  double shift = std::nan("");
  for (double y = y0 - 0.8; y <= y0 + 1.2; y += s.resolution_m) {
    double sum = 0.0;
    for (double x = 0.5; x < 1.5; x += s.resolution_m)
      sum += image(static_cast<int>((s.north_m - y) / s.resolution_m),
                   static_cast<int>((x - s.west_m) / s.resolution_m));
    if (sum <= best) continue;
    best = sum;
    shift = y - y0;
  }
  return shift;
}

TEST(Overhead, MarkingEdgesLieWithinFiveCentimetresOfTheTruth) {
  const Scratch out("edges");
  const auto s =
      make_overhead(drive_over({.grey = test::lines}, 4, 1.0), out.path(), quick_overhead());
  const auto image = read_band(s.image);
  for (const double y : {3.0, -3.0}) {
    const Edges edges = edges_of_line(s, image, y);
    EXPECT_GT(edges.found, 15) << y;
    EXPECT_LT(edges.worst_m, 0.05) << y;
  }
}

// Only landmarks give the floor beyond the hinge. They have 2 cm noise, and one in twenty does not
// lie on the ground.
TEST(Overhead, AHingedFloorJoinsWithLocalPlanesAndDoesNotWithOne) {
  const Scratch out("hinge");
  const double slope = std::tan(2.0 * M_PI / 180.0);
  const PaintedGround floor{.hinge_y_m = 2.0, .hinge_slope = slope, .grey = test::lines};
  OverheadInput input = drive_over(floor, 4, 1.0);
  const auto one_plane = make_overhead(input, out.path() / "plane", quick_overhead());

  Random random(7);
  std::vector<GroundPoint> points;
  std::vector<Eigen::Vector2d> around;
  for (const OverheadView& view : input.views) {
    around.emplace_back(view.T_map_vehicle.translation().head<2>());
    for (const double x : {0.0, 2.6})
      for (const double y : {-0.75, 0.75})
        points.push_back({view.T_map_vehicle * Eigen::Vector3d(x, y, 0), 0.01});
  }
  for (int i = 0; i < 400; ++i) {
    const double x = random.uniform(-8, 14);
    const double y = random.uniform(-8, 8);
    const double wrong = i % 20 == 0 ? 0.5 : 0.0;
    points.push_back({{x, y, floor.height(y) + random.normal(0.0, 0.02) + wrong}, 0.03});
  }
  input.ground = GroundModel::fit(points, around);
  const auto planes = make_overhead(input, out.path() / "planes", quick_overhead());

  const auto local = read_band(planes.image);
  EXPECT_LT(edges_of_line(planes, local, 3.0).worst_m, 0.05);
  EXPECT_LT(edges_of_line(planes, local, -3.0).worst_m, 0.05);
  // The line at 6 m lies 14 cm above the floor's first plane and 5 m from a camera of height 1 m.
  // With one plane, the image shows the line 0.14 * 4.7 / (1.0 - 0.14) = 0.76 m too far out.
  const double far_local = shift_of_line(planes, local, 6.0);
  const double far_flat = shift_of_line(one_plane, read_band(one_plane.image), 6.0);
  EXPECT_LT(std::abs(far_local), 0.10);
  EXPECT_GT(far_flat, 0.20);
  RecordProperty("one_plane_cm", std::to_string(100 * far_flat));
  RecordProperty("local_planes_cm", std::to_string(100 * far_local));
}

TEST(Overhead, MeanModeIsTheArithmeticMeanOfTheImages) {
  const Scratch out("mean");
  OverheadInput input;
  input.rigs = {test::four_fisheyes()};
  input.rigs[0].cameras.resize(1);
  for (const int grey : {60, 90, 153}) {
    OverheadView view;
    const cv::Mat image(360, 480, CV_8UC1, cv::Scalar(grey));
    view.images.emplace_back([image] { return image; });
    input.views.push_back(view);
  }
  OverheadOptions options = quick_overhead();
  options.mode = OverheadMode::kMean;
  options.balance_exposure = false;
  const auto s = make_overhead(input, out.path(), options);
  const auto image = read_band(s.image);
  const auto count = read_band(s.count);
  const auto variance = read_band(s.variance);
  const auto first = read_band(s.frames, 2);
  const auto last = read_band(s.frames, 3);
  int seen = 0;
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 0; c < image.cols; ++c) {
      if (count(r, c) == 0) {
        EXPECT_EQ(image(r, c), 0);
        continue;
      }
      ++seen;
      ASSERT_EQ(count(r, c), 3);
      ASSERT_EQ(image(r, c), 101);  // (60 + 90 + 153) / 3
      ASSERT_NEAR(variance(r, c), (41.0 * 41 + 11 * 11 + 52 * 52) / 3, 0.01);
      ASSERT_EQ(first(r, c), 0);
      ASSERT_EQ(last(r, c), 2);
    }
  }
  EXPECT_GT(seen, 10000);
}

TEST(Overhead, GivesTheSameBytesOnAnyNumberOfThreadsAndWithLittleMemory) {
  const Scratch out("threads");
  const OverheadInput input = drive_over({.grey = test::lines}, 5, 6.0);
  OverheadOptions options = quick_overhead();
  options.num_threads = 1;
  const auto one = make_overhead(input, out.path() / "one", options);
  options.num_threads = 3;
  options.memory_mb = 64;
  const auto three = make_overhead(input, out.path() / "three", options);
  EXPECT_EQ(one.tiles_spilled, 0U);
  EXPECT_GT(three.tiles_spilled, 0U);
  EXPECT_FALSE(std::filesystem::exists(out.path() / "three" / ".overhead_scratch"));
  EXPECT_EQ(bytes_of(one.image), bytes_of(three.image));
  EXPECT_EQ(bytes_of(one.count), bytes_of(three.count));
  EXPECT_EQ(bytes_of(one.variance), bytes_of(three.variance));
  EXPECT_EQ(bytes_of(one.frames), bytes_of(three.frames));
  EXPECT_EQ(bytes_of(one.frame_table), bytes_of(three.frame_table));
  EXPECT_EQ(bytes_of(one.tile_table), bytes_of(three.tile_table));
}

// Decoding takes as long as the rest: images wait in memory between the two passes. Where there is
// no room, they are decoded again, for the same bytes.
TEST(Overhead, DecodesAnImageOnceWhereMemoryAllows) {
  const Scratch out("decodes");
  OverheadInput input = drive_over({.grey = test::lines}, 5, 6.0);
  std::vector<std::atomic<int>> calls(20);
  for (std::size_t view = 0; view < input.views.size(); ++view)
    for (std::size_t camera = 0; camera < 4; ++camera) {
      auto& image = input.views[view].images[camera];
      image = [&counter = calls[4 * view + camera], decode = image] {
        ++counter;
        return decode();
      };
    }
  OverheadOptions options = quick_overhead();
  const auto once = make_overhead(input, out.path() / "once", options);
  for (const auto& count : calls) EXPECT_EQ(count, 1);
  EXPECT_EQ(once.images_used, 20U);
  // 25 tiles take 62 MB of these: half of the images have room.
  options.memory_mb = 64;
  const auto again = make_overhead(input, out.path() / "again", options);
  const int sum = std::accumulate(calls.begin(), calls.end(), 0,
                                  [](int so_far, const auto& count) { return so_far + count; });
  EXPECT_GT(sum, 20 + 20);
  EXPECT_LT(sum, 20 + 40);
  EXPECT_EQ(bytes_of(once.image), bytes_of(again.image));
  EXPECT_EQ(bytes_of(once.variance), bytes_of(again.variance));
}

// A smooth gradient of grey: no step between neighbouring pixels, at tile borders or elsewhere.
TEST(Overhead, TileBordersCannotBeSeen) {
  const Scratch out("borders");
  const auto ramp = [](double x, double y) { return 120.0 + 4.0 * x + 3.0 * y; };
  const auto s = make_overhead(drive_over({.grey = ramp}, 4, 1.0), out.path(), quick_overhead());
  const auto image = read_band(s.image);
  ASSERT_GT(image.cols, 256);
  int compared = 0;
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 255; c + 1 < image.cols; c += 256) {
      if (image(r, c) == 0 || image(r, c + 1) == 0) continue;
      ++compared;
      ASSERT_LE(std::abs(image(r, c) - image(r, c + 1)), 2.0) << r << " " << c;
    }
  }
  EXPECT_GT(compared, 300);
}

TEST(Overhead, GdalReadsPlaceAndCoordinateSystem) {
  const Scratch out("gdal");
  const auto s =
      make_overhead(drive_over({.grey = test::lines}, 2, 1.0), out.path(), quick_overhead());
  FILE* const pipe = ::popen(("gdalinfo -json " + s.image.string()).c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    text.append(buffer.data(), n);
  ASSERT_EQ(::pclose(pipe), 0);
  const auto info = nlohmann::json::parse(text);
  EXPECT_EQ(info["geoTransform"], nlohmann::json({s.west_m, 0.02, 0.0, s.north_m, 0.0, -0.02}));
  const std::string wkt = info["coordinateSystem"]["wkt"];
  EXPECT_NE(wkt.find("ENGCRS"), std::string::npos) << wkt;
  EXPECT_EQ(info["bands"][0]["noDataValue"], 0.0);
  EXPECT_EQ(info["bands"][0]["block"], nlohmann::json({256, 256}));
  EXPECT_FALSE(info["bands"][0]["overviews"].empty());
}

TEST(Overhead, LeavesOutTheGroundUnderAndBehindTheOwnCar) {
  const Scratch out("car");
  const auto s =
      make_overhead(drive_over({.grey = test::lines}, 1, 1.0), out.path(), quick_overhead());
  const auto image = read_band(s.image);
  const auto at = [&](double x, double y) {
    return image(static_cast<int>((s.north_m - y) / 0.02), static_cast<int>((x - s.west_m) / 0.02));
  };
  EXPECT_EQ(at(1.5, 0.4), 0);
  EXPECT_GT(at(5.5, 0.5), 0);
}

TEST(Overhead, RefusesWhatCannotBeUsed) {
  const Scratch out("bad");
  OverheadInput input = drive_over({.grey = test::lines}, 1, 1.0);
  input.views[0].images[2] = [] { return cv::Mat(10, 20, CV_8UC1, cv::Scalar(1)); };
  EXPECT_THROW((void)make_overhead(input, out.path(), quick_overhead()), BadInput);
  for (auto& image : input.views[0].images) image = [] { return cv::Mat(); };
  EXPECT_THROW((void)make_overhead(input, out.path(), quick_overhead()), Refused);
  input.views[0].rig = 1;
  EXPECT_THROW((void)make_overhead(input, out.path(), quick_overhead()), BadInput);
  OverheadOptions options;
  options.resolution_m = 0.0;
  EXPECT_THROW(options.check(), InvalidOption);
}

}  // namespace
}  // namespace roadbook
