#include "vo/odometry_run.hpp"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <utility>

#include "base/parallel.hpp"
#include "vo/keyframe_spacing.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kChunk = 8;  // frames described ahead of the tracking

struct Candidate {
  std::size_t frame = 0;
  bool after_gap = false;
};

// Frames that become keyframes by the wheels, known before any image is decoded. Without wheel
// readings every frame is a candidate.
class CandidateChooser {
 public:
  CandidateChooser(const Drive& drive,
                   const TrackDriveOptions& options,
                   const WheelOdometry* wheels)
      : drive_(drive),
        wheels_(wheels),
        max_gap_ns_(static_cast<std::int64_t>(options.max_gap_s * 1e9)),
        spacing_(options.odometry.spacing_m, options.odometry.turn_rad) {}

  std::vector<Candidate> choose() {
    for (std::size_t i = 0; i < drive_.frame_count(); ++i) {
      // If the frame before is the better keyframe, this frame is judged again from there.
      while (!offer(i)) {
      }
    }
    return std::move(candidates_);
  }

 private:
  struct Step {
    std::size_t frame = 0;
    double distance_m = 0.0;
    double turn_rad = 0.0;
  };

  bool offer(std::size_t frame) {
    const auto step = candidates_.empty() ? std::nullopt : step_to(frame);
    if (!step) {
      take_unknown(frame);
      return true;
    }
    const double progress = spacing_.progress(step->distance_m, step->turn_rad);
    if (progress < 1.0) {
      held_ = step;
      return true;
    }
    const bool held_is_nearer =
        held_ && KeyframeSpacing::first_is_nearer(
                     spacing_.progress(held_->distance_m, held_->turn_rad), progress);
    take(held_is_nearer ? *held_ : *step);
    return !held_is_nearer;
  }

  // From the last candidate, where the wheels know it.
  [[nodiscard]] std::optional<Step> step_to(std::size_t frame) const {
    if (!wheels_) return std::nullopt;
    const auto moved = wheels_->between(drive_.frame_stamp_ns(candidates_.back().frame),
                                        drive_.frame_stamp_ns(frame));
    if (!moved) return std::nullopt;
    return Step{frame, moved->motion.head<2>().norm(), moved->motion.z()};
  }

  void take(const Step& step) {
    spacing_.taken(step.distance_m, step.turn_rad, held_.has_value());
    held_.reset();
    candidates_.push_back({step.frame, false});
  }

  void take_unknown(std::size_t frame) {
    const bool after_gap =
        frame > 0 && drive_.frame_stamp_ns(frame) - drive_.frame_stamp_ns(frame - 1) > max_gap_ns_;
    spacing_.restart();
    held_.reset();
    candidates_.push_back({frame, after_gap});
  }

  const Drive& drive_;
  const WheelOdometry* wheels_;
  std::int64_t max_gap_ns_;
  KeyframeSpacing spacing_;
  std::vector<Candidate> candidates_;
  std::optional<Step> held_;  // the newest frame short of the next keyframe
};

// A rig of few cameras sees no more than a rig of four, but may look more closely. A camera that
// turns shows half of its corners in the next keyframe: with few of them it loses its way.
FeatureOptions share_of(FeatureOptions features, std::size_t cameras) {
  constexpr int kFewestOfRig = 480;
  const int factor = cameras == 1 ? 3 : cameras == 2 ? 2 : 1;
  features.max_features *= factor;
  features.max_per_cell *= factor;
  if (factor > 1)
    features.fewest = std::clamp(kFewestOfRig / static_cast<int>(cameras), features.fewest,
                                 features.max_features);
  return features;
}

}  // namespace

double thread_cpu_ms() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return 1e3 * static_cast<double>(used.tv_sec) + 1e-6 * static_cast<double>(used.tv_nsec);
}

std::vector<FrameFeatures> describe_frames(const Drive& drive,
                                           const std::vector<std::size_t>& frames,
                                           std::size_t begin,
                                           std::size_t count,
                                           const std::vector<cv::Mat>& masks,
                                           const TrackDriveOptions& options,
                                           std::vector<double>* cpu_ms) {
  const std::size_t end = std::min(frames.size(), begin + count);
  const std::size_t cameras = drive.rig().cameras.size();
  const FeatureOptions features = share_of(options.features, cameras);
  std::vector<FrameFeatures> chunk(end > begin ? end - begin : 0, FrameFeatures(cameras));
  std::vector<double> used_ms(chunk.size() * cameras, 0.0);
  parallel_for(chunk.size() * cameras, options.num_threads, [&](std::size_t job) {
    const std::size_t frame = frames[begin + job / cameras];
    const std::size_t camera = job % cameras;
    if (!drive.has_image(frame, camera)) return;
    const double start_ms = thread_cpu_ms();
    const cv::Mat half = drive.read_image_half(frame, camera);
    if (!half.empty())
      chunk[job / cameras][camera] = detect_features(half, masks[camera], features);
    used_ms[job] = thread_cpu_ms() - start_ms;
  });
  if (cpu_ms != nullptr) {
    cpu_ms->assign(chunk.size(), 0.0);
    for (std::size_t job = 0; job < used_ms.size(); ++job) (*cpu_ms)[job / cameras] += used_ms[job];
  }
  return chunk;
}

VoResult run_odometry(const Drive& drive,
                      const std::vector<cv::Mat>& masks,
                      const TrackDriveOptions& options,
                      const WheelOdometry* wheels,
                      const Progress& progress) {
  const auto candidates = CandidateChooser(drive, options, wheels).choose();
  std::vector<std::size_t> frames;
  for (const Candidate& candidate : candidates) frames.push_back(candidate.frame);
  VisualOdometry odometry(half_size(drive.rig()), options.odometry);
  std::int64_t last_keyframe_t = 0;
  const auto describe_from = [&](std::size_t begin) {
    return describe_frames(drive, frames, begin, kChunk, masks, options);
  };
  auto next = std::async(std::launch::async, describe_from, std::size_t{0});
  for (std::size_t begin = 0; begin < candidates.size(); begin += kChunk) {
    auto chunk = next.get();
    if (begin + kChunk < candidates.size())
      next = std::async(std::launch::async, describe_from, begin + kChunk);
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      VoFrame frame;
      frame.frame = frames[begin + i];
      frame.t_ns = drive.frame_stamp_ns(frame.frame);
      frame.features = std::move(chunk[i]);
      frame.after_gap = candidates[begin + i].after_gap;
      if (wheels && begin + i > 0) frame.wheels = wheels->between(last_keyframe_t, frame.t_ns);
      (void)odometry.add(std::move(frame));
      last_keyframe_t = odometry.last_keyframe_ns().value_or(last_keyframe_t);
    }
    report(progress, "odometry", begin + chunk.size(), candidates.size());
  }
  VoResult result = odometry.finish();
  result.uses_wheels = wheels != nullptr;
  return result;
}

}  // namespace roadbook
