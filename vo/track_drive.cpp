#include "vo/track_drive.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kChunk = 8;  // frames described ahead of the tracking

struct Candidate {
  std::size_t frame = 0;
  std::optional<PlanarMotion> wheels;  // since the candidate before; with wheels only
  bool after_gap = false;
};

// With wheels the keyframes are known before any image is decoded; without, every frame is tried.
std::vector<Candidate> choose_candidates(const Drive& drive,
                                         const TrackDriveOptions& options,
                                         const WheelOdometry* wheels) {
  std::vector<Candidate> candidates;
  const auto max_gap_ns = static_cast<std::int64_t>(options.max_gap_s * 1e9);
  for (std::size_t i = 0; i < drive.frame_count(); ++i) {
    Candidate candidate{i, std::nullopt, false};
    if (candidates.empty()) {
      candidates.push_back(candidate);
      continue;
    }
    const std::int64_t t = drive.frame_stamp_ns(i);
    if (wheels) {
      candidate.wheels = wheels->between(drive.frame_stamp_ns(candidates.back().frame), t);
      if (candidate.wheels &&
          candidate.wheels->motion.head<2>().norm() < options.odometry.spacing_m &&
          std::abs(candidate.wheels->motion.z()) < options.odometry.turn_rad)
        continue;
    }
    candidate.after_gap = !candidate.wheels && t - drive.frame_stamp_ns(i - 1) > max_gap_ns;
    candidates.push_back(candidate);
  }
  return candidates;
}

// A rig of few cameras sees no more than a rig of four, but may look more closely.
FeatureOptions share_of(FeatureOptions features, std::size_t cameras) {
  const int factor = cameras == 1 ? 3 : cameras == 2 ? 2 : 1;
  features.max_features *= factor;
  features.max_per_cell *= factor;
  return features;
}

using FrameFeatures = std::vector<Features>;

std::vector<FrameFeatures> describe(const Drive& drive,
                                    const std::vector<Candidate>& candidates,
                                    std::size_t begin,
                                    const std::vector<cv::Mat>& masks,
                                    const FeatureOptions& features,
                                    int num_threads) {
  const std::size_t end = std::min(candidates.size(), begin + kChunk);
  const std::size_t cameras = drive.rig().cameras.size();
  std::vector<FrameFeatures> chunk(end > begin ? end - begin : 0, FrameFeatures(cameras));
  parallel_for(chunk.size() * cameras, num_threads, [&](std::size_t job) {
    const std::size_t frame = candidates[begin + job / cameras].frame;
    const std::size_t camera = job % cameras;
    if (!drive.has_image(frame, camera)) return;
    const cv::Mat half = drive.read_image_half(frame, camera);
    if (!half.empty())
      chunk[job / cameras][camera] = detect_features(half, masks[camera], features);
  });
  return chunk;
}

}  // namespace

void TrackDriveOptions::check() const {
  features.check();
  odometry.check();
  if (!(max_gap_s > 0.0)) throw InvalidOption("max_gap_s", std::to_string(max_gap_s), "> 0");
}

Rig half_size(const Rig& rig) {
  Rig half = rig;
  for (auto& mounted : half.cameras) mounted.camera = mounted.camera.scaled(0.5);
  return half;
}

VoResult track_drive(const Drive& drive,
                     const std::vector<cv::Mat>& masks,
                     const TrackDriveOptions& options,
                     const Progress& progress) {
  options.check();
  if (drive.rig().cameras.empty())
    throw BadInput({Severity::kError, drive.folder().string(), 0, "cameras", "none",
                    "at least one camera to map with"});
  cv::setNumThreads(1);  // our own threads share the images out
  std::optional<WheelOdometry> wheels;
  if (options.use_wheels && drive.wheel_model())
    wheels.emplace(*drive.wheel_model(), drive.wheel_readings());
  const auto candidates = choose_candidates(drive, options, wheels ? &*wheels : nullptr);
  VisualOdometry odometry(half_size(drive.rig()), options.odometry);
  std::int64_t last_keyframe_t = 0;
  const FeatureOptions features = share_of(options.features, drive.rig().cameras.size());
  const auto describe_from = [&](std::size_t begin) {
    return describe(drive, candidates, begin, masks, features, options.num_threads);
  };
  auto next = std::async(std::launch::async, describe_from, std::size_t{0});
  for (std::size_t begin = 0; begin < candidates.size(); begin += kChunk) {
    auto chunk = next.get();
    if (begin + kChunk < candidates.size())
      next = std::async(std::launch::async, describe_from, begin + kChunk);
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      const Candidate& candidate = candidates[begin + i];
      VoFrame frame;
      frame.frame = candidate.frame;
      frame.t_ns = drive.frame_stamp_ns(candidate.frame);
      frame.features = std::move(chunk[i]);
      frame.after_gap = candidate.after_gap;
      if (wheels && begin + i > 0) frame.wheels = wheels->between(last_keyframe_t, frame.t_ns);
      if (odometry.add(std::move(frame)) == VoOutcome::kKeyframe)
        last_keyframe_t = drive.frame_stamp_ns(candidate.frame);
    }
    report(progress, "odometry", begin + chunk.size(), candidates.size());
  }
  return odometry.finish();
}

}  // namespace roadbook
