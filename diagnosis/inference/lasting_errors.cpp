#include "diagnosis/inference/lasting_errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/median.hpp"
#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/numerics/block_scatter.hpp"

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
    std::stable_sort(rows.begin(), rows.end(),
                     [&](std::size_t a, std::size_t b) { return in.of[a].t_s < in.of[b].t_s; });
    series.push_back(std::move(rows));
  }
  return series;
}

// Errors of two parts: a share of their variance lasts (first-order Gauss-Markov), the rest is
// white.
struct Lasting {
  double keep = 0.0;    // of the lasting part, from row to row
  double repaid = 0.0;  // of the last row's own error: what its white part had taken away
};

double squares_of(const std::vector<double>& e) {
  return std::max(std::inner_product(e.begin(), e.end(), e.begin(), 0.0), 1e-300);
}

// No value where neighbours do not correlate significantly.
std::optional<Lasting> lasting_part(const std::vector<double>& e) {
  constexpr double kSignificant = 5.0;
  constexpr double kLongest = 0.999;
  if (e.size() < 50) return std::nullopt;
  const double squares = squares_of(e);
  const auto autocorrelation = [&](std::size_t lag) {
    const auto shift = static_cast<std::ptrdiff_t>(lag);
    return std::inner_product(e.begin(), e.end() - shift, e.begin() + shift, 0.0) / squares;
  };
  const double first = autocorrelation(1);
  if (first * std::sqrt(static_cast<double>(e.size())) <= kSignificant) return std::nullopt;
  // Autocorrelations are share * keep^lag: from the first to where they have fallen to a half, in
  // steps that grow, so that the cost stays near linear.
  std::size_t lag = 2;
  double last = autocorrelation(lag);
  for (std::size_t next = 3; last > 0.5 * first && 10 * next < e.size(); next += 1 + next / 16) {
    lag = next;
    last = autocorrelation(lag);
  }
  const double fallen = std::max(last, 0.0) / first;
  const double keep = std::clamp(std::pow(fallen, 1.0 / static_cast<double>(lag - 1)),
                                 std::min(first, kLongest), kLongest);
  // Differences e - keep * e_before are a moving average of one step (ARMA(1, 1)).
  const double share = std::min(first / keep, 1.0);
  const double square = share * (1.0 - keep * keep) + (1.0 - share) * (1.0 + keep * keep);
  const double ratio = (1.0 - share) * keep / square;  // repaid / (1 + repaid^2)
  const double repaid =
      ratio > 1e-9 ? (1.0 - std::sqrt(std::max(1.0 - 4.0 * ratio * ratio, 0.0))) / (2.0 * ratio)
                   : 0.0;
  return Lasting{keep, std::min(repaid, kLongest)};
}

}  // namespace

std::optional<Innovations> without_autocorrelation(const Projection& projection,
                                                   const std::vector<std::size_t>& channels) {
  constexpr double kGap = 10.0;  // usual intervals
  const Innovations& in = projection.innovations;
  const auto n = static_cast<Eigen::Index>(projection.accepted);
  const Fit fit = fit_of(in, n);
  std::optional<Innovations> white;
  for (const std::vector<std::size_t>& rows : series_of(in, channels)) {
    std::vector<double> e, steps;
    for (const std::size_t i : rows) e.push_back(in.row(i)[0] - columns_of(in, i, n).dot(fit.step));
    for (std::size_t k = 1; k < rows.size(); ++k)
      steps.push_back(in.of[rows[k]].t_s - in.of[rows[k - 1]].t_s);
    const auto part = lasting_part(e);
    if (!part) continue;
    if (!white) white = in;
    const double usual = std::max(median(steps), 1e-9);
    // Behind a gap the recursion begins again, with whole errors.
    const auto begins = [&](std::size_t k) { return k == 0 || steps[k - 1] > kGap * usual; };
    const auto row = [&](std::size_t k) { return white->values.data() + rows[k] * in.sides; };
    double squares = 0.0, own = 0.0;
    std::size_t predicted = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (begins(k)) {
        own = e[k];
        continue;
      }
      const double keep = std::pow(part->keep, std::max(steps[k - 1] / usual, 0.0));
      own = e[k] - keep * e[k - 1] + part->repaid * own;
      squares += own * own;
      ++predicted;
      const double* now = in.row(rows[k]);
      const double* before = in.row(rows[k - 1]);
      for (std::size_t s = 0; s < in.sides; ++s)
        row(k)[s] = now[s] - keep * before[s] + part->repaid * row(k - 1)[s];
    }
    // What is left has the scatter 1 again.
    const double scale =
        std::sqrt(squares / static_cast<double>(std::max<std::size_t>(predicted, 1)));
    const double whole = std::sqrt(squares_of(e) / static_cast<double>(e.size()));
    for (std::size_t k = 0; k < rows.size(); ++k)
      for (std::size_t s = 0; s < in.sides; ++s)
        row(k)[s] /= std::max(begins(k) ? whole : scale, 1e-300);
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
