#include "mapping/localisation/frame_fix.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"

namespace roadbook {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

std::vector<LandmarkPixel> pixels_of(const std::vector<LandmarkView>& views,
                                     const FrameCorners& corners,
                                     const LandmarkIndex& index) {
  std::vector<LandmarkPixel> pixels;
  for (const LandmarkView& view : views) {
    const KnownLandmark& landmark = index.landmarks()[at(view.landmark)];
    pixels.push_back({view.camera, corners.pixel(view), landmark.p_map, landmark.covariance});
  }
  return pixels;
}

// The angle around the vehicle that is left when the widest gap between directions is taken out.
double spanned(std::vector<double> azimuths) {
  if (azimuths.size() < 2) return 0.0;
  std::sort(azimuths.begin(), azimuths.end());
  double gap = azimuths.front() + kTau - azimuths.back();
  for (std::size_t i = 1; i < azimuths.size(); ++i)
    gap = std::max(gap, azimuths[i] - azimuths[i - 1]);
  return kTau - gap;
}

double azimuth_of_inliers(const std::vector<LandmarkView>& views,
                          const LandmarkIndex& index,
                          const Eigen::Isometry3d& T_vehicle_map) {
  std::vector<double> azimuths;
  for (const LandmarkView& view : views) {
    const Eigen::Vector3d p = T_vehicle_map * index.landmarks()[at(view.landmark)].p_map;
    azimuths.push_back(std::atan2(p.y(), p.x()));
  }
  return spanned(std::move(azimuths));
}

// Horizontal angle that a camera sees along the middle row of its image.
double width_rad(const Camera& camera) {
  const double row = 0.5 * camera.height;
  const auto left = camera.bearing({0.0, row});
  const auto right = camera.bearing({camera.width - 1.0, row});
  if (!left || !right) return std::numbers::pi;
  return std::acos(std::clamp(left->dot(*right), -1.0, 1.0));
}

Matrix6d inverse_of(const Matrix6d& information) {
  // A direction that no landmark shows gets a large variance, not an infinite one.
  return (information + 1e-6 * Matrix6d::Identity()).ldlt().solve(Matrix6d::Identity());
}

}  // namespace

void FrameFixOptions::check() const {
  near.check();
  if (min_inliers < 6) throw InvalidOption("min_inliers", std::to_string(min_inliers), ">= 6");
  if (!(noise_factor > 0.0))
    throw InvalidOption("noise_factor", std::to_string(noise_factor), "> 0");
}

std::optional<FrameFix> fix_frame(const Rig& half_rig,
                                  const FrameCorners& corners,
                                  const LandmarkIndex& index,
                                  const PredictedPose& predicted,
                                  const FrameFixOptions& options,
                                  std::vector<int>* in_view) {
  const std::vector<int> candidates = index.near(predicted.T_map_vehicle, options.near);
  std::optional<RigPosePrior> prior;
  if (options.use_prior)
    prior = {predicted.T_map_vehicle,
             options.prior_share * predicted.covariance.ldlt().solve(Matrix6d::Identity())};
  std::optional<LandmarkPose> pose;
  FoundLandmarks found;
  std::vector<LandmarkPixel> pixels;
  PredictedPose from = predicted;
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    found = find_landmarks(half_rig, corners, index, candidates, from.T_map_vehicle,
                           from.covariance, options.search);
    if (in_view != nullptr) *in_view = found.in_view;
    pixels = pixels_of(found.views, corners, index);
    pose = solve_landmark_pose(half_rig, pixels, from.T_map_vehicle, prior, options.pose);
    if (!pose) return std::nullopt;
    from = {pose->T_map_vehicle, inverse_of(pose->information / options.noise_factor)};
  }
  FrameFix fix;
  fix.T_map_vehicle = from.T_map_vehicle;
  fix.covariance = from.covariance;
  fix.matched = static_cast<int>(found.views.size());
  fix.chi2 = pose->chi2;
  fix.pull_found = pose->pull_found;
  fix.pull_expected = pose->pull_expected;
  std::vector<int> seen(half_rig.cameras.size(), 0);
  for (std::size_t i = 0; i < found.views.size(); ++i) {
    if (!pose->inlier[i]) continue;
    fix.views.push_back(found.views[i]);
    ++seen[at(found.views[i].camera)];
  }
  constexpr int kFewest = 3;  // one or two may agree by chance
  fix.cameras = static_cast<int>(
      std::count_if(seen.begin(), seen.end(), [](int count) { return count >= kFewest; }));
  fix.azimuth_rad = azimuth_of_inliers(fix.views, index, fix.T_map_vehicle.inverse());
  return fix;
}

bool has_enough(const FrameFix& fix, const Rig& rig, const FrameFixOptions& options) {
  if (fix.inliers() < options.min_inliers) return false;
  if (fix.cameras >= 2) return true;
  double wanted = options.min_azimuth_rad;
  if (rig.cameras.size() == 1)
    wanted = std::min(wanted, 0.5 * width_rad(rig.cameras.front().camera));
  return fix.azimuth_rad >= wanted;
}

}  // namespace roadbook
