#include "speedmap/property_map/gaussian_process.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "base/error.hpp"

namespace roadbook {
namespace {

double scaled_square(const PathPlace& a, const PathPlace& b, const GaussianProcessKernel& kernel) {
  const double x = (a.s_m - b.s_m) / kernel.length_s_m;
  const double y = (a.e_m - b.e_m) / kernel.length_e_m;
  return x * x + y * y;
}

GaussianProcessKernel kernel_of(const Eigen::Vector4d& logs) {
  // Bounds keep the covariance well conditioned, whatever the line search tries.
  const auto bounded = [](double x, double low, double high) {
    return std::exp(std::clamp(x, std::log(low), std::log(high)));
  };
  return {bounded(logs[0], 0.1, 1e4), bounded(logs[1], 0.1, 1e4), bounded(logs[2], 1e-3, 1e2),
          bounded(logs[3], 1e-3, 1e1)};
}

}  // namespace

GaussianProcess::GaussianProcess(const std::vector<PathPlace>& places,
                                 const std::vector<double>& values,
                                 const GaussianProcessKernel& kernel)
    : places_(places), kernel_(kernel) {
  if (places.size() != values.size() || places.size() < 3)
    throw InvalidOption("values", std::to_string(values.size()), "3 or more, one for each place");
  const auto n = static_cast<Eigen::Index>(places.size());
  const Eigen::Map<const Eigen::VectorXd> y(values.data(), n);
  mean_ = y.mean();
  covariance_.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i)
      covariance_(i, j) = covariance_(j, i) =
          kernel.sigma * kernel.sigma *
          std::exp(-0.5 * scaled_square(places_[static_cast<std::size_t>(i)],
                                        places_[static_cast<std::size_t>(j)], kernel));
  Eigen::MatrixXd noisy = covariance_;
  noisy.diagonal().array() += kernel.noise * kernel.noise;
  factor_.compute(noisy);
  const Eigen::VectorXd centred = y.array() - mean_;
  weights_ = factor_.solve(centred);
  log_likelihood_ = -0.5 * centred.dot(weights_) -
                    factor_.matrixLLT().diagonal().array().log().sum() -
                    0.5 * static_cast<double>(n) * std::log(2.0 * std::numbers::pi);
}

Eigen::Vector4d GaussianProcess::gradient() const {
  const Eigen::Index n = covariance_.rows();
  const Eigen::MatrixXd inverse = factor_.solve(Eigen::MatrixXd::Identity(n, n));
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double w = weights_[i] * weights_[j] - inverse(i, j);
      const PathPlace& a = places_[static_cast<std::size_t>(i)];
      const PathPlace& b = places_[static_cast<std::size_t>(j)];
      const double x = (a.s_m - b.s_m) / kernel_.length_s_m;
      const double z = (a.e_m - b.e_m) / kernel_.length_e_m;
      gradient[0] += 0.5 * w * covariance_(i, j) * x * x;
      gradient[1] += 0.5 * w * covariance_(i, j) * z * z;
      gradient[2] += w * covariance_(i, j);
      if (i == j) gradient[3] += w * kernel_.noise * kernel_.noise;
    }
  return gradient;
}

GaussianProcess GaussianProcess::fit(const std::vector<PathPlace>& places,
                                     const std::vector<double>& values,
                                     const GaussianProcessOptions& options) {
  std::optional<GaussianProcess> best;
  for (int start = 0; start < std::max(1, options.starts); ++start) {
    const double longer = std::pow(4.0, start);
    Eigen::Vector4d x(std::log(5.0 * longer), std::log(1.5 * longer), std::log(0.2),
                      std::log(0.05));
    GaussianProcess now(places, values, kernel_of(x));
    Eigen::Vector4d g = now.gradient();
    Eigen::Matrix4d H = 0.02 * Eigen::Matrix4d::Identity();  // of -log likelihood, inverse
    for (int i = 0; i < options.iterations; ++i) {
      Eigen::Vector4d step = H * g;
      if (step.norm() > 1.0) step.normalize();  // a factor of e at most
      if (!(step.dot(g) > 0.0)) break;
      double length = 1.0;
      std::optional<GaussianProcess> next;
      for (; length > 1e-4; length *= 0.5) {
        next.emplace(places, values, kernel_of(x + length * step));
        if (next->log_likelihood() > now.log_likelihood() + 1e-4 * length * step.dot(g)) break;
        next.reset();
      }
      if (!next) break;
      const double gain = next->log_likelihood() - now.log_likelihood();
      const Eigen::Vector4d moved = length * step;
      const Eigen::Vector4d g_next = next->gradient();
      const Eigen::Vector4d change = g - g_next;
      const double curvature = moved.dot(change);
      if (curvature > 1e-12) {
        const Eigen::Matrix4d P =
            Eigen::Matrix4d::Identity() - moved * change.transpose() / curvature;
        H = P * H * P.transpose() + moved * moved.transpose() / curvature;
      }
      x += moved;
      g = g_next;
      now = std::move(*next);
      if (gain < 1e-4) break;
    }
    if (!best || now.log_likelihood() > best->log_likelihood()) best = std::move(now);
  }
  return *best;
}

GaussianProcess::Prediction GaussianProcess::predict(const PathPlace& v) const {
  Eigen::VectorXd k(static_cast<Eigen::Index>(places_.size()));
  for (Eigen::Index i = 0; i < k.size(); ++i)
    k[i] = kernel_.sigma * kernel_.sigma *
           std::exp(-0.5 * scaled_square(places_[static_cast<std::size_t>(i)], v, kernel_));
  const Eigen::VectorXd solved = factor_.matrixL().solve(k);
  return {mean_ + k.dot(weights_),
          kernel_.sigma * kernel_.sigma + kernel_.noise * kernel_.noise - solved.squaredNorm()};
}

KalmanEstimate kalman_constant(const std::vector<double>& values,
                               double measurement_sigma,
                               double walk) {
  KalmanEstimate x{0.0, 1e6};
  for (const double y : values) {
    x.variance += walk * walk;
    const double gain = x.variance / (x.variance + measurement_sigma * measurement_sigma);
    x.mean += gain * (y - x.mean);
    x.variance *= 1.0 - gain;
  }
  return x;
}

}  // namespace roadbook
