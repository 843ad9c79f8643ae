#include "semantics/exposure.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>

namespace roadbook {
namespace {

constexpr double kHuber = 0.1;
constexpr double kPrior = 1e-3;  // holds gains of images that share little; far below one sample
constexpr int kRounds = 5;
constexpr int kMaxIterations = 200;

struct Row {
  int image = 0;
  int place = 0;
  double log_grey = 0.0;
  double weight = 1.0;
};

struct BalanceProblem {
  std::vector<Row> rows;
  int images = 0;
  int places = 0;

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
  // Gradient by image of half the weighted squares of (of(row) - place mean).
  template <typename Of>
  [[nodiscard]] Eigen::VectorXd image_sums(const Of& of) const {
    const Eigen::VectorXd mean = place_means(of);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(images);
    for (const Row& row : rows) sum[row.image] += row.weight * (of(row) - mean[row.place]);
    return sum;
  }
};

BalanceProblem shared_places(const std::vector<std::vector<ExposureSample>>& samples_by_image) {
  std::unordered_map<std::int64_t, int> seen;
  for (const auto& samples : samples_by_image)
    for (const ExposureSample& s : samples) ++seen[s.place];
  BalanceProblem problem;
  problem.images = static_cast<int>(samples_by_image.size());
  std::unordered_map<std::int64_t, int> number;
  for (std::size_t image = 0; image < samples_by_image.size(); ++image) {
    for (const ExposureSample& s : samples_by_image[image]) {
      if (seen[s.place] < 2) continue;
      const auto [it, is_new] = number.try_emplace(s.place, problem.places);
      if (is_new) ++problem.places;
      problem.rows.push_back({static_cast<int>(image), it->second, s.log_grey, 1.0});
    }
  }
  return problem;
}

// Log gains of the weighted problem by preconditioned conjugate gradients, starting at `g`.
Eigen::VectorXd solve(const BalanceProblem& problem, Eigen::VectorXd g) {
  Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(problem.images, kPrior);
  for (const Row& row : problem.rows) diagonal[row.image] += row.weight;
  const auto apply = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return problem.image_sums([&](const Row& row) { return x[row.image]; }) + kPrior * x;
  };
  Eigen::VectorXd r = -problem.image_sums([](const Row& row) { return row.log_grey; }) - apply(g);
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

std::vector<double> estimate_gains(
    const std::vector<std::vector<ExposureSample>>& samples_by_image) {
  BalanceProblem problem = shared_places(samples_by_image);
  std::vector<double> gains(samples_by_image.size(), 1.0);
  if (problem.rows.empty()) return gains;

  Eigen::VectorXd g = Eigen::VectorXd::Zero(problem.images);
  for (int round = 0; round < kRounds; ++round) {
    g = solve(problem, g);
    const auto balanced = [&](const Row& row) { return row.log_grey + g[row.image]; };
    const Eigen::VectorXd mean = problem.place_means(balanced);
    for (Row& row : problem.rows) {
      const double residual = std::abs(balanced(row) - mean[row.place]);
      row.weight = residual <= kHuber ? 1.0 : kHuber / residual;
    }
  }
  std::vector<bool> shares(samples_by_image.size(), false);
  for (const Row& row : problem.rows) shares[static_cast<std::size_t>(row.image)] = true;
  double mean = 0.0;
  int count = 0;
  for (int i = 0; i < problem.images; ++i) {
    if (!shares[static_cast<std::size_t>(i)]) continue;
    mean += g[i];
    ++count;
  }
  mean /= std::max(1, count);
  for (std::size_t i = 0; i < gains.size(); ++i)
    if (shares[i]) gains[i] = std::exp(g[static_cast<Eigen::Index>(i)] - mean);
  return gains;
}

}  // namespace roadbook
