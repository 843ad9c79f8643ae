#include "workflows/localisation/localisation_figures.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/se3.hpp"

namespace roadbook {
namespace {

// Smallest value that at least `share` of the values do not exceed; empty without values.
std::optional<double> figure_quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  const double count = std::ceil(share * static_cast<double>(values.size()));
  const auto place = static_cast<std::ptrdiff_t>(std::max(1.0, count)) - 1;
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

bool has_fix(const TimedFrame& frame) {
  return frame.pose.status == LocalisationStatus::kLocalised ||
         frame.pose.status == LocalisationStatus::kRelocalised;
}

struct Errors {
  std::vector<double> distance, along, across, heading;
  std::size_t with_truth = 0;
  std::size_t within[3] = {0, 0, 0};
  double nees = 0.0;
  std::size_t with_covariance = 0;
  std::size_t in_ellipse = 0;
};

void add_error(const LocalisedFrame& pose, const Eigen::Isometry3d& T_map_true, Errors& errors) {
  const Eigen::Isometry3d T_true_pose = T_map_true.inverse() * pose.T_map_vehicle;
  const Eigen::Vector3d& off = T_true_pose.translation();
  errors.distance.push_back(off.norm());
  errors.along.push_back(std::abs(off.x()));
  errors.across.push_back(std::abs(off.y()));
  errors.heading.push_back(std::abs(heading_of(T_true_pose)));
  constexpr double kRecall[3] = {0.1, 0.2, 0.5};
  for (int i = 0; i < 3; ++i) errors.within[i] += off.norm() <= kRecall[i] ? 1 : 0;
  if (!is_known(pose.covariance)) return;
  const Vector6d xi = se3_log(pose.T_map_vehicle.inverse() * T_map_true);
  errors.nees += xi.dot(pose.covariance.ldlt().solve(xi)) / 6.0;
  ++errors.with_covariance;
  constexpr double kEllipse = 5.991;  // 0.95 quantile of chi-square, 2 degrees of freedom
  const Eigen::Matrix2d planar = pose.covariance.topLeftCorner<2, 2>();
  const Eigen::Vector2d place = xi.head<2>();
  errors.in_ellipse += place.dot(planar.ldlt().solve(place)) <= kEllipse ? 1 : 0;
}

}  // namespace

std::optional<Eigen::Isometry3d> true_pose_at(const std::vector<TimedPose>& poses,
                                              std::int64_t t_ns) {
  constexpr std::int64_t kLongestNs = 500'000'000;  // between two poses of the truth
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), t_ns,
                       [](const TimedPose& pose, std::int64_t t) { return pose.t_ns < t; });
  if (after == poses.end()) return std::nullopt;
  if (after->t_ns == t_ns) return after->T_world_vehicle;
  if (after == poses.begin()) return std::nullopt;
  const auto before = after - 1;
  if (after->t_ns - before->t_ns > kLongestNs) return std::nullopt;
  const double share =
      static_cast<double>(t_ns - before->t_ns) / static_cast<double>(after->t_ns - before->t_ns);
  const Vector6d step = se3_log(before->T_world_vehicle.inverse() * after->T_world_vehicle);
  return before->T_world_vehicle * se3_exp(share * step);
}

LocalisationFigures localisation_figures(const std::vector<TimedFrame>& frames) {
  LocalisationFigures figures;
  figures.frames = frames.size();
  std::vector<double> inliers;
  std::vector<double> cpu_ms;
  std::vector<double> jumps;
  bool was_lost = false;
  for (const TimedFrame& frame : frames) {
    const LocalisedFrame& pose = frame.pose;
    cpu_ms.push_back(frame.cpu_ms);
    if (has_fix(frame)) inliers.push_back(pose.inliers);
    if (has_fix(frame)) ++figures.localised;
    if (pose.status == LocalisationStatus::kRelocalised) ++figures.relocalised;
    if (pose.status == LocalisationStatus::kPredicted) ++figures.predicted;
    if (std::isfinite(pose.jump_m)) jumps.push_back(pose.jump_m);
    const bool is_lost = pose.status == LocalisationStatus::kLost;
    if (is_lost && !was_lost) figures.lost.push_back({pose.t_ns, pose.t_ns, 0});
    if (is_lost) {
      figures.lost.back().t_end_ns = pose.t_ns;
      ++figures.lost.back().frames;
    }
    was_lost = is_lost;
  }
  figures.inliers_median = figure_quantile(inliers, 0.5);
  figures.inliers_p5 = figure_quantile(inliers, 0.05);
  figures.cpu_ms_median = figure_quantile(cpu_ms, 0.5);
  figures.cpu_ms_p99 = figure_quantile(cpu_ms, 0.99);
  figures.jump_median_m = figure_quantile(jumps, 0.5);
  figures.jump_p999_m = figure_quantile(jumps, 0.999);
  return figures;
}

std::vector<double> localisation_errors(const std::vector<TimedFrame>& frames,
                                        const std::vector<TimedPose>& truth,
                                        const Eigen::Isometry3d& T_map_world) {
  std::vector<double> off_m(frames.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].pose.status == LocalisationStatus::kLost) continue;
    const auto T = true_pose_at(truth, frames[i].pose.t_ns);
    if (!T) continue;
    const Eigen::Vector3d there = T_map_world * T->translation();
    off_m[i] = (frames[i].pose.T_map_vehicle.translation() - there).norm();
  }
  return off_m;
}

std::optional<LocalisationTruth> localisation_truth(const std::vector<TimedFrame>& frames,
                                                    const std::vector<TimedPose>& truth,
                                                    const Eigen::Isometry3d& T_map_world) {
  Errors errors;
  for (const TimedFrame& frame : frames) {
    const auto T_world_true = true_pose_at(truth, frame.pose.t_ns);
    if (!T_world_true) continue;
    ++errors.with_truth;
    if (has_fix(frame)) add_error(frame.pose, T_map_world * *T_world_true, errors);
  }
  if (errors.with_truth == 0) return std::nullopt;
  LocalisationTruth result;
  result.frames = errors.distance.size();
  if (result.frames == 0) return result;  // recalls of zero
  result.median_m = *figure_quantile(errors.distance, 0.5);
  result.p95_m = *figure_quantile(errors.distance, 0.95);
  result.max_m = *figure_quantile(errors.distance, 1.0);
  result.along_median_m = *figure_quantile(errors.along, 0.5);
  result.across_median_m = *figure_quantile(errors.across, 0.5);
  result.heading_median_rad = *figure_quantile(errors.heading, 0.5);
  result.heading_p95_rad = *figure_quantile(errors.heading, 0.95);
  const auto share = [&](std::size_t count) {
    return static_cast<double>(count) / static_cast<double>(errors.with_truth);
  };
  result.recall_0_1_m = share(errors.within[0]);
  result.recall_0_2_m = share(errors.within[1]);
  result.recall_0_5_m = share(errors.within[2]);
  if (errors.with_covariance > 0) {
    const auto count = static_cast<double>(errors.with_covariance);
    result.nees = errors.nees / count;
    result.in_ellipse = static_cast<double>(errors.in_ellipse) / count;
  }
  return result;
}

}  // namespace roadbook
