#include "mapping/pipeline/ground.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/cell_grid.hpp"
#include "mapping/loops/loop_closure.hpp"
#include "sensors/camera_centre.hpp"

namespace roadbook {
namespace {

constexpr double kCell = 4.0;
constexpr double kLargestDrift = 0.7;  // of odometry's scale over a stretch, as a logarithm

constexpr double kHeightSigma = 0.005;      // of the cameras' stated height: common to all windows
constexpr int kSamePassKeyframes = 60;      // 12 m; a lap is longer
constexpr double kLargestCorrection = 0.2;  // of the scale by the odometry, as a logarithm
constexpr double kWindowSigma = 0.03;       // of a window's scale: slopes, kerbs, pitch of the car

// Scale of a stretch by the ground around the car that the odometry saw: far more points than those
// that the car drives over. Empty where it saw too few in half of the keyframes. Neighbours see
// much the same ground: the standard deviation is that of a window.
std::optional<GroundScale> odometry_scale(const MappingInput& input,
                                          const std::vector<int>& segments,
                                          std::size_t begin,
                                          std::size_t end,
                                          int segment) {
  std::vector<double> seen;
  std::size_t asked = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const VoKeyframe& keyframe = input.odometry.keyframes[k];
    if (segments[k] != segment || keyframe.wheels) continue;
    ++asked;
    if (keyframe.ground_log_scale) seen.push_back(*keyframe.ground_log_scale);
  }
  if (asked == 0 || 2 * seen.size() < asked) return std::nullopt;
  const auto middle = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  std::nth_element(seen.begin(), middle, seen.end());
  return GroundScale{std::exp(*middle), 0.0, static_cast<int>(seen.size())};
}

}  // namespace

std::vector<GroundView> view_from_above(const MappingInput& input,
                                        const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                        const std::vector<JoinedTrack>& tracks,
                                        const GroundOptions& options) {
  const auto segments = segments_of(input.odometry.keyframes);
  CellGrid<int> keyframes(kCell);
  for (std::size_t k = 0; k < T_map_vehicle.size(); ++k)
    keyframes.insert(T_map_vehicle[k].translation().head<2>(), static_cast<int>(k));
  std::vector<GroundView> views(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!tracks[i].p_map) continue;
    const Eigen::Vector3d& p = *tracks[i].p_map;
    const int segment = segments[static_cast<std::size_t>(tracks[i].views.front().keyframe)];
    double best = std::hypot(options.ahead_m, options.beside_m);
    keyframes.visit_near(p.head<2>(), [&](int k) {
      if (segments[static_cast<std::size_t>(k)] != segment) return;
      if (k - tracks[i].views.back().keyframe > options.max_keyframe_distance ||
          tracks[i].views.front().keyframe - k > options.max_keyframe_distance)
        return;
      const Eigen::Isometry3d& T = T_map_vehicle[static_cast<std::size_t>(k)];
      const Eigen::Vector3d p_vehicle = T.inverse() * p;
      if (std::abs(p_vehicle.x()) > options.ahead_m || std::abs(p_vehicle.y()) > options.beside_m ||
          std::abs(p_vehicle.z()) > 3.0)
        return;
      const double distance = p_vehicle.head<2>().norm();
      if (!(distance < best)) return;
      best = distance;
      views[i] = {k, p_vehicle};
    });
  }
  return views;
}

double ground_level(const std::vector<GroundView>& views, const GroundOptions& options) {
  constexpr double kFarthest = 0.5;
  constexpr std::ptrdiff_t kFewest = 30;
  std::vector<double> heights;
  for (const auto& view : views)
    if (view.keyframe >= 0 && std::abs(view.p_vehicle.z()) < kFarthest)
      heights.push_back(view.p_vehicle.z());
  std::sort(heights.begin(), heights.end());
  double level = 0.0;
  std::ptrdiff_t support = kFewest - 1;
  for (auto first = heights.begin(); first != heights.end(); ++first) {
    const auto last = std::upper_bound(first, heights.end(), *first + options.height_m);
    if (last - first <= support) continue;
    support = last - first;
    level = *(first + support / 2);
  }
  return level;
}

bool on_ground(const GroundView& view, double level_m, const GroundOptions& options) {
  return view.keyframe >= 0 && std::abs(view.p_vehicle.z() - level_m) <= options.height_m;
}

ScaleProfile ground_scale_profile(const MappingInput& input,
                                  const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                  const std::vector<JoinedTrack>& tracks,
                                  int window) {
  const std::size_t count = T_map_vehicle.size();
  std::vector<std::vector<double>> ratios(count);
  GroundOptions near;
  near.max_keyframe_distance = kSamePassKeyframes;
  const auto views = view_from_above(input, T_map_vehicle, tracks, near);
  for (const auto& view : views) {
    if (view.keyframe < 0) continue;
    const double height = centre_of_cameras(input.rig_of(view.keyframe)).z();
    ratios[static_cast<std::size_t>(view.keyframe)].push_back(height /
                                                              (height - view.p_vehicle.z()));
  }
  const auto segments = segments_of(input.odometry.keyframes);
  const auto estimate = [&](std::size_t begin, std::size_t end, int segment) {
    const auto seen = odometry_scale(input, segments, begin, end, segment);
    std::vector<double> all;
    for (std::size_t k = begin; k < end; ++k)
      if (segments[k] == segment) all.insert(all.end(), ratios[k].begin(), ratios[k].end());
    if (seen)
      std::erase_if(all, [&](double ratio) {
        return !(std::abs(std::log(ratio / seen->scale)) < kLargestCorrection);
      });
    const auto scale = ground_scale(std::move(all));
    return scale ? scale : seen;
  };
  ScaleProfile profile;
  profile.factor.assign(count, 1.0);
  profile.stretch_sigma.assign(count, 0.0);
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin;
    while (end < count && segments[end] == segments[begin]) ++end;
    const auto whole = estimate(begin, end, segments[begin]);
    if (whole) {
      profile.found = true;
      const double windows = std::max(1.0, static_cast<double>(end - begin) / window);
      const double sigma =
          std::hypot(kHeightSigma, std::hypot(kWindowSigma / std::sqrt(windows), whole->sigma));
      std::fill(profile.stretch_sigma.begin() + static_cast<std::ptrdiff_t>(begin),
                profile.stretch_sigma.begin() + static_cast<std::ptrdiff_t>(end), sigma);
    }
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t half = static_cast<std::size_t>(window) / 2;
      const auto local =
          estimate(k > begin + half ? k - half : begin, std::min(end, k + half), segments[begin]);
      if (local)
        profile.local.push_back(
            {static_cast<int>(k), std::log(local->scale), std::hypot(kWindowSigma, local->sigma)});
      // A window without enough ground, or with one that cannot be, takes that of the whole
      // stretch.
      const bool believed =
          local && (!whole || std::abs(std::log(local->scale / whole->scale)) < kLargestDrift);
      profile.factor[k] = believed ? local->scale : whole ? whole->scale : 1.0;
    }
    begin = end;
  }
  return profile;
}

std::optional<double> largest_sigma(const ScaleProfile& profile,
                                    std::size_t begin,
                                    std::size_t end) {
  double largest = 0.0;
  for (std::size_t k = begin; k < end; ++k) largest = std::max(largest, profile.stretch_sigma[k]);
  return largest > 0.0 ? std::optional(largest) : std::nullopt;
}

}  // namespace roadbook
