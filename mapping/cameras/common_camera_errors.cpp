#include "mapping/cameras/common_camera_errors.hpp"

#include <map>
#include <optional>
#include <vector>

#include "base/index.hpp"
#include "mapping/cameras/principal_point.hpp"

namespace roadbook {
namespace {

// How much higher corners lie than their objects, half-size image. The strongest point lies inside
// a corner, and more corners open downwards. By the true poses, 16 cameras of four simulated drives
// said 0.09 to 0.21; adjusted poses absorb nearly everything.
constexpr double kCornersTooHighPx = 0.15;

// Pixel of a point by a camera with errors (half-size image); empty where it cannot see the point.
std::optional<Eigen::Vector2d> predicted(const MountedCamera& mounted,
                                         const CameraErrors& errors,
                                         const Eigen::Vector3d& p_vehicle) {
  const Eigen::Matrix3d R = so3_exp(errors.head<3>()) * mounted.T_vehicle_camera.linear();
  const Eigen::Vector3d origin = mounted.T_vehicle_camera.translation() + errors.segment<3>(6);
  const auto pixel = mounted.camera.project(R.transpose() * (p_vehicle - origin));
  if (!pixel) return std::nullopt;
  const Eigen::Vector2d centre = principal_point(mounted.camera);
  return centre + errors.segment<2>(4) + (1.0 + errors[3]) * (*pixel - centre);
}

// Adds what the errors of one camera do to the pixels that it saw.
void add_shift(int session,
               int number,
               const CameraErrors& errors,
               const KeyframeMotion& motion,
               const BundleStage& stage,
               CommonError& shift) {
  const BundleProblem& problem = stage.problem;
  const int camera = stage.camera_base[at(session)] + number;
  const MountedCamera& mounted = problem.cameras[at(camera)];
  shift.pixels.resize(problem.observations.size(), Eigen::Vector2d::Zero());
  for (std::size_t o = 0; o < problem.observations.size(); ++o) {
    const BundleObservation& seen = problem.observations[o];
    if (seen.camera != camera) continue;
    const Eigen::Vector3d& p_map = problem.points[at(seen.point)].p_map;
    const Eigen::Isometry3d& T = problem.poses[at(seen.pose)].T_map_vehicle;
    const Eigen::Isometry3d T_late = T * se3_exp(-errors[9] * motion.twist[at(seen.pose)]);
    const auto as_calibrated = predicted(mounted, CameraErrors::Zero(), T.inverse() * p_map);
    const auto with_errors = predicted(mounted, errors, T_late.inverse() * p_map);
    if (as_calibrated && with_errors) shift.pixels[o] += *with_errors - *as_calibrated;
  }
}

// Numbers that are the same for rigs whose cameras have the same model and intrinsics.
std::vector<double> calibration_of(const Rig& rig) {
  std::vector<double> numbers;
  for (const MountedCamera& mounted : rig.cameras) {
    numbers.push_back(static_cast<double>(mounted.camera.model));
    numbers.insert(numbers.end(), mounted.camera.parameters.begin(),
                   mounted.camera.parameters.end());
  }
  return numbers;
}

}  // namespace

std::vector<CommonError> common_errors_of(const std::vector<CameraDoubt>& doubts,
                                          const MappingInput& input,
                                          const BundleStage& stage) {
  std::vector<Eigen::Isometry3d> poses;
  for (const BundlePose& pose : stage.problem.poses) poses.push_back(pose.T_map_vehicle);
  const KeyframeMotion motion = vehicle_motion(input, poses);
  std::vector<CommonError> errors;
  CommonError together;
  int cameras = 0;
  for (const CameraDoubt& doubt : doubts) {
    for (const CameraErrors& named : doubt.errors) {
      errors.emplace_back();
      add_shift(doubt.session, doubt.camera, named, motion, stage, errors.back());
    }
    if (doubt.errors.empty()) continue;
    add_shift(doubt.session, doubt.camera, doubt.errors.front(), motion, stage, together);
    ++cameras;
  }
  if (cameras > 1) errors.push_back(std::move(together));
  CameraErrors longer = CameraErrors::Zero();
  longer[range_of(CameraParameter::kFocal).first] = 0.01;
  CameraErrors lower = CameraErrors::Zero();
  lower[range_of(CameraParameter::kCentre).first + 1] = kCornersTooHighPx;
  CommonError corners;  // of one sign in all sessions: more of them do not average it out
  corners.size = CommonErrorSize::kKnown;
  std::map<std::vector<double>, CommonError> focal;  // of each calibration
  for (std::size_t s = 0; s < input.half_rigs.size(); ++s) {
    const Rig& rig = input.half_rigs[s];
    for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
      add_shift(static_cast<int>(s), static_cast<int>(c), longer, motion, stage,
                focal[calibration_of(rig)]);
      add_shift(static_cast<int>(s), static_cast<int>(c), lower, motion, stage, corners);
    }
  }
  for (auto& [calibration, error] : focal) {
    error.size = CommonErrorSize::kIfShown;
    errors.push_back(std::move(error));
  }
  if (!corners.pixels.empty()) errors.push_back(std::move(corners));
  return errors;
}

}  // namespace roadbook
