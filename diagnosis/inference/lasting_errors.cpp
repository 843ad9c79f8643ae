#include "diagnosis/inference/lasting_errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/median.hpp"
#include "diagnosis/numerics/block_scatter.hpp"
#include "diagnosis/inference/score_table.hpp"

namespace roadbook {
namespace {

using Vector = Eigen::VectorXd;

// Sizes of all accepted columns, one Gauss-Newton step on from those of the projection.
struct Fit {
  Vector step;
  Eigen::MatrixXd covariance;
};

Eigen::Map<const Vector> columns_of(const Innovations& in, std::size_t i, Eigen::Index n) {
  return {in.row(i) + 1, n};
}

Fit fit_of(const Innovations& in, Eigen::Index n) {
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);
  Vector u = Vector::Zero(n);
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const auto a = columns_of(in, i, n);
    F += a * a.transpose();
    u += in.row(i)[0] * a;
  }
  F.diagonal() *= 1.0 + 1e-10;
  F.diagonal().array() += 1e-300;
  const Eigen::LDLT<Eigen::MatrixXd> solver(F);
  return {solver.solve(u), solver.solve(Eigen::MatrixXd::Identity(n, n))};
}

// Rows of a channel of one drive, in time.
std::vector<std::vector<std::size_t>> series_of(const Innovations& in,
                                                const std::vector<std::size_t>& channels) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> all;
  for (std::size_t i = 0; i < in.of.size(); ++i)
    if (std::find(channels.begin(), channels.end(), in.of[i].channel) != channels.end())
      all[{in.of[i].drive, in.of[i].channel}].push_back(i);
  std::vector<std::vector<std::size_t>> series;
  for (auto& [key, rows] : all) {
    std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
      return in.of[a].t_s < in.of[b].t_s;
    });
    series.push_back(std::move(rows));
  }
  return series;
}

// Autocorrelation of neighbours; 0 where it is not significant.
double neighbour_correlation(const std::vector<double>& e) {
  constexpr double kSignificant = 5.0;
  if (e.size() < 50) return 0.0;
  const double lagged = std::inner_product(e.begin() + 1, e.end(), e.begin(), 0.0);
  const double squares = std::inner_product(e.begin(), e.end(), e.begin(), 0.0);
  const double r = lagged / std::max(squares, 1e-300);
  return r * std::sqrt(static_cast<double>(e.size())) > kSignificant ? std::min(r, 0.999) : 0.0;
}

}  // namespace

std::optional<Innovations> without_autocorrelation(const Projection& projection,
                                                   const std::vector<std::size_t>& channels) {
  const Innovations& in = projection.innovations;
  const auto n = static_cast<Eigen::Index>(projection.accepted);
  const Fit fit = fit_of(in, n);
  std::optional<Innovations> white;
  for (const std::vector<std::size_t>& rows : series_of(in, channels)) {
    std::vector<double> e, steps;
    for (const std::size_t i : rows)
      e.push_back(in.row(i)[0] - columns_of(in, i, n).dot(fit.step));
    for (std::size_t k = 1; k < rows.size(); ++k)
      steps.push_back(in.of[rows[k]].t_s - in.of[rows[k - 1]].t_s);
    const double r = neighbour_correlation(e);
    if (r == 0.0) continue;
    if (!white) white = in;
    const double usual = std::max(median(steps), 1e-9);
    std::vector<double> keep(rows.size(), 0.0);
    double squares = 0.0;
    for (std::size_t k = 1; k < rows.size(); ++k) {
      keep[k] = std::pow(r, std::max(steps[k - 1] / usual, 0.0));
      squares += std::pow(e[k] - keep[k] * e[k - 1], 2) / (1.0 - keep[k] * keep[k]);
    }
    // What is left has the scatter 1 again.
    const double scale = std::sqrt(squares / static_cast<double>(rows.size() - 1));
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double own = scale * std::sqrt(1.0 - keep[k] * keep[k]);
      const double* now = in.row(rows[k]);
      const double* before = in.row(rows[k > 0 ? k - 1 : 0]);
      double* changed = white->values.data() + rows[k] * in.sides;
      for (std::size_t s = 0; s < in.sides; ++s) changed[s] = (now[s] - keep[k] * before[s]) / own;
    }
  }
  return white;
}

SizeByBlocks size_by_blocks(const CauseModel& model,
                            const Innovations& innovations,
                            std::size_t a) {
  const Vector before = sizes_of(model);
  const Eigen::Index n = before.size();
  const Fit fit = fit_of(innovations, n);
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < a; ++k) first += model.accepted[k].size.size();
  const Eigen::Index count = model.accepted[a].size.size();
  const Vector size = (before + fit.step).segment(first, count);
  const Vector direction = fit.covariance.block(first, first, count, count).ldlt().solve(size);
  const double statistic = size.dot(direction);  // along `direction`, also its own variance
  // The size along the direction moves by `weights` times columns times residual.
  const Vector weights = fit.covariance.middleCols(first, count) * direction;
  std::vector<BlockPart> parts(innovations.of.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto columns = columns_of(innovations, i, n);
    const double moved = columns.dot(weights);
    parts[i] = {innovations.of[i].t_s, moved * (innovations.row(i)[0] - columns.dot(fit.step)),
                moved * moved};
  }
  const auto freedom = static_cast<int>(count);
  const double p = p_by_block_scatter(statistic, std::move(parts), freedom);
  return {std::max(chi_squared_tail(statistic, freedom), p),
          std::sqrt(fit.covariance(first, first) + std::pow(fit.step[first], 2))};
}

}  // namespace roadbook
