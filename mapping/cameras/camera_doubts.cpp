#include "mapping/cameras/camera_doubts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

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

const CameraFit* likeliest(const CameraEvidence& evidence) {
  const CameraFit* best = nullptr;
  for (const CameraFit& fit : evidence.fits)
    if (!best || fit.gain > best->gain) best = &fit;
  return best;
}

CameraDoubt doubt_of(const CameraEvidence& evidence, const CameraFit& fit) {
  const auto& e = fit.errors;
  const auto& s = fit.sigmas;
  CameraDoubt doubt{evidence.session, evidence.camera, "", "", ""};
  switch (fit.parameter) {
    case CameraParameter::kRotation:
      doubt.field = "rotation";
      doubt.got = "images of a camera turned by roll " + fixed(degrees(e[0]), 2) + ", pitch " +
                  fixed(degrees(e[1]), 2) + ", yaw " + fixed(degrees(e[2]), 2) + " deg (+- " +
                  fixed(degrees(s.head<3>().maxCoeff()), 2) + ")";
      doubt.want = "the rotation of T_BS in its sensor.yaml";
      break;
    case CameraParameter::kFocal:
      doubt.field = "focal length";
      doubt.got = "images of a focal length " + fixed(100.0 * std::abs(e[3]), 2) +
                  (e[3] > 0.0 ? " % longer" : " % shorter") + " (+- " + fixed(100.0 * s[3], 2) +
                  " %)";
      doubt.want = "the intrinsics of its sensor.yaml";
      break;
    case CameraParameter::kCentre:
      doubt.field = "principal point";
      doubt.got = "images whose principal point lies " + fixed(kFullPerHalfPixel * e[4], 1) +
                  " px farther right and " + fixed(kFullPerHalfPixel * e[5], 1) + " px lower (+- " +
                  fixed(kFullPerHalfPixel * s.segment<2>(4).maxCoeff(), 1) + ")";
      doubt.want = "the intrinsics of its sensor.yaml";
      break;
    case CameraParameter::kPosition:
      doubt.field = "position";
      doubt.got = "images of a camera " + fixed(e[6], 2) + " m farther ahead and " +
                  fixed(e[7], 2) + " m farther left (+- " + fixed(s.segment<2>(6).maxCoeff(), 2) +
                  ")";
      doubt.want = "the position of T_BS in its sensor.yaml";
      break;
    case CameraParameter::kDelay:
      doubt.field = "time_offset";
      doubt.got = "images that are " + fixed(1e3 * std::abs(e[9]), 0) +
                  (e[9] > 0.0 ? " ms older" : " ms younger") + " than their stamps (+- " +
                  fixed(1e3 * s[9], 0) + ")";
      doubt.want = "stamps of the exposures, or the time_offset of its sensor.yaml";
      break;
  }
  return doubt;
}

std::string camera_name(const MappingInput& input, int session, int camera) {
  return input.half_rigs[static_cast<std::size_t>(session)]
      .cameras[static_cast<std::size_t>(camera)]
      .name;
}

// Shares of the tracks of each camera (row) that fit when they are taken for another's (column).
Eigen::MatrixXd shares_as_others(const Rig& rig,
                                 const std::vector<std::vector<CameraTrack>>& tracks,
                                 const VehicleMotion& motion,
                                 const CameraDoubtOptions& options) {
  const auto n = rig.cameras.size();
  Eigen::MatrixXd share(n, n);
  parallel_for(n * n, options.num_threads, [&](std::size_t i) {
    share(static_cast<Eigen::Index>(i / n), static_cast<Eigen::Index>(i % n)) =
        fitting_share(rig.cameras[i % n], tracks[i / n], motion, options.inlier_px);
  });
  return share;
}

// Cameras whose images fit another camera much better than their own: an exchange.
std::vector<CameraDoubt> exchanged(const MappingInput& input,
                                   int session,
                                   const Eigen::MatrixXd& share) {
  std::vector<CameraDoubt> doubts;
  for (Eigen::Index c = 0; c < share.rows(); ++c) {
    Eigen::Index other = 0;
    const double most = share.row(c).maxCoeff(&other);
    if (other == c || most < 0.3 || share(c, c) > 0.6 * most) continue;
    Eigen::Index back = 0;
    (void)share.row(other).maxCoeff(&back);
    const std::string mine = camera_name(input, session, static_cast<int>(c));
    const std::string its = camera_name(input, session, static_cast<int>(other));
    if (back == c && other < c) continue;  // said with the other camera
    doubts.push_back({session, static_cast<int>(c), "images",
                      back == c ? mine + " and " + its +
                                      " look exchanged: each fits the other's "
                                      "calibration"
                                : "images that fit the calibration of " + its,
                      "the images of " + mine});
  }
  return doubts;
}

}  // namespace

std::vector<CameraEvidence> camera_evidence(const MappingInput& input,
                                            const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                            const CameraDoubtOptions& options) {
  const VehicleMotion motion = vehicle_motion(input, T_map_vehicle);
  std::vector<CameraEvidence> all;
  for (int s = 0; s < static_cast<int>(input.half_rigs.size()); ++s)
    for (int c = 0;
         c < static_cast<int>(input.half_rigs[static_cast<std::size_t>(s)].cameras.size()); ++c) {
      CameraEvidence one;
      one.session = s;
      one.camera = c;
      all.push_back(std::move(one));
    }
  parallel_for(all.size(), options.num_threads, [&](std::size_t i) {
    CameraEvidence& one = all[i];
    const auto& mounted = input.half_rigs[static_cast<std::size_t>(one.session)]
                              .cameras[static_cast<std::size_t>(one.camera)];
    const auto tracks = follow_corners(input, one.session, one.camera);
    one.tracks = tracks.size();
    one.repeated_share = repeated_share(input, one.session, one.camera);
    one.fit_share = fitting_share(mounted, tracks, motion, options.inlier_px);
    if (tracks.size() < kFewestTracks) return;
    for (const CameraParameter parameter : kCameraParameters)
      one.fits.push_back(fit_camera(mounted, tracks, motion, parameter));
  });
  return all;
}

std::vector<CameraDoubt> doubt_cameras(const MappingInput& input,
                                       const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                       const CameraDoubtOptions& options) {
  std::vector<CameraDoubt> doubts;
  const auto evidence = camera_evidence(input, T_map_vehicle, options);
  const VehicleMotion motion = vehicle_motion(input, T_map_vehicle);
  for (int s = 0; s < static_cast<int>(input.half_rigs.size()); ++s) {
    const Rig& rig = input.half_rigs[static_cast<std::size_t>(s)];
    if (rig.cameras.size() < 2) continue;
    std::vector<std::vector<CameraTrack>> tracks(rig.cameras.size());
    for (std::size_t c = 0; c < tracks.size(); ++c)
      tracks[c] = follow_corners(input, s, static_cast<int>(c));
    const auto share = shares_as_others(rig, tracks, motion, options);
    if (std::getenv("RB_DOUBT")) {
      for (const auto& e : evidence) {
        std::fprintf(stderr, "DOUBT %d cam%d tracks %zu fit %.3f rep %.2f", e.session, e.camera,
                     e.tracks, e.fit_share, e.repeated_share);
        for (const auto& f : e.fits)
          std::fprintf(stderr, " | %.2f sz %.1f sg", f.gain,
                       relative_size(f, rig.cameras[static_cast<std::size_t>(e.camera)], options)),
              std::fprintf(stderr, " %.0f", significance(f));
        std::fprintf(stderr, "\n");
      }
      for (Eigen::Index r = 0; r < share.rows(); ++r) {
        for (Eigen::Index c = 0; c < share.cols(); ++c) std::fprintf(stderr, " %.2f", share(r, c));
        std::fprintf(stderr, "\n");
      }
    }
    const auto swapped = exchanged(input, s, share);
    doubts.insert(doubts.end(), swapped.begin(), swapped.end());
    double largest = 0.0;
    std::vector<std::pair<double, const CameraEvidence*>> found;
    for (const CameraEvidence& one : evidence) {
      if (one.session != s) continue;
      if (one.repeated_share > kRepeated) {
        doubts.push_back({s, one.camera, "images",
                          fixed(100.0 * one.repeated_share, 0) +
                              " % of them repeat the image before, though the vehicle moves",
                          "a new image each time"});
        continue;
      }
      const CameraFit* fit = likeliest(one);
      if (!fit || !swapped.empty()) continue;
      const auto& camera = rig.cameras[static_cast<std::size_t>(one.camera)];
      const double size = relative_size(*fit, camera, options);
      if (size < 1.0 || significance(*fit) < options.min_sigmas || fit->gain < options.min_gain)
        continue;
      largest = std::max(largest, size);
      found.emplace_back(size, &one);
    }
    for (const auto& [size, one] : found)
      if (size >= options.of_largest * largest) doubts.push_back(doubt_of(*one, *likeliest(*one)));
  }
  return doubts;
}

std::vector<Problem> to_problems(const std::vector<CameraDoubt>& doubts,
                                 const std::vector<Drive>& drives) {
  std::vector<Problem> problems;
  for (const CameraDoubt& doubt : doubts) {
    const Drive& drive = drives[static_cast<std::size_t>(doubt.session)];
    const std::string& name = drive.rig().cameras[static_cast<std::size_t>(doubt.camera)].name;
    problems.push_back({Severity::kWarning, (drive.folder() / name).string(), 0, doubt.field,
                        doubt.got, doubt.want});
  }
  return problems;
}

}  // namespace roadbook
