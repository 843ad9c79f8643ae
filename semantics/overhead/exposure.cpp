#include "semantics/overhead/exposure.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>

#include "base/require_option.hpp"

namespace roadbook {
namespace {

constexpr double kHuber = 0.1;
constexpr double kLeastPrior = 1e-3;  // fixes images without a shared place; far below one sample
constexpr int kRounds = 5;
constexpr int kMaxIterations = 200;

struct Row {
  int image = 0;
  int shade = 0;  // index of the unknown; shades come after the gains of the images
  int place = 0;
  double log_grey = 0.0;
  double weight = 1.0;
};

struct BalanceProblem {
  std::vector<Row> rows;
  int images = 0;
  int places = 0;
  // Unknowns: the gains of the images, then the shades of the distances.
  Eigen::VectorXd prior;  // weight of each unknown

  // Weighted mean of `of(row)` at every place.
  template <typename Of>
  [[nodiscard]] Eigen::VectorXd place_means(const Of& of) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(places);
    Eigen::VectorXd weight = Eigen::VectorXd::Constant(places, 1e-12);
    for (const Row& row : rows) {
      sum[row.place] += row.weight * of(row);
      weight[row.place] += row.weight;
    }
    return sum.cwiseQuotient(weight);
  }
  // Gradient, by the unknowns, of half the weighted squares of (of(row) - place mean).
  template <typename Of>
  [[nodiscard]] Eigen::VectorXd sums(const Of& of) const {
    const Eigen::VectorXd mean = place_means(of);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(prior.size());
    for (const Row& row : rows) {
      const double residual = row.weight * (of(row) - mean[row.place]);
      sum[row.image] += residual;
      sum[row.shade] += residual;
    }
    return sum;
  }
};

BalanceProblem shared_places(const std::vector<std::vector<ExposureSample>>& samples_by_image,
                             double prior_share) {
  std::unordered_map<std::int64_t, int> seen;
  for (const auto& samples : samples_by_image)
    for (const ExposureSample& s : samples) ++seen[s.place];
  BalanceProblem problem;
  problem.images = static_cast<int>(samples_by_image.size());
  std::unordered_map<std::int64_t, int> number;
  int unknowns = problem.images;
  for (std::size_t image = 0; image < samples_by_image.size(); ++image) {
    for (const ExposureSample& s : samples_by_image[image]) {
      if (seen[s.place] < 2) continue;
      const auto [it, is_new] = number.try_emplace(s.place, problem.places);
      if (is_new) ++problem.places;
      problem.rows.push_back(
          {static_cast<int>(image), problem.images + s.distance, it->second, s.log_grey, 1.0});
      unknowns = std::max(unknowns, problem.rows.back().shade + 1);
    }
  }
  // Robust weights do not reduce the prior. The gain of an image that disagrees with all others
  // stays near 1.
  problem.prior = Eigen::VectorXd::Constant(unknowns, kLeastPrior);
  for (const Row& row : problem.rows) problem.prior[row.image] += prior_share;
  return problem;
}

// Solves the weighted problem for log gains and shades by preconditioned conjugate gradients,
// starting at `g`.
Eigen::VectorXd solve(const BalanceProblem& problem, Eigen::VectorXd g) {
  Eigen::VectorXd diagonal = problem.prior;
  for (const Row& row : problem.rows) {
    diagonal[row.image] += row.weight;
    diagonal[row.shade] += row.weight;
  }
  const auto apply = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return problem.sums([&](const Row& row) { return x[row.image] + x[row.shade]; }) +
           problem.prior.cwiseProduct(x);
  };
  Eigen::VectorXd r = -problem.sums([](const Row& row) { return row.log_grey; }) - apply(g);
  Eigen::VectorXd z = r.cwiseQuotient(diagonal);
  Eigen::VectorXd p = z;
  double rz = r.dot(z);
  const double enough = 1e-10 * std::max(1.0, static_cast<double>(problem.rows.size()));
  for (int i = 0; i < kMaxIterations && rz > enough; ++i) {
    const Eigen::VectorXd Ap = apply(p);
    const double alpha = rz / p.dot(Ap);
    g += alpha * p;
    r -= alpha * Ap;
    z = r.cwiseQuotient(diagonal);
    const double rz_next = r.dot(z);
    p = z + (rz_next / rz) * p;
    rz = rz_next;
  }
  return g;
}

}  // namespace

void GainOptions::check() const {
  require_option(prior_share > 0.0 && prior_share <= 1.0, "prior_share", prior_share, "0 to 1");
  require_option(std::isfinite(most_gain) && most_gain >= 1.0, "most_gain", most_gain,
                 "at least 1");
}

std::vector<double> estimate_gains(const std::vector<std::vector<ExposureSample>>& samples_by_image,
                                   const GainOptions& options) {
  options.check();
  BalanceProblem problem = shared_places(samples_by_image, options.prior_share);
  std::vector<double> gains(samples_by_image.size(), 1.0);
  if (problem.rows.empty()) return gains;

  Eigen::VectorXd g = Eigen::VectorXd::Zero(problem.prior.size());
  for (int round = 0; round < kRounds; ++round) {
    g = solve(problem, g);
    const auto balanced = [&](const Row& row) {
      return row.log_grey + g[row.image] + g[row.shade];
    };
    const Eigen::VectorXd mean = problem.place_means(balanced);
    for (Row& row : problem.rows) {
      const double residual = std::abs(balanced(row) - mean[row.place]);
      row.weight = residual <= kHuber ? 1.0 : kHuber / residual;
    }
  }
  for (std::size_t i = 0; i < gains.size(); ++i)
    gains[i] = std::clamp(std::exp(g[static_cast<Eigen::Index>(i)]), 1.0 / options.most_gain,
                          options.most_gain);
  return gains;
}

}  // namespace roadbook
