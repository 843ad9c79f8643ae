#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/parallel.hpp"
#include "semantics/overhead/exposure.hpp"
#include "semantics/overhead/overhead_passes.hpp"

namespace roadbook {
namespace {

constexpr double kSpacing_m = 0.5;  // between the compared places
constexpr double kReach_m = 6.0;    // from the camera; far ground has a flat angle and glare
constexpr int kAveraged_px = 8;     // the grey value of a place is the mean of an 8 x 8 px square
constexpr float kDarkest = 4.0F;    // grey values outside these limits do not measure the exposure
constexpr float kBrightest = 245.0F;
constexpr float kLeastWeight = 0.05F;

std::vector<ExposureSample> sample(const cv::Mat& image,
                                   const GroundCamera& camera,
                                   const Eigen::Vector2d& around,
                                   const GroundModel& ground) {
  cv::Mat averaged;
  cv::resize(image, averaged,
             {std::max(1, image.cols / kAveraged_px), std::max(1, image.rows / kAveraged_px)}, 0, 0,
             cv::INTER_AREA);
  std::vector<ExposureSample> samples;
  const auto low = (around.array() - kReach_m) / kSpacing_m;
  const auto high = (around.array() + kReach_m) / kSpacing_m;
  for (auto row = static_cast<int>(std::floor(low.y())); row <= high.y(); ++row) {
    for (auto column = static_cast<int>(std::floor(low.x())); column <= high.x(); ++column) {
      const double x = column * kSpacing_m;
      const double y = row * kSpacing_m;
      if (std::hypot(x - around.x(), y - around.y()) > kReach_m) continue;
      const auto z = ground.height(x, y);
      if (!z) continue;
      const GroundSight sight = camera.look_at({x, y, *z});
      if (sight.weight < kLeastWeight) continue;
      const int u = std::min(averaged.cols - 1, static_cast<int>(sight.u) / kAveraged_px);
      const int v = std::min(averaged.rows - 1, static_cast<int>(sight.v) / kAveraged_px);
      const auto grey = static_cast<float>(averaged.at<std::uint8_t>(v, u));
      if (grey < kDarkest || grey > kBrightest) continue;
      const std::int64_t place =
          (static_cast<std::int64_t>(row) << 32) ^ static_cast<std::uint32_t>(column);
      const double distance = std::hypot(x - around.x(), y - around.y());
      samples.push_back({place, std::log(grey), static_cast<int>(distance / kSpacing_m)});
    }
  }
  return samples;
}

}  // namespace

std::vector<std::vector<double>> balance_exposure(const OverheadInput& input,
                                                  const PlacedViews& placed,
                                                  const OverheadOptions& options,
                                                  const Progress& progress,
                                                  ViewImages* view_images) {
  std::vector<std::pair<std::size_t, std::size_t>> images;  // (view, camera)
  std::vector<std::vector<double>> gains(input.views.size());
  for (std::size_t view = 0; view < input.views.size(); ++view) {
    const std::size_t cameras =
        input.rigs[static_cast<std::size_t>(input.views[view].rig)].cameras.size();
    gains[view].assign(cameras, 1.0);
    for (std::size_t camera = 0; camera < cameras; ++camera) images.emplace_back(view, camera);
  }
  if (!options.balance_exposure) return gains;

  std::vector<std::vector<ExposureSample>> samples(images.size());
  constexpr std::size_t kBatch = 64;
  for (std::size_t begin = 0; begin < images.size(); begin += kBatch) {
    report(progress, "exposure", begin, images.size());
    parallel_for(std::min(kBatch, images.size() - begin), options.num_threads, [&](std::size_t i) {
      const auto [view, camera] = images[begin + i];
      const cv::Mat image = placed.tiles[view].empty() ? view_images->last(view, camera)
                                                       : view_images->first(view, camera);
      if (image.empty()) return;
      const int rig = input.views[view].rig;
      const MountedCamera& mounted = input.rigs[static_cast<std::size_t>(rig)].cameras[camera];
      const Eigen::Isometry3d& T = placed.T_map_vehicle[view];
      const GroundCamera eye(mounted, mask_of(input, rig, camera), T, options);
      const Eigen::Vector2d centre = (T * mounted.T_vehicle_camera.translation()).head<2>();
      samples[begin + i] = sample(image, eye, centre, input.ground);
    });
  }
  const std::vector<double> flat = estimate_gains(samples, options.gains);
  for (std::size_t i = 0; i < images.size(); ++i)
    gains[images[i].first][images[i].second] = flat[i];
  return gains;
}

}  // namespace roadbook
