#include "diagnosis/friction/friction_noise.hpp"

#include <algorithm>
#include <cmath>

#include "base/median.hpp"
#include "diagnosis/friction/friction_gram.hpp"
#include "diagnosis/numerics/outlier_mixture.hpp"

namespace roadbook {
namespace {

// Least gain in twice the log likelihood for a part of the noise.
constexpr double kClear = 20.0;

void estimate_outliers(const std::vector<double>& z, FrictionNoise& noise) {
  OutlierMixture m = fit_outliers(z);
  noise.outliers = 0.0;
  noise.scale = m.alone;
  noise.outlier_part.assign(z.size(), 0.0);
  noise.outliers_z = std::sqrt(std::max(0.0, 2.0 * m.gained));
  // A smaller share may be the edge of another surface.
  constexpr double kLeastShare = 0.002;
  if (2.0 * m.gained < kClear || m.share < kLeastShare) return;
  noise.outliers = m.share;
  noise.outliers_sigma = m.share_sigma;
  noise.scale = m.scale;
  noise.outlier_part = std::move(m.part);
}

// Products of neighbours over squares, without outliers.
void estimate_correlation(const std::vector<double>& z,
                          const ReadingNoise& own,
                          FrictionNoise& noise) {
  double products = 0.0;
  double squares = 0.0;
  double pairs = 0.0;
  for (std::size_t i = 1; i < z.size(); ++i) {
    if (!own.goes_on[i] || noise.outlier_part[i] > 0.5 || noise.outlier_part[i - 1] > 0.5) continue;
    products += z[i] * z[i - 1];
    squares += 0.5 * (z[i] * z[i] + z[i - 1] * z[i - 1]);
    pairs += 1.0;
  }
  noise.correlation = 0.0;
  noise.correlation_sigma = 0.0;
  if (pairs < 30.0) return;
  const double rho = std::clamp(products / squares, -0.99, 0.99);
  if (rho * rho * pairs < kClear) return;
  noise.correlation = rho;
  noise.correlation_sigma = std::sqrt((1.0 - rho * rho) / pairs);
}

// The spatial bias: its correlation length from a short list, its size by maximum likelihood.
FrictionGram::Fit estimate_place(const FrictionGram& gram,
                                 PlaceBases& bases,
                                 FrictionNoise& noise) {
  const PlaceCells& cells = bases.cells();
  const FrictionGram::Fit without = gram.fit(Eigen::MatrixXd(cells.centres.size(), 0), 0.0);
  noise.place_sd = noise.place_sigma = 0.0;
  noise.place_terms.resize(0, 0);
  noise.place_z = 0.0;
  FrictionGram::Fit best = without;
  if (cells.centres.size() < 5) return best;
  for (const double length : {2.0, 4.0, 8.0, 16.0}) {
    const Eigen::MatrixXd& basis = bases.of_length(length * cells.size_m);
    const FrictionGram::Basis products(gram, basis);
    const auto at = [&](double log_size) { return products.fit(std::exp(log_size)); };
    double low = std::log(5e-4);
    double high = std::log(1.0);
    for (int i = 0; i < 24; ++i) {  // golden section
      constexpr double kGolden = 0.381966;
      const double a = low + kGolden * (high - low);
      const double b = high - kGolden * (high - low);
      if (at(a).log_likelihood > at(b).log_likelihood)
        high = b;
      else
        low = a;
    }
    const double peak = 0.5 * (low + high);
    const FrictionGram::Fit fit = at(peak);
    if (fit.log_likelihood <= best.log_likelihood) continue;
    best = fit;
    noise.place_sd = std::exp(peak);
    noise.place_length_m = length * cells.size_m;
    noise.place_terms = basis;
  }
  const double gained = best.log_likelihood - without.log_likelihood;
  noise.place_z = std::sqrt(std::max(0.0, 2.0 * gained));
  if (2.0 * gained >= kClear) return best;
  noise.place_sd = noise.place_sigma = 0.0;
  noise.place_terms.resize(0, 0);
  return without;
}

// The realised standard deviation of the bias over the readings; that of the process depends on the
// assumed correlation length. Its standard error follows from the number of independent places:
// trace(C)^2 / trace(C^2) of the covariance C.
void measure_places(const PlaceCells& cells, const Eigen::VectorXd& bias, FrictionNoise& noise) {
  if (noise.place_sd == 0.0) return;
  const auto n = static_cast<double>(cells.of.size());
  double sum = 0.0, squares = 0.0;
  for (const std::size_t c : cells.of) {
    const double b = bias[static_cast<Eigen::Index>(c)];
    sum += b / n;
    squares += b * b / n;
  }
  noise.place_sd = std::sqrt(std::max(squares - sum * sum, 0.0));
  const Eigen::VectorXd power = noise.place_terms.colwise().squaredNorm();
  const double places = power.sum() * power.sum() / power.squaredNorm();
  noise.place_sigma = noise.place_sd / std::sqrt(2.0 * places);
}

}  // namespace

FrictionNoise friction_noise(const std::vector<FrictionSample>& samples,
                             PlaceBases& bases,
                             const FrictionMean& mean,
                             Eigen::Index flat,
                             bool places) {
  const PlaceCells& cells = bases.cells();
  FrictionNoise noise;
  noise.outlier_part.assign(samples.size(), 0.0);
  for (int iteration = 0; iteration < 4; ++iteration) {
    const FrictionGram gram(samples, cells, mean, flat, noise);
    FrictionGram::Fit fit;
    if (places && iteration > 0) {
      fit = estimate_place(gram, bases, noise);
    } else {
      fit = gram.fit(Eigen::MatrixXd(cells.centres.size(), 0), 0.0);
    }
    noise.log_likelihood = fit.log_likelihood;
    noise.mean = fit.mean;
    const Eigen::VectorXd bias =
        noise.place_sd > 0.0
            ? Eigen::VectorXd(noise.place_terms * fit.place)
            : Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells.centres.size()));
    std::vector<double> z(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i)
      z[i] = (samples[i].friction - mean.row(static_cast<Eigen::Index>(i)).dot(fit.mean) -
              bias[static_cast<Eigen::Index>(cells.of[i])]) /
             samples[i].sigma;
    const bool last = iteration == 3;
    if (last) {
      noise.place_terms *= noise.place_sd * fit.scale;
      measure_places(cells, bias, noise);
      noise.scale *= fit.scale;
      break;
    }
    estimate_outliers(z, noise);
    estimate_correlation(z, reading_noise(samples, noise), noise);
  }
  return noise;
}

}  // namespace roadbook
