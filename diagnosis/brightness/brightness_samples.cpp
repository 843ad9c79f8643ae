#include "diagnosis/brightness/brightness_samples.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

// Keyframes of the session whose images are read.
std::vector<int> chosen_keyframes(const Map& map, int session, const BrightnessOptions& options) {
  std::vector<int> own;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    if (map.keyframes[k].session == session) own.push_back(static_cast<int>(k));
  std::vector<int> chosen;
  for (int burst = 0; burst < options.bursts; ++burst)
    for (int i = 0; i < options.burst_keyframes; ++i) {
      const std::size_t k =
          at(burst) * own.size() / at(options.bursts) + at(i * options.step_keyframes);
      if (k < own.size() && (chosen.empty() || own[k] > chosen.back())) chosen.push_back(own[k]);
    }
  return chosen;
}

std::optional<double> patch_mean(const cv::Mat& image,
                                 const Eigen::Vector2f& pixel,
                                 const BrightnessOptions& options) {
  const int half = options.patch_px / 2;
  const int x = static_cast<int>(std::lround(pixel.x()));
  const int y = static_cast<int>(std::lround(pixel.y()));
  if (x < half || y < half || x + half >= image.cols || y + half >= image.rows) return std::nullopt;
  const cv::Rect square(x - half, y - half, 2 * half + 1, 2 * half + 1);
  const double mean = cv::mean(image(square))[0];
  if (mean < options.darkest || mean > options.brightest) return std::nullopt;
  return mean;
}

// Samples of the landmarks `seen` in the images of a keyframe, camera by camera.
std::vector<BrightnessSample> keyframe_samples(const Map& map,
                                               int k,
                                               double t_s,
                                               const std::vector<const Observation*>& seen,
                                               const Drive& drive,
                                               const BrightnessOptions& options) {
  std::vector<BrightnessSample> samples;
  const Keyframe& keyframe = map.keyframes[at(k)];
  const std::vector<MountedCamera>& cameras = map.sessions[at(keyframe.session)].rig.cameras;
  for (std::size_t c = 0; c < std::min(cameras.size(), drive.rig().cameras.size()); ++c) {
    if (at(keyframe.drive_frame) >= drive.frame_count() ||
        !drive.has_image(at(keyframe.drive_frame), c))
      continue;
    const cv::Mat image = drive.read_image(at(keyframe.drive_frame), c);
    if (image.empty()) continue;
    const Eigen::Vector3d eye = (map.T_map_vehicle(k) * cameras[c].T_vehicle_camera).translation();
    for (const Observation* o : seen) {
      if (at(o->camera) != c) continue;
      const auto mean = patch_mean(image, o->pixel, options);
      if (!mean) continue;
      const double middle = 0.5 * (image.cols - 1);
      const double radius =
          std::hypot(o->pixel.x() - middle, o->pixel.y() - 0.5 * (image.rows - 1)) / middle;
      const double distance = (map.p_map(map.landmarks[at(o->landmark)]) - eye).norm();
      samples.push_back({o->landmark, o->camera, t_s, std::log(*mean), radius,
                         std::log(std::max(0.1, distance))});
    }
  }
  return samples;
}

}  // namespace

void BrightnessOptions::check() const {
  const auto require = [](bool good, const char* field, int got) {
    if (!good) throw InvalidOption(field, std::to_string(got), "at least 1");
  };
  require(bursts >= 1, "bursts", bursts);
  require(burst_keyframes >= 1, "burst_keyframes", burst_keyframes);
  require(step_keyframes >= 1, "step_keyframes", step_keyframes);
  require(patch_px >= 1, "patch_px", patch_px);
}

std::vector<BrightnessSample> brightness_samples(const Map& map,
                                                 int session,
                                                 const Drive& drive,
                                                 const BrightnessOptions& options) {
  options.check();
  std::map<int, std::vector<const Observation*>> seen;
  for (const int k : chosen_keyframes(map, session, options)) seen[k];
  for (const Observation& o : map.observations)
    if (const auto k = seen.find(o.keyframe); k != seen.end()) k->second.push_back(&o);
  const std::int64_t start_ns = seen.empty() ? 0 : map.keyframes[at(seen.begin()->first)].t_ns;
  std::vector<int> keyframes;
  for (const auto& [k, observations] : seen) keyframes.push_back(k);
  std::vector<std::vector<BrightnessSample>> of_keyframe(keyframes.size());
  parallel_for(keyframes.size(), options.num_threads, [&](std::size_t i) {
    const int k = keyframes[i];
    const double t_s = 1e-9 * static_cast<double>(map.keyframes[at(k)].t_ns - start_ns);
    of_keyframe[i] = keyframe_samples(map, k, t_s, seen.at(k), drive, options);
  });
  std::vector<BrightnessSample> samples;
  for (const auto& some : of_keyframe) samples.insert(samples.end(), some.begin(), some.end());
  std::stable_sort(
      samples.begin(), samples.end(),
      [](const BrightnessSample& a, const BrightnessSample& b) { return a.landmark < b.landmark; });
  std::vector<BrightnessSample> several;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    while (end < samples.size() && samples[end].landmark == samples[begin].landmark) ++end;
    if (end - begin < 2) continue;
    several.insert(several.end(), samples.begin() + static_cast<std::ptrdiff_t>(begin),
                   samples.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return several;
}

}  // namespace roadbook
