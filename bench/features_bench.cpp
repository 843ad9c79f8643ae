#include <benchmark/benchmark.h>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/random.hpp"
#include "vo/brisk_description.hpp"
#include "vo/corners.hpp"

// Measures the refinement of 300 corners of an image of 640 x 480 and their description. Compares
// the description with that of OpenCV's BRISK, on one thread.

namespace roadbook {
namespace {

struct Scene {
  cv::Mat image;
  std::vector<cv::Point2f> corners;
};

Scene scene() {
  Random random(1, "scene");
  cv::Mat coarse(120, 160, CV_8U);
  for (int y = 0; y < coarse.rows; ++y)
    for (int x = 0; x < coarse.cols; ++x)
      coarse.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.below(256));
  Scene made;
  cv::resize(coarse, made.image, {640, 480}, 0, 0, cv::INTER_LINEAR);
  for (int i = 0; i < 300; ++i)
    made.corners.emplace_back(static_cast<float>(random.uniform(24.0, 616.0)),
                              static_cast<float>(random.uniform(24.0, 456.0)));
  cv::setNumThreads(1);
  return made;
}

void refine(benchmark::State& state) {
  const Scene s = scene();
  for (auto _ : state)
    for (const cv::Point2f& corner : s.corners)
      benchmark::DoNotOptimize(refine_corner(s.image, corner));
}
BENCHMARK(refine)->Unit(benchmark::kMillisecond);

void describe(benchmark::State& state) {
  const Scene s = scene();
  for (auto _ : state) benchmark::DoNotOptimize(describe_corners(s.image, s.corners));
}
BENCHMARK(describe)->Unit(benchmark::kMillisecond);

void describe_by_opencv(benchmark::State& state) {
  const Scene s = scene();
  const cv::Ptr<cv::BRISK> brisk = cv::BRISK::create(30, 0);
  for (auto _ : state) {
    std::vector<cv::KeyPoint> corners;
    for (const cv::Point2f& corner : s.corners) corners.emplace_back(corner, 12.0F);
    cv::Mat described;
    brisk->compute(s.image, corners, described);
    benchmark::DoNotOptimize(described);
  }
}
BENCHMARK(describe_by_opencv)->Unit(benchmark::kMillisecond);

void make_by_opencv(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(cv::BRISK::create(30, 0));
}
BENCHMARK(make_by_opencv)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbook
