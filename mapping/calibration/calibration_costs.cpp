#include "mapping/calibration/calibration_costs.hpp"

#include <algorithm>

#include "mapping/cameras/principal_point.hpp"
#include "mapping/optimisation/ceres_motion_cost.hpp"
#include "mapping/optimisation/motion_residual.hpp"
#include "sensors/correction.hpp"
#include "vo/planar_motion.hpp"

namespace roadbook {
namespace {

template <int kRows, int kColumns>
using RowMajor = Eigen::Matrix<double, kRows, kColumns, Eigen::RowMajor>;

constexpr double kHidden = 20.0;  // residual of a point that the camera cannot see [sigma]

// Steps of the numeric derivatives by the wheels' errors.
constexpr WheelBlock kSteps{1e-4, 1e-4, 1e-4, 2e-3};

// A motion at the end of a drive that a large delay moves beyond the readings.
bool says_nothing(double* residuals, double** jacobians) {
  std::fill_n(residuals, 6, 0.0);
  if (jacobians == nullptr) return true;
  constexpr std::array<int, 3> kSizes{7, 7, kColumnsOfWheels};
  for (std::size_t block = 0; block < kSizes.size(); ++block)
    if (jacobians[block] != nullptr) std::fill_n(jacobians[block], 6 * kSizes[block], 0.0);
  return true;
}

}  // namespace

PixelCost::PixelCost(const MountedCamera& mounted,
                     const Vector6d& twist,
                     const BundleObservation& view)
    : mounted_(mounted), twist_(twist), view_(view), centre_(principal_point(mounted.camera)) {}

bool PixelCost::Evaluate(const double* const* parameters,
                         double* residuals,
                         double** jacobians) const {
  const Eigen::Isometry3d T = pose_of(parameters[0]);
  const Eigen::Vector3d p_map = Eigen::Map<const Eigen::Vector3d>(parameters[1]);
  const Eigen::Vector3d turn = Eigen::Map<const Eigen::Vector3d>(parameters[2]);
  const double focal = 1.0 + parameters[2][3];
  const double delay = parameters[2][4] - mounted_.exposed_after_s;
  const Eigen::Isometry3d back = se3_exp(delay * twist_);
  const Eigen::Vector3d q_stamp = T.inverse() * p_map;  // in the vehicle at the stamp
  const Eigen::Vector3d q = back * q_stamp;             // when the image was taken
  const Eigen::Matrix3d R_camera_vehicle =
      so3_exp(turn).transpose() * mounted_.T_vehicle_camera.linear().transpose();
  const Eigen::Vector3d p_camera = R_camera_vehicle * (q - mounted_.T_vehicle_camera.translation());
  Matrix23d D;
  const auto stated = mounted_.camera.project(p_camera, &D);
  Eigen::Map<Eigen::Vector2d> r(residuals);
  const bool seen = stated && stated->allFinite();
  if (seen)
    r = (centre_ + focal * (*stated - centre_) - view_.pixel) / view_.sigma_px;
  else
    r = Eigen::Vector2d(kHidden, 0.0);
  if (jacobians == nullptr) return true;
  const double inv_sigma = seen ? 1.0 / view_.sigma_px : 0.0;
  if (!seen) D.setZero();
  const Matrix23d by_camera = inv_sigma * focal * D;
  const Matrix23d by_q = by_camera * R_camera_vehicle;
  const Matrix23d by_stamp = by_q * back.linear();
  if (jacobians[0] != nullptr) {
    Eigen::Map<RowMajor<2, 7>> J(jacobians[0]);
    J.leftCols<3>() = -by_stamp;
    J.middleCols<3>(3) = by_stamp * skew<double>(q_stamp);
    J.col(6).setZero();
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<RowMajor<2, 3>> J(jacobians[1]);
    J = by_stamp * T.linear().transpose();
  }
  if (jacobians[2] != nullptr) {
    Eigen::Map<RowMajor<2, kColumnsOfCamera>> J(jacobians[2]);
    J.leftCols<3>() = by_camera * skew<double>(p_camera) * so3_right_jacobian(turn);
    J.col(3) = seen ? Eigen::Vector2d(inv_sigma * (*stated - centre_))
                    : Eigen::Vector2d(Eigen::Vector2d::Zero());
    const Eigen::Vector3d v = twist_.head<3>();
    const Eigen::Vector3d w = twist_.tail<3>();
    J.col(4) = by_q * (v + w.cross(q));
  }
  return true;
}

bool GroundCost::Evaluate(const double* const* parameters,
                          double* residuals,
                          double** jacobians) const {
  const Eigen::Isometry3d T = pose_of(parameters[0]);
  const Eigen::Vector3d p_map = Eigen::Map<const Eigen::Vector3d>(parameters[1]);
  const Eigen::Vector3d q = T.inverse() * p_map;
  residuals[0] = q.z() / sigma_m_;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    Eigen::Map<RowMajor<1, 7>> J(jacobians[0]);
    J << 0.0, 0.0, -1.0, -q.y(), q.x(), 0.0, 0.0;
    J /= sigma_m_;
  }
  if (jacobians[1] != nullptr) {
    Eigen::Map<RowMajor<1, 3>> J(jacobians[1]);
    J = T.linear().col(2).transpose() / sigma_m_;
  }
  return true;
}

WheelCost::WheelCost(const CalibrationMotion& motion, std::int64_t t_from_ns, std::int64_t t_to_ns)
    : motion_(motion), t_from_ns_(t_from_ns), t_to_ns_(t_to_ns) {
  const WheelBlock none{};
  root_ = root_of(planar_information(this->motion(none.data()).value()));
}

std::optional<PlanarMotion> WheelCost::motion(const double* wheels) const {
  const WheelModel real = corrected_wheels(motion_.model, {{"wheels0.radius", wheels[0]},
                                                           {"wheels0.radius_difference", wheels[1]},
                                                           {"wheels0.track_width", wheels[2]},
                                                           {"wheels0.latency", wheels[3]}});
  return WheelOdometry(real, motion_.readings).between(t_from_ns_, t_to_ns_);
}

bool WheelCost::Evaluate(const double* const* parameters,
                         double* residuals,
                         double** jacobians) const {
  const auto now = motion(parameters[2]);
  if (!now) return says_nothing(residuals, jacobians);
  const Eigen::Isometry3d T_from = pose_of(parameters[0]);
  const Eigen::Isometry3d T_to = pose_of(parameters[1]);
  const MotionResidual m = motion_residual(T_from, T_to, planar_transform(*now), 1.0);
  Eigen::Map<Vector6d> r(residuals);
  r = root_ * m.r;
  if (jacobians == nullptr) return true;
  const auto write_pose = [&](const Matrix6d& of, double* jacobian) {
    if (jacobian == nullptr) return;
    Eigen::Map<RowMajor<6, 7>> J(jacobian);
    J.leftCols<6>() = root_ * of;
    J.col(6).setZero();
  };
  write_pose(m.J_from, jacobians[0]);
  write_pose(m.J_to, jacobians[1]);
  if (jacobians[2] == nullptr) return true;
  Eigen::Map<RowMajor<6, kColumnsOfWheels>> J(jacobians[2]);
  for (std::size_t k = 0; k < kSteps.size(); ++k) {
    WheelBlock more;
    std::copy_n(parameters[2], more.size(), more.begin());
    WheelBlock less = more;
    more[k] += kSteps[k];
    less[k] -= kSteps[k];
    const auto above = motion(more.data());
    const auto below = motion(less.data());
    if (!above || !below) return says_nothing(residuals, jacobians);
    J.col(static_cast<Eigen::Index>(k)) =
        root_ *
        (motion_error(T_from, T_to, planar_transform(*above), 1.0) -
         motion_error(T_from, T_to, planar_transform(*below), 1.0)) /
        (2.0 * kSteps[k]);
  }
  return true;
}

}  // namespace roadbook
