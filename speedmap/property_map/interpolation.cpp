#include "speedmap/property_map/interpolation.hpp"

#include <cmath>

#include "speedmap/property_map/kernel.hpp"

namespace roadbook {

void interpolate(const Knots& knots, const PathPlace& v, Interpolation& result) {
  result.knots.clear();
  result.weights.clear();
  knots.for_each_near(v, [&](std::int32_t knot, double, double, double r2) {
    result.knots.push_back(knot);
    result.weights.push_back(r2);
  });
  sparse_kernel_of_squares(result.weights.data(), result.weights.data(), result.weights.size());
  result.kernel_sum = 0.0;
  for (const double k : result.weights) result.kernel_sum += k;
  if (!(result.kernel_sum > 0.0)) {  // none, or all so near the edge that the kernel underflows
    result.knots.clear();
    result.weights.clear();
    return;
  }
  const double scale = 1.0 / result.kernel_sum;
  for (double& weight : result.weights) weight *= scale;
}

void interpolate(const Knots& knots,
                 const PathPlace& v,
                 Interpolation& result,
                 InterpolationDerivatives& derivatives) {
  interpolate(knots, v, result);
  auto& gradients = derivatives.gradients;
  auto& hessians = derivatives.hessians;
  gradients.clear();
  hessians.clear();
  if (!result.covered()) return;
  const Eigen::Vector2d per_width(1.0 / knots.width().s_m, 1.0 / knots.width().e_m);
  const Eigen::Matrix2d square = per_width.cwiseAbs2().asDiagonal();
  Eigen::Vector2d gradient_sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d hessian_sum = Eigen::Matrix2d::Zero();
  knots.for_each_near(v, [&](std::int32_t, double x, double y, double r2) {
    const KernelDerivatives k = sparse_kernel_derivatives(std::sqrt(r2));
    const Eigen::Vector2d direction = per_width.cwiseProduct(Eigen::Vector2d(x, y));
    gradients.emplace_back(k.first_over_r * direction);
    hessians.emplace_back(k.first_over_r * square + k.bend * direction * direction.transpose());
    gradient_sum += gradients.back();
    hessian_sum += hessians.back();
  });
  const double scale = 1.0 / result.kernel_sum;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double I = result.weights[i];
    gradients[i] = scale * (gradients[i] - I * gradient_sum);
    const Eigen::Matrix2d cross = gradients[i] * gradient_sum.transpose();
    hessians[i] = scale * (hessians[i] - I * hessian_sum - cross - cross.transpose());
  }
}

}  // namespace roadbook
