#include "mapping/loops/loop_misfit.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "mapping/optimisation/motion_residual.hpp"

namespace roadbook {

double loop_misfit(const Eigen::Isometry3d& T_map_from,
                   const Eigen::Isometry3d& T_map_to,
                   const Eigen::Isometry3d& T_from_to,
                   const Matrix6d& information) {
  constexpr double kSlackM = 0.1;
  constexpr double kSlackRad = 0.02;
  const Vector6d e = motion_error(T_map_from, T_map_to, T_from_to, 1.0);
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(kSlackM * kSlackM),
      Eigen::Vector3d::Constant(kSlackRad * kSlackRad);
  const Eigen::LLT<Matrix6d> llt(information);
  if (llt.info() == Eigen::Success) covariance += llt.solve(Matrix6d::Identity());
  return std::sqrt(e.dot(covariance.llt().solve(e)));
}

}  // namespace roadbook
