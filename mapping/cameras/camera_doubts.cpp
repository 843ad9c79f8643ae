#include "mapping/cameras/camera_doubts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "base/format.hpp"
#include "base/parallel.hpp"
#include "vo/track_drive.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kFewestTracks = 60;
constexpr double kRepeated = 0.2;  // share of keyframes that show the same corners again

double degrees(double rad) { return rad * 180.0 / std::numbers::pi; }

// Size of the fitted effect over the size that matters.
double relative_size(const CameraFit& fit,
                     const MountedCamera& camera,
                     const CameraDoubtOptions& o) {
  const ParameterRange range = range_of(fit.parameter);
  const double size = fit.errors.segment(range.first, range.count).norm();
  switch (fit.parameter) {
    case CameraParameter::kRotation:
      return size / o.rotation_rad;
    case CameraParameter::kFocal:
      return size / o.focal;
    case CameraParameter::kCentre:
      return size / (o.centre_share * camera.camera.focal_px());
    case CameraParameter::kPosition:
      return size / o.position_m;
    case CameraParameter::kDelay:
      return size / o.delay_s;
  }
  return 0.0;
}

// Largest of the group's parameters in its standard deviations.
double significance(const CameraFit& fit) {
  const ParameterRange range = range_of(fit.parameter);
  double most = 0.0;
  for (Eigen::Index i = range.first; i < range.first + range.count; ++i)
    if (fit.sigmas[i] > 0.0) most = std::max(most, std::abs(fit.errors[i]) / fit.sigmas[i]);
  return most;
}

// Standard deviation of the fitted effect's size, as a share of the size.
double uncertain_share(const CameraFit& fit) {
  const ParameterRange range = range_of(fit.parameter);
  const auto e = fit.errors.segment(range.first, range.count);
  const auto s = fit.sigmas.segment(range.first, range.count);
  const double squared = e.squaredNorm();
  return squared > 0.0 ? e.cwiseProduct(s).norm() / squared : 1.0;
}

// Larger than the size that matters by at least one standard deviation.
bool matters(const CameraFit& fit, const MountedCamera& camera, const CameraDoubtOptions& options) {
  return relative_size(fit, camera, options) * (1.0 - uncertain_share(fit)) >= 1.0;
}

double least_sigmas(CameraParameter parameter, const CameraDoubtOptions& options) {
  switch (parameter) {
    case CameraParameter::kCentre:
    case CameraParameter::kPosition:
      return options.min_sigmas_weak;  // they differ little from turns and poses
    case CameraParameter::kDelay:
      return options.min_sigmas_delay;
    case CameraParameter::kRotation:
    case CameraParameter::kFocal:
      return options.min_sigmas;
  }
  return options.min_sigmas;
}

// The fits that matter and are no chance, likeliest first: those that explain nearly as much as the
// best. Where a small error explains far more, nothing is left: it does not matter.
std::vector<const CameraFit*> likeliest(const CameraEvidence& evidence,
                                        const MountedCamera& camera,
                                        const CameraDoubtOptions& options) {
  std::vector<const CameraFit*> fits;
  double most = 0.0;
  for (const CameraFit& fit : evidence.fits) {
    if (significance(fit) < least_sigmas(fit.parameter, options) || fit.gain < options.min_gain)
      continue;
    most = std::max(most, fit.gain);
    if (matters(fit, camera, options)) fits.push_back(&fit);
  }
  std::erase_if(fits, [&](const CameraFit* fit) { return fit->gain < options.as_likely * most; });
  std::stable_sort(fits.begin(), fits.end(),
                   [](const CameraFit* a, const CameraFit* b) { return a->gain > b->gain; });
  return fits;
}

struct Wording {
  const char* field;
  std::string got;
  const char* want;
};

Wording wording_of(const CameraFit& fit) {
  const auto& e = fit.errors;
  const auto& s = fit.sigmas;
  switch (fit.parameter) {
    case CameraParameter::kRotation:
      return {"rotation",
              "turned by roll " + fixed(degrees(e[0]), 2) + ", pitch " + fixed(degrees(e[1]), 2) +
                  ", yaw " + fixed(degrees(e[2]), 2) + " deg (+- " +
                  fixed(degrees(s.head<3>().maxCoeff()), 2) + ")",
              "the rotation of T_BS in its sensor.yaml"};
    case CameraParameter::kFocal:
      return {"focal length",
              fixed(100.0 * std::abs(e[3]), 2) + (e[3] > 0.0 ? " % longer" : " % shorter") +
                  " (+- " + fixed(100.0 * s[3], 2) + " %)",
              "the intrinsics of its sensor.yaml"};
    case CameraParameter::kCentre:
      return {"principal point",
              fixed(kFullPerHalfPixel * e[4], 1) + " px farther right, " +
                  fixed(kFullPerHalfPixel * e[5], 1) + " px lower (+- " +
                  fixed(kFullPerHalfPixel * s.segment<2>(4).maxCoeff(), 1) + ")",
              "the intrinsics of its sensor.yaml"};
    case CameraParameter::kPosition:
      return {"position",
              fixed(e[6], 2) + " m farther ahead, " + fixed(e[7], 2) + " m farther left (+- " +
                  fixed(s.segment<2>(6).maxCoeff(), 2) + ")",
              "the position of T_BS in its sensor.yaml"};
    case CameraParameter::kDelay:
      return {"time_offset",
              "images " + fixed(1e3 * std::abs(e[9]), 0) +
                  (e[9] > 0.0 ? " ms older" : " ms younger") + " than their stamps (+- " +
                  fixed(1e3 * s[9], 0) + ")",
              "stamps of the exposures, or the time_offset of its sensor.yaml"};
  }
  return {"", "", ""};
}

CameraDoubt doubt_of(const CameraEvidence& evidence, const std::vector<const CameraFit*>& fits) {
  const Wording first = wording_of(*fits.front());
  CameraDoubt doubt{evidence.session, evidence.camera, first.field,
                    first.got,        first.want,      {fits.front()->errors}};
  for (std::size_t i = 1; i < fits.size(); ++i) {
    const Wording other = wording_of(*fits[i]);
    doubt.got += std::string("; or ") + other.field + " " + other.got;
    doubt.errors.push_back(fits[i]->errors);
  }
  return doubt;
}

// Shares of the tracks of each camera (row) that fit the calibration of each other camera (column).
Eigen::MatrixXd shares_as_others(const Rig& rig,
                                 std::span<const CameraEvidence> evidence,
                                 const KeyframeMotion& motion,
                                 const CameraDoubtOptions& options) {
  const std::size_t n = rig.cameras.size();
  Eigen::MatrixXd share(n, n);
  parallel_for(n * n, options.num_threads, [&](std::size_t i) {
    share(static_cast<Eigen::Index>(i / n), static_cast<Eigen::Index>(i % n)) =
        fitting_share(rig.cameras[i % n], evidence[i / n].tracks, motion, options.inlier_px);
  });
  return share;
}

// Cameras whose images fit another camera much better than their own: an exchange.
std::vector<CameraDoubt> exchanged(const Rig& rig, int session, const Eigen::MatrixXd& share) {
  std::vector<CameraDoubt> doubts;
  for (Eigen::Index c = 0; c < share.rows(); ++c) {
    Eigen::Index other = 0;
    const double most = share.row(c).maxCoeff(&other);
    if (other == c || most < 0.6 || 1.0 - share(c, c) < 3.0 * (1.0 - most) + 0.05) continue;
    Eigen::Index back = 0;
    (void)share.row(other).maxCoeff(&back);
    if (back == c && other < c) continue;  // said with the other camera
    const std::string& mine = rig.cameras[static_cast<std::size_t>(c)].name;
    const std::string& its = rig.cameras[static_cast<std::size_t>(other)].name;
    doubts.push_back(
        {session, static_cast<int>(c), "images",
         back == c ? mine + " and " + its + " look exchanged: each fits the other's calibration"
                   : "images that fit the calibration of " + its,
         "the images of " + mine});
  }
  return doubts;
}

std::vector<CameraDoubt> wrong_parameters(const Rig& rig,
                                          std::span<const CameraEvidence> evidence,
                                          const CameraDoubtOptions& options) {
  struct Found {
    double size = 0.0;
    const CameraEvidence* evidence = nullptr;
    std::vector<const CameraFit*> fits;
  };
  std::vector<Found> found;
  double largest = 0.0;
  for (const CameraEvidence& one : evidence) {
    if (one.repeated_share > kRepeated) continue;
    const MountedCamera& camera = rig.cameras[static_cast<std::size_t>(one.camera)];
    auto fits = likeliest(one, camera, options);
    if (fits.empty()) continue;
    const double size = relative_size(*fits.front(), camera, options);
    largest = std::max(largest, size);
    found.push_back({size, &one, std::move(fits)});
  }
  std::vector<CameraDoubt> doubts;
  for (const Found& one : found)
    if (one.size >= options.of_largest * largest)
      doubts.push_back(doubt_of(*one.evidence, one.fits));
  return doubts;
}

std::vector<CameraDoubt> doubts_of_rig(const Rig& rig,
                                       std::span<const CameraEvidence> evidence,
                                       const KeyframeMotion& motion,
                                       const CameraDoubtOptions& options) {
  std::vector<CameraDoubt> doubts;
  if (rig.cameras.size() < 2) return doubts;
  for (const CameraEvidence& one : evidence)
    if (one.repeated_share > kRepeated)
      doubts.push_back({one.session, one.camera, "images",
                        fixed(100.0 * one.repeated_share, 0) +
                            " % of them repeat the image before, though the vehicle moves",
                        "a new image each time"});
  const auto share = shares_as_others(rig, evidence, motion, options);
  auto more = exchanged(rig, evidence.front().session, share);
  if (more.empty()) more = wrong_parameters(rig, evidence, options);
  doubts.insert(doubts.end(), more.begin(), more.end());
  return doubts;
}

}  // namespace

std::vector<CameraEvidence> camera_evidence(const MappingInput& input,
                                            const KeyframeMotion& motion,
                                            int num_threads) {
  std::vector<CameraEvidence> all;
  for (std::size_t s = 0; s < input.half_rigs.size(); ++s)
    for (std::size_t c = 0; c < input.half_rigs[s].cameras.size(); ++c)
      all.push_back({static_cast<int>(s), static_cast<int>(c), {}, 0.0, {}});
  parallel_for(all.size(), num_threads, [&](std::size_t i) {
    CameraEvidence& one = all[i];
    const Rig& rig = input.half_rigs[static_cast<std::size_t>(one.session)];
    if (rig.cameras.size() < 2) return;
    one.tracks = follow_corners(input, one.session, one.camera);
    one.repeated_share = repeated_share(input, one.session, one.camera);
    if (one.tracks.size() < kFewestTracks) return;
    const MountedCamera& camera = rig.cameras[static_cast<std::size_t>(one.camera)];
    const double before = cost_as_calibrated(camera, one.tracks, motion);
    for (const CameraParameter parameter : kCameraParameters) {
      CameraFit fit = fit_camera(camera, one.tracks, motion, parameter);
      fit.gain = before > 0.0 ? (before - fit.cost) / before : 0.0;
      one.fits.push_back(fit);
    }
  });
  return all;
}

std::vector<CameraDoubt> doubt_cameras(const MappingInput& input,
                                       const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                       const CameraDoubtOptions& options) {
  std::vector<CameraDoubt> doubts;
  const KeyframeMotion motion = vehicle_motion(input, T_map_vehicle);
  const auto evidence = camera_evidence(input, motion, options.num_threads);
  std::size_t begin = 0;
  for (const Rig& rig : input.half_rigs) {
    const auto found =
        doubts_of_rig(rig, std::span(evidence).subspan(begin, rig.cameras.size()), motion, options);
    doubts.insert(doubts.end(), found.begin(), found.end());
    begin += rig.cameras.size();
  }
  return doubts;
}

std::vector<Problem> to_problems(const std::vector<CameraDoubt>& doubts,
                                 const std::vector<Drive>& drives) {
  std::vector<Problem> problems;
  for (const CameraDoubt& doubt : doubts) {
    const Drive& drive = drives[static_cast<std::size_t>(doubt.session)];
    const std::string& name = drive.rig().cameras[static_cast<std::size_t>(doubt.camera)].name;
    // Positions and principal points are no columns of a calibration; exchanged images have no
    // sizes.
    const bool measured =
        doubt.field == "rotation" || doubt.field == "focal length" || doubt.field == "time_offset";
    problems.push_back({Severity::kWarning, (drive.folder() / name).string(), 0, doubt.field,
                        doubt.got,
                        doubt.want + (measured ? "; `roadbook calibrate` measures it" : "")});
  }
  return problems;
}

}  // namespace roadbook
