#include "diagnosis/view_saturation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/track_correlation.hpp"

namespace roadbook {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }
Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

constexpr std::size_t kProbes = 4;
constexpr double kMedianOfSquare = 0.4549;  // of a standard normal

Eigen::MatrixXd sums_of(const std::vector<ViewCause>& causes, std::size_t basis) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(index(basis), index(causes.size()));
  for (std::size_t c = 0; c < causes.size(); ++c)
    for (const std::size_t column : causes[c].columns) sums(index(column), index(c)) = 1.0;
  return sums;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Standard deviation of a channel's readings in units of what was assumed: of motions by the
// median, which a bump in the road does not move.
double scale_of(const Saturated& s, std::size_t channel, bool by_median) {
  const auto& squares = s.squares[channel];
  if (squares.empty()) return 1.0;
  const double share = s.redundancy[channel] / static_cast<double>(squares.size());
  if (share < 0.02) return 1.0;  // nothing else knows what these rows read
  if (by_median) return std::sqrt(median(squares) / kMedianOfSquare / share);
  // Mean without what lies beyond the gate, by three rounds.
  double variance = median(squares) / kMedianOfSquare;
  for (int round = 0; round < 3; ++round) {
    double sum = 0.0;
    double count = 0.0;
    for (const double q : squares)
      if (q < kViewGate * kViewGate * variance) {
        sum += q;
        count += 1.0;
      }
    variance = sum / std::max(1.0, count);
  }
  return std::sqrt(variance / share);
}

}  // namespace

Saturated saturate(const ViewSystem& system,
                   const std::vector<ViewCause>& causes,
                   const ViewBasis& basis,
                   const ViewData& data,
                   ViewPoint& point) {
  const ViewChannels channels{basis.cameras};
  const auto n = index(causes.size());
  const ViewSides sides = system.sides(sums_of(causes, basis.size()), kProbes);
  ROADBOOK_ASSERT(sides.count == 1 + n + index(kProbes));
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(1 + n, 1 + n);
  ViewPanel values;
  std::vector<ViewPanel> all(system.poses());
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, all[k]);
    F.noalias() += all[k].leftCols(1 + n).transpose() * all[k].leftCols(1 + n);
  }
  for (Eigen::Index c = 0; c < n; ++c)
    F(1 + c, 1 + c) +=
        1.0 / (causes[at(static_cast<int>(c))].tau * causes[at(static_cast<int>(c))].tau);
  const Eigen::VectorXd size = F.bottomRightCorner(n, n).ldlt().solve(F.col(0).tail(n));
  system.move(point, sides, size);
  for (Eigen::Index c = 0; c < n; ++c)
    point.effects[causes[static_cast<std::size_t>(c)].name] += size[c];
  Saturated s;
  s.squares.resize(channels.size());
  s.redundancy.assign(channels.size(), 0.0);
  s.view_square.assign(data.bundle.observations.size(), 0.0);
  TrackCorrelation tracks(data);
  ViewPanel signs;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, signs, true);
    const Eigen::VectorXd left = all[k].col(0) - all[k].middleCols(1, n) * size;
    const auto& info = system.row_info(k);
    for (std::size_t i = 0; i < info.size(); ++i) {
      const double square = left[index(i)] * left[index(i)];
      s.squares[info[i].channel].push_back(square);
      if (info[i].observation >= 0) {
        s.view_square[at(info[i].observation)] += square;
        const bool second = i > 0 && info[i - 1].observation == info[i].observation;
        tracks.add(at(info[i].observation), second, left[index(i)], all[k](index(i), 1 + n));
      }
      s.redundancy[info[i].channel] +=
          signs.row(index(i)).tail(index(kProbes)).dot(all[k].row(index(i)).tail(index(kProbes))) /
          static_cast<double>(kProbes);
    }
  }
  s.inflation = tracks.inflation();
  return s;
}

void renew_noise(const Saturated& s, const ViewChannels& channels, ViewNoise& noise) {
  const auto scale = [&](std::size_t channel, bool by_median) {
    return std::clamp(scale_of(s, channel, by_median), 0.05, 20.0);
  };
  for (std::size_t c = 0; c < channels.cameras; ++c)
    noise.pixel[c] = std::max(0.01, noise.pixel[c] * scale(c, false));
  for (std::size_t axis = 0; axis < 6; ++axis)
    noise.motion[axis] =
        std::clamp(noise.motion[axis] * scale(channels.motion(axis), true), 0.01, 20.0);
  noise.ground_m = std::max(5e-4, noise.ground_m * scale(channels.ground(), true));
}

}  // namespace roadbook
