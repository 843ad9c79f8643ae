#include "vo/track_drive.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/se3.hpp"
#include "sensors/camera_centre.hpp"
#include "vo/odometry_run.hpp"
#include "vo/wheels/false_times.hpp"
#include "vo/wheels/wheel_correction.hpp"
#include "vo/wheels/wheel_doubts.hpp"
#include "vo/wheels/wheel_report.hpp"
#include "vo/wheels/wheel_signs.hpp"

namespace roadbook {

namespace {

// Shares of the drive that the cameras alone must know to be asked about the wheels, and to work
// without them.
constexpr double kAskedShare = 0.5;
constexpr double kAloneShare = 0.8;

double share_known_by(const VoResult& sight, const Drive& drive, const WheelOdometry& wheels) {
  std::vector<std::int64_t> frames_ns;
  for (std::size_t i = 0; i < drive.frame_count(); ++i)
    frames_ns.push_back(drive.frame_stamp_ns(i));
  return known_share(sight, wheels, frames_ns);
}

WheelOdometry possible_wheels(const WheelModel& model, const std::vector<WheelReading>& readings) {
  WheelOdometry wheels(model, readings);
  for (const auto& [begin, end] : impossible_times(model, readings)) wheels.distrust(begin, end);
  return wheels;
}

// Mean distance of successive keyframes [m, odometry's scale] that no turn made necessary.
std::optional<double> straight_step_m(const VoResult& odometry, double turn_rad) {
  constexpr std::size_t kFewest = 20;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 1; k < odometry.keyframes.size(); ++k) {
    if (odometry.keyframes[k].after_gap) continue;
    const Eigen::Isometry3d T =
        odometry.keyframes[k - 1].T_odom_vehicle.inverse() * odometry.keyframes[k].T_odom_vehicle;
    if (std::abs(heading_of(T)) > 0.5 * turn_rad) continue;
    sum += T.translation().norm();
    ++count;
  }
  if (count < kFewest || !(sum > 0.0)) return std::nullopt;
  return sum / static_cast<double>(count);
}

// The wheels of a drive, and the odometry with and without them.
class WheelTrial {
 public:
  WheelTrial(const Drive& drive,
             const std::vector<cv::Mat>& masks,
             const TrackDriveOptions& options,
             const Progress& progress)
      : drive_(drive),
        masks_(masks),
        options_(options),
        progress_(progress),
        height_m_(centre_of_cameras(drive.rig()).z()) {}

  VoResult run() const {
    const WheelModel& model = *drive_.wheel_model();
    if (auto result = with_sound_times(model, drive_.wheel_readings())) return std::move(*result);
    VoResult sight = run_odometry(drive_, masks_, options_, nullptr, progress_);
    const WheelOdometry wheels = possible_wheels(model, drive_.wheel_readings());
    const double known = sight.keyframes.size() < 2 ? 0.0 : share_known_by(sight, drive_, wheels);
    if (known < kAskedShare) {
      VoResult result = run_odometry(drive_, masks_, options_, &wheels, progress_);
      result.doubts.push_back(describe_unjudged(known));
      return result;
    }
    const auto ground = ground_factor(sight, height_m_);
    const WheelComparison comparison = compare_wheels(sight, wheels, ground);
    const auto correction = find_wheel_correction(sight, model, drive_.wheel_readings(), ground);
    if (correction && correction->is_needed()) {
      SensorDoubt doubt = describe_correction(*correction, comparison, sight, origin_ns());
      auto result = with_sound_times(corrected(model, *correction),
                                     corrected(drive_.wheel_readings(), *correction));
      if (result) {
        result->doubts.insert(result->doubts.begin(), std::move(doubt));
        return std::move(*result);
      }
    }
    return known < kAloneShare ? with_doubtful_wheels(sight, wheels, comparison)
                               : without_doubtful_wheels(std::move(sight), wheels, comparison);
  }

 private:
  [[nodiscard]] std::int64_t origin_ns() const { return drive_.frame_stamp_ns(0); }

  // Odometry that uses the wheels except in the times in which it shows that they are wrong. Empty
  // if the wheels have a wrong scale, or are wrong in most of the drive.
  [[nodiscard]] std::optional<VoResult> with_sound_times(
      const WheelModel& model, const std::vector<WheelReading>& readings) const {
    constexpr int kRounds = 4;
    const WheelOdometry recorded = possible_wheels(model, readings);
    std::vector<TimeSpan> suspected;  // not used in the next round
    std::vector<TimeSpan> kept;       // suspected before, and used since
    std::vector<TimeSpan> kept_unknown;
    for (const auto& [begin, end] : false_standstills(drive_, masks_, options_, recorded))
      add_span(suspected, begin, end);
    for (int round = 0; round < kRounds; ++round) {
      WheelOdometry wheels = recorded;
      for (const auto& [begin, end] : suspected) wheels.distrust(begin, end);
      VoResult result = run_odometry(drive_, masks_, options_, &wheels, progress_);
      const WheelSigns signs = find_wheel_signs(result, wheels, height_m_);
      if (signs.scale) return std::nullopt;
      std::vector<TimeSpan> wrong;
      for (const SpanVerdict& verdict : judge_spans(suspected, result, recorded)) {
        if (verdict.is_known && verdict.is_doubted)
          wrong.push_back(verdict.span);
        else
          (verdict.is_known ? kept : kept_unknown).push_back(verdict.span);
      }
      const bool is_new = wrong.size() < suspected.size();
      const auto more = without(without(signs.spans, kept), kept_unknown);
      if (!is_new && more.empty())
        return with_doubts(std::move(result), recorded, wrong, kept_unknown);
      suspected = united(std::move(wrong), more);
    }
    return std::nullopt;
  }

  // Adds what is wrong with the wheels to the odometry that did without them there. Empty if too
  // little is left of them.
  [[nodiscard]] std::optional<VoResult> with_doubts(VoResult result,
                                                    const WheelOdometry& recorded,
                                                    const std::vector<TimeSpan>& wrong,
                                                    const std::vector<TimeSpan>& unknown) const {
    const WheelComparison comparison = compare_wheels_in(wrong, result, recorded);
    if (!comparison.rest_is_useful()) return std::nullopt;
    if (!wrong.empty())
      result.doubts.push_back(describe_doubts(comparison, result, origin_ns(), false));
    if (!unknown.empty()) result.doubts.push_back(describe_unknown(unknown, origin_ns()));
    return result;
  }

  // The cameras lose their way without the wheels: these stay in use, and the doubts are stated.
  [[nodiscard]] VoResult with_doubtful_wheels(const VoResult& sight,
                                              const WheelOdometry& wheels,
                                              const WheelComparison& comparison) const {
    VoResult result = run_odometry(drive_, masks_, options_, &wheels, progress_);
    if (comparison.doubts.empty()) return result;
    SensorDoubt doubt = describe_doubts(comparison, sight, origin_ns(), comparison.doubts_all());
    doubt.want =
        "what the cameras see within 4 sigma; the cameras lose their way without the wheels, "
        "which stay in use";
    result.doubts.push_back(std::move(doubt));
    return result;
  }

  // Leaves out the wheels where they contradict the cameras, or all of them.
  [[nodiscard]] VoResult without_doubtful_wheels(VoResult sight,
                                                 WheelOdometry wheels,
                                                 const WheelComparison& comparison) const {
    SensorDoubt all = describe_doubts(comparison, sight, origin_ns(), true);
    if (!comparison.doubts_all()) {
      const SensorDoubt some = describe_doubts(comparison, sight, origin_ns(), false);
      for (const WheelDoubt& doubt : comparison.doubts)
        wheels.distrust(doubt.span.first, doubt.span.second);
      sight = {};
      VoResult result = run_odometry(drive_, masks_, options_, &wheels, progress_);
      if (comparison.doubts.empty()) return result;
      if (!find_wheel_signs(result, wheels, height_m_).any()) {
        result.doubts.push_back(some);
        return result;
      }
      result = {};
      sight = run_odometry(drive_, masks_, options_, nullptr, progress_);
    }
    sight = evenly_spaced(std::move(sight));
    sight.doubts.push_back(std::move(all));
    return sight;
  }

  // Cameras alone space keyframes by their own scale, and carry no distance over from one to the
  // next. If the ground says that the spacing is another than wanted, they run again.
  [[nodiscard]] VoResult evenly_spaced(VoResult sight) const {
    constexpr double kUneven = 0.1;  // as a logarithm
    constexpr double kMost = 2.0;
    const auto ground = ground_factor(sight, height_m_);
    const auto step_m = straight_step_m(sight, options_.odometry.turn_rad);
    if (!ground || !step_m) return sight;
    const double factor = options_.odometry.spacing_m / (*ground * *step_m);
    if (std::abs(std::log(factor)) < kUneven) return sight;
    TrackDriveOptions even = options_;
    even.odometry.spacing_m *= std::clamp(factor, 1.0 / kMost, kMost);
    sight = {};
    return run_odometry(drive_, masks_, even, nullptr, progress_);
  }

  const Drive& drive_;
  const std::vector<cv::Mat>& masks_;
  const TrackDriveOptions& options_;
  const Progress& progress_;
  double height_m_;
};

}  // namespace

VoResult track_drive(const Drive& drive,
                     const std::vector<cv::Mat>& masks,
                     const TrackDriveOptions& options,
                     const Progress& progress) {
  options.check();
  if (drive.rig().cameras.empty())
    throw BadInput({Severity::kError, drive.folder().string(), 0, "cameras", "none",
                    "at least one camera to map with"});
  cv::setNumThreads(1);  // the images are already shared among our own threads
  if (!options.use_wheels || !drive.wheel_model())
    return run_odometry(drive, masks, options, nullptr, progress);
  return WheelTrial(drive, masks, options, progress).run();
}

}  // namespace roadbook
