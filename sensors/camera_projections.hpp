#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>

#include "sensors/camera_model.hpp"

namespace roadbook {

// The projections of the camera models, templated on the scalar (double, or a dual number such as
// ceres::Jet). Simulation, estimation and diagnosis use the same functions. `q`: parameters in the
// order listed at CameraModel; `p`: point in the camera frame. Each writes the pixel, and returns
// false if the model cannot see the point.

/// The number within a scalar: itself, or the value of a dual number.
inline double scalar_value(double x) { return x; }
template <typename Dual>
auto scalar_value(const Dual& x) -> decltype(static_cast<double>(x.a)) {
  return x.a;
}

/// Whether r(theta) of Kannala-Brandt grows from 0 to `theta` [rad]. Beyond the first angle where
/// it stops growing, two rays share a pixel. Exact except for slopes below 1e-9.
[[nodiscard]] bool kannala_brandt_grows(const double* k, double theta);
/// Radius r(theta), its slope, and the angle of a radius on the growing branch up to `max_angle`
/// (exact to rounding error; empty only if there is no such angle).
[[nodiscard]] double kannala_brandt_radius(const double* k, double theta);
[[nodiscard]] double kannala_brandt_slope(const double* k, double theta);
[[nodiscard]] std::optional<double> kannala_brandt_angle(const double* k,
                                                         double radius,
                                                         double max_angle);
/// Whether the radial part r (1 + k1 r^2 + k2 r^4) of radial-tangential distortion grows up to r^2
/// = `r2`.
[[nodiscard]] bool radtan_grows(const double* k, double r2);

/// Radial-tangential distortion of OpenCV's first four coefficients, on the normalised plane.
template <typename T>
Eigen::Matrix<T, 2, 1> distort_radtan(const T* k, const T& x, const T& y) {
  const T xx = x * x;
  const T yy = y * y;
  const T r2 = xx + yy;
  const T radial = T(1) + r2 * (k[0] + r2 * k[1]);
  return {x * radial + T(2) * k[2] * x * y + k[3] * (r2 + T(2) * xx),
          y * radial + T(2) * k[3] * x * y + k[2] * (r2 + T(2) * yy)};
}

/// `radtan_grows` up to the point m of the normalised plane.
template <typename T>
bool sees_radtan(const T* k, const Eigen::Matrix<T, 2, 1>& m) {
  const std::array<double, 2> radial{scalar_value(k[0]), scalar_value(k[1])};
  return radtan_grows(radial.data(), scalar_value(T(m.squaredNorm())));
}

template <typename T>
bool project_pinhole(const T* q, const Eigen::Matrix<T, 3, 1>& p, Eigen::Matrix<T, 2, 1>* pixel) {
  if (!(p.z() > T(0))) return false;
  const Eigen::Matrix<T, 2, 1> m(p.x() / p.z(), p.y() / p.z());
  if (!sees_radtan(q + 4, m)) return false;
  const auto d = distort_radtan(q + 4, m.x(), m.y());
  *pixel = {q[0] * d.x() + q[2], q[1] * d.y() + q[3]};
  return true;
}

template <typename T>
bool project_kannala_brandt(const T* q,
                            const Eigen::Matrix<T, 3, 1>& p,
                            Eigen::Matrix<T, 2, 1>* pixel) {
  using std::atan2;
  using std::sqrt;
  const T rho2 = p.x() * p.x() + p.y() * p.y();
  if (!(rho2 > T(1e-24))) {  // on the axis: r / rho tends to 1 / z
    if (!(p.z() > T(0))) return false;
    *pixel = {q[0] * p.x() / p.z() + q[2], q[1] * p.y() / p.z() + q[3]};
    return true;
  }
  const T rho = sqrt(rho2);
  const T theta = atan2(rho, p.z());
  const std::array<double, 4> k{scalar_value(q[4]), scalar_value(q[5]), scalar_value(q[6]),
                                scalar_value(q[7])};
  if (!kannala_brandt_grows(k.data(), scalar_value(theta))) return false;
  const T t2 = theta * theta;
  const T r = theta * (T(1) + t2 * (q[4] + t2 * (q[5] + t2 * (q[6] + t2 * q[7]))));
  const T s = r / rho;
  *pixel = {q[0] * s * p.x() + q[2], q[1] * s * p.y() + q[3]};
  return true;
}

template <typename T>
bool project_omni(const T* q, const Eigen::Matrix<T, 3, 1>& p, Eigen::Matrix<T, 2, 1>* pixel) {
  using std::sqrt;
  const T d = sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
  const T denominator = p.z() + q[0] * d;
  // Beyond this angle two rays share a pixel (xi > 1) or none is left (xi <= 1).
  const T limit = q[0] > T(1) ? T(-d / q[0]) : T(-q[0] * d);
  if (!(p.z() > limit) || !(denominator > T(1e-9) * d)) return false;
  const Eigen::Matrix<T, 2, 1> m(p.x() / denominator, p.y() / denominator);
  if (!sees_radtan(q + 5, m)) return false;
  const auto distorted = distort_radtan(q + 5, m.x(), m.y());
  *pixel = {q[1] * distorted.x() + q[3], q[2] * distorted.y() + q[4]};
  return true;
}

template <typename T>
bool project_double_sphere(const T* q,
                           const Eigen::Matrix<T, 3, 1>& p,
                           Eigen::Matrix<T, 2, 1>* pixel) {
  using std::sqrt;
  const T& xi = q[0];
  const T& alpha = q[1];
  const T xy2 = p.x() * p.x() + p.y() * p.y();
  const T d1 = sqrt(xy2 + p.z() * p.z());
  const T w1 = alpha > T(0.5) ? T((T(1) - alpha) / alpha) : T(alpha / (T(1) - alpha));
  const T w2 = (w1 + xi) / sqrt(T(2) * w1 * xi + xi * xi + T(1));
  if (!(p.z() > -w2 * d1)) return false;  // Usenko et al. 2018, eq. 43
  const T z1 = xi * d1 + p.z();
  const T d2 = sqrt(xy2 + z1 * z1);
  const T denominator = alpha * d2 + (T(1) - alpha) * z1;
  if (!(denominator > T(1e-9) * d1)) return false;
  *pixel = {q[2] * p.x() / denominator + q[4], q[3] * p.y() / denominator + q[5]};
  return true;
}

/// Pixel of a point in the camera frame by `model` with parameters `q`.
template <typename T>
bool project_with(CameraModel model,
                  const T* q,
                  const Eigen::Matrix<T, 3, 1>& p,
                  Eigen::Matrix<T, 2, 1>* pixel) {
  switch (model) {
    case CameraModel::kPinholeRadtan:
      return project_pinhole(q, p, pixel);
    case CameraModel::kKannalaBrandt:
      return project_kannala_brandt(q, p, pixel);
    case CameraModel::kOmni:
      return project_omni(q, p, pixel);
    case CameraModel::kDoubleSphere:
      return project_double_sphere(q, p, pixel);
  }
  return false;
}

}  // namespace roadbook
