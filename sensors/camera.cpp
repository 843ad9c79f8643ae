#include "sensors/camera.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sensors/camera_projections.hpp"

namespace roadbook {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kRayIterations = 30;

Matrix2d radtan_jacobian(const double* k, const Vector2d& m) {
  const double r2 = m.squaredNorm();
  const double radial = 1.0 + r2 * (k[0] + r2 * k[1]);
  const double g = k[0] + 2.0 * r2 * k[1];
  const double cross = 2.0 * m.x() * m.y() * g + 2.0 * k[2] * m.x() + 2.0 * k[3] * m.y();
  Matrix2d J;
  J << radial + 2.0 * m.x() * m.x() * g + 2.0 * k[2] * m.y() + 6.0 * k[3] * m.x(), cross, cross,
      radial + 2.0 * m.y() * m.y() * g + 2.0 * k[3] * m.x() + 6.0 * k[2] * m.y();
  return J;
}

std::optional<Vector2d> undistort_radtan(const double* k, const Vector2d& distorted) {
  Vector2d m = distorted;
  for (int i = 0; i < kRayIterations; ++i) {
    const Vector2d error = distort_radtan(k, m.x(), m.y()) - distorted;
    const Matrix2d J = radtan_jacobian(k, m);
    const double det = J.determinant();
    if (!(det > 1e-6)) return std::nullopt;
    Vector2d step = J.inverse() * error;
    const double longest = 0.5 * (1.0 + m.norm());
    if (step.norm() > longest) step *= longest / step.norm();
    m -= step;
    if (step.norm() < 1e-15 * (1.0 + m.norm())) break;
  }
  const double error = (distort_radtan(k, m.x(), m.y()) - distorted).norm();
  if (!(error < 1e-11 * (1.0 + distorted.norm())) || !radtan_grows(k, m.squaredNorm()))
    return std::nullopt;
  return m;
}

std::optional<Vector2d> kannala_brandt(const double* q, const Vector3d& p, Matrix23d* J) {
  const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const double theta = std::atan2(rho, p.z());
  if (!kannala_brandt_grows(q + 4, theta)) return std::nullopt;
  const double slope = kannala_brandt_slope(q + 4, theta);
  const bool on_axis = rho < 1e-12;
  if (on_axis && !(p.z() > 0.0)) return std::nullopt;
  const double s = on_axis ? 1.0 / p.z() : kannala_brandt_radius(q + 4, theta) / rho;
  if (J) {
    const double n2 = rho * rho + p.z() * p.z();
    const double a = on_axis ? 0.0 : (slope * p.z() / n2 - s) / (rho * rho);
    const double b = on_axis ? -s / p.z() : -slope / n2;
    *J << q[0] * (s + a * p.x() * p.x()), q[0] * a * p.x() * p.y(), q[0] * b * p.x(),
        q[1] * a * p.x() * p.y(), q[1] * (s + a * p.y() * p.y()), q[1] * b * p.y();
  }
  return Vector2d(q[0] * s * p.x() + q[2], q[1] * s * p.y() + q[3]);
}

std::optional<Vector2d> pinhole(const double* q, const Vector3d& p, Matrix23d* J) {
  if (!(p.z() > 0.0)) return std::nullopt;
  const Vector2d m(p.x() / p.z(), p.y() / p.z());
  if (!radtan_grows(q + 4, m.squaredNorm())) return std::nullopt;
  const Vector2d d = distort_radtan(q + 4, m.x(), m.y());
  if (J) {
    Matrix23d M;
    M << 1.0 / p.z(), 0.0, -m.x() / p.z(), 0.0, 1.0 / p.z(), -m.y() / p.z();
    *J = Vector2d(q[0], q[1]).asDiagonal() * radtan_jacobian(q + 4, m) * M;
  }
  return Vector2d(q[0] * d.x() + q[2], q[1] * d.y() + q[3]);
}

std::optional<Vector2d> omni(const double* q, const Vector3d& p, Matrix23d* J) {
  Vector2d pixel;
  if (!project_omni(q, p, &pixel)) return std::nullopt;
  const double d = p.norm();
  const double den = p.z() + q[0] * d;
  const Vector2d m(p.x() / den, p.y() / den);
  if (J) {
    const Eigen::RowVector3d d_den = q[0] / d * p.transpose() + Eigen::RowVector3d::UnitZ();
    Matrix23d M = -m * d_den / den;
    M(0, 0) += 1.0 / den;
    M(1, 1) += 1.0 / den;
    *J = Vector2d(q[1], q[2]).asDiagonal() * radtan_jacobian(q + 5, m) * M;
  }
  return pixel;
}

std::optional<Vector2d> double_sphere(const double* q, const Vector3d& p, Matrix23d* J) {
  Vector2d pixel;
  if (!project_double_sphere(q, p, &pixel)) return std::nullopt;
  if (J) {
    const double d1 = p.norm();
    const double z1 = q[0] * d1 + p.z();
    const double d2 = std::sqrt(p.head<2>().squaredNorm() + z1 * z1);
    const double den = q[1] * d2 + (1.0 - q[1]) * z1;
    const Eigen::RowVector3d d_z1 = q[0] / d1 * p.transpose() + Eigen::RowVector3d::UnitZ();
    const Eigen::RowVector3d d_d2 = (Eigen::RowVector3d(p.x(), p.y(), 0.0) + z1 * d_z1) / d2;
    const Eigen::RowVector3d d_den = q[1] * d_d2 + (1.0 - q[1]) * d_z1;
    Matrix23d M = -p.head<2>() * d_den / (den * den);
    M(0, 0) += 1.0 / den;
    M(1, 1) += 1.0 / den;
    *J = Vector2d(q[2], q[3]).asDiagonal() * M;
  }
  return pixel;
}

std::optional<Vector3d> kannala_brandt_bearing(const double* q,
                                               const Vector2d& pixel,
                                               double max_angle) {
  const Vector2d m((pixel.x() - q[2]) / q[0], (pixel.y() - q[3]) / q[1]);
  const double radius = m.norm();
  if (radius < 1e-14) return Vector3d::UnitZ();
  const auto theta = kannala_brandt_angle(q + 4, radius, max_angle);
  if (!theta) return std::nullopt;
  const double s = std::sin(*theta) / radius;
  return Vector3d(s * m.x(), s * m.y(), std::cos(*theta));
}

std::optional<Vector3d> pinhole_bearing(const double* q, const Vector2d& pixel) {
  const auto m = undistort_radtan(q + 4, {(pixel.x() - q[2]) / q[0], (pixel.y() - q[3]) / q[1]});
  if (!m) return std::nullopt;
  return Vector3d(m->x(), m->y(), 1.0).normalized();
}

std::optional<Vector3d> omni_bearing(const double* q, const Vector2d& pixel) {
  const auto m = undistort_radtan(q + 5, {(pixel.x() - q[3]) / q[1], (pixel.y() - q[4]) / q[2]});
  if (!m) return std::nullopt;
  const double r2 = m->squaredNorm();
  const double root = 1.0 + (1.0 - q[0] * q[0]) * r2;
  if (!(root >= 0.0)) return std::nullopt;
  const double lambda = (q[0] + std::sqrt(root)) / (1.0 + r2);
  return Vector3d(lambda * m->x(), lambda * m->y(), lambda - q[0]).normalized();
}

std::optional<Vector3d> double_sphere_bearing(const double* q, const Vector2d& pixel) {
  const double xi = q[0];
  const double alpha = q[1];
  const Vector2d m((pixel.x() - q[4]) / q[2], (pixel.y() - q[5]) / q[3]);
  const double r2 = m.squaredNorm();
  const double inner = 1.0 - (2.0 * alpha - 1.0) * r2;
  if (!(inner >= 0.0)) return std::nullopt;
  const double mz = (1.0 - alpha * alpha * r2) / (alpha * std::sqrt(inner) + 1.0 - alpha);
  const double root = mz * mz + (1.0 - xi * xi) * r2;
  if (!(root >= 0.0)) return std::nullopt;
  const double k = (mz * xi + std::sqrt(root)) / (mz * mz + r2);
  return Vector3d(k * m.x(), k * m.y(), k * mz - xi).normalized();
}

}  // namespace

bool radtan_grows(const double* k, double r2) {
  // d(distorted radius)/d(radius) = 1 + 3 k1 t + 5 k2 t^2 with t = r^2.
  const double c1 = 3.0 * k[0];
  const double c2 = 5.0 * k[1];
  if (!(1.0 + r2 * (c1 + r2 * c2) > 0.0)) return false;
  const bool dips_before = c1 < 0.0 && c2 > 0.0 && -c1 < 2.0 * c2 * r2;
  return !dips_before || c1 * c1 < 4.0 * c2;
}

std::optional<Vector2d> Camera::project(const Vector3d& p_camera) const {
  return project(p_camera, nullptr);
}

std::optional<Vector2d> Camera::project(const Vector3d& p_camera,
                                        Matrix23d* d_pixel_d_point) const {
  if (max_angle_rad < 3.1415) {
    const double rho = p_camera.head<2>().norm();
    if (!(std::atan2(rho, p_camera.z()) <= max_angle_rad)) return std::nullopt;
  }
  switch (model) {
    case CameraModel::kPinholeRadtan:
      return pinhole(parameters.data(), p_camera, d_pixel_d_point);
    case CameraModel::kKannalaBrandt:
      return kannala_brandt(parameters.data(), p_camera, d_pixel_d_point);
    case CameraModel::kOmni:
      return omni(parameters.data(), p_camera, d_pixel_d_point);
    case CameraModel::kDoubleSphere:
      return double_sphere(parameters.data(), p_camera, d_pixel_d_point);
  }
  return std::nullopt;
}

std::optional<Vector3d> Camera::bearing(const Vector2d& pixel) const {
  std::optional<Vector3d> ray;
  switch (model) {
    case CameraModel::kPinholeRadtan:
      ray = pinhole_bearing(parameters.data(), pixel);
      break;
    case CameraModel::kKannalaBrandt:
      ray = kannala_brandt_bearing(parameters.data(), pixel, max_angle_rad);
      break;
    case CameraModel::kOmni:
      ray = omni_bearing(parameters.data(), pixel);
      break;
    case CameraModel::kDoubleSphere:
      ray = double_sphere_bearing(parameters.data(), pixel);
      break;
  }
  if (ray && max_angle_rad < 3.1415 && std::atan2(ray->head<2>().norm(), ray->z()) > max_angle_rad)
    return std::nullopt;
  return ray;
}

bool Camera::contains(const Vector2d& pixel, double margin_px) const {
  return pixel.x() >= margin_px && pixel.y() >= margin_px && pixel.x() <= width - 1 - margin_px &&
         pixel.y() <= height - 1 - margin_px;
}

Camera Camera::scaled(double factor) const {
  Camera result = *this;
  const std::size_t first = model == CameraModel::kOmni           ? 1
                            : model == CameraModel::kDoubleSphere ? 2
                                                                  : 0;
  for (std::size_t i = first; i < first + 2; ++i) result.parameters[i] *= factor;
  // The centre of the first pixel is (0, 0): its corner, at -0.5, is what stays in place.
  for (std::size_t i = first + 2; i < first + 4; ++i)
    result.parameters[i] = factor * (result.parameters[i] + 0.5) - 0.5;
  result.width = static_cast<int>(std::lround(width * factor));
  result.height = static_cast<int>(std::lround(height * factor));
  return result;
}

double Camera::focal_px() const {
  const std::size_t first = model == CameraModel::kOmni           ? 1
                            : model == CameraModel::kDoubleSphere ? 2
                                                                  : 0;
  const double mean = 0.5 * (parameters[first] + parameters[first + 1]);
  // Omni and double sphere shrink the axis by their mirror: d pixel / d angle there.
  if (model == CameraModel::kOmni) return mean / (1.0 + parameters[0]);
  if (model == CameraModel::kDoubleSphere) return mean / (1.0 + parameters[0]);
  return mean;
}

}  // namespace roadbook
