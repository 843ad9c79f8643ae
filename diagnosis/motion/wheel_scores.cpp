#include "diagnosis/motion/wheel_scores.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace roadbook {
namespace {

// Student's score with five degrees of freedom in place of the square of a row over its variance:
// a few outliers move it little. Means of it and of its slope under normal noise, by quadrature.
constexpr double kFreedom = 5.0;
constexpr double kMeanScore = 0.80764;
constexpr double kMeanSlope = 0.57707;
double score_of(double square) {
  return (kFreedom + 1.0) * square / (kFreedom + square) / kMeanScore;
}
constexpr double kSlope = kMeanSlope / kMeanScore;

using Rows = Eigen::Vector<double, kWheelRows>;
using Covariance = Eigen::Matrix<double, kWheelRows, kWheelRows>;

WheelParameter walk_of(const WheelWindow& w) { return w.along ? kAlongWalk : kHeadingWalk; }

// Change of half a log determinant or square, whose part `walk` is of the way.
WheelParameters change_of(const WheelWindow& w, double all, double walk) {
  WheelParameters change = WheelParameters::Zero();
  change[walk_of(w)] = walk;
  change.segment<3>(kReadingNoise) << all - walk, all * w.speed, all * w.turn;
  return change;
}

// A window's own derivatives, added to the sum and to the information; Student's.
WheelParameters add_normal(const WheelWindow& w, const WheelParameters& p, WheelScores& s) {
  WheelParameters own = WheelParameters::Zero();
  for (std::size_t i = 0; i < kWheelRows; ++i) {
    const RowVariance v = row_variance(w, i, p);
    const WheelParameters share = change_of(w, 1.0, 1.0 - v.part_of_readings());
    own += 0.5 * (score_of(w.square(i) / v.total()) - 1.0) * share;
    s.information += 0.5 * kSlope * share * share.transpose();
  }
  s.sum += own;
  return own;
}

// One pattern of outliers in a window: their number, and their contribution to the rows'
// covariance.
struct Pattern {
  std::size_t count = 0;
  Covariance added = Covariance::Zero();
};

// None; each reading; two; three or more as in the mean of all places.
std::vector<Pattern> patterns() {
  const WheelContrasts& contrasts = wheel_contrasts();
  std::vector<Pattern> all{{}};
  for (Eigen::Index i = 0; i < contrasts.cols(); ++i) {
    const Covariance one = contrasts.col(i) * contrasts.col(i).transpose();
    all.push_back({1, one});
    for (Eigen::Index j = 0; j < i; ++j)
      all.push_back({2, one + contrasts.col(j) * contrasts.col(j).transpose()});
  }
  all.push_back({3, 3.0 / static_cast<double>(kWheelWindow) * Covariance::Identity()});
  return all;
}

// Of no, one, two and more outliers among `readings`: their probabilities, over the patterns of
// each, and how many they are in the mean.
struct Chances {
  std::array<double, 4> of{};
  std::array<double, 4> count{0.0, 1.0, 2.0, 3.0};
  double mean = 0.0;

  Chances(double readings, double odds) {
    const double share = odds / (1.0 + odds);
    mean = readings * share;
    double next = std::pow(1.0 - share, readings), left = 1.0, more = mean;
    for (std::size_t k = 0; k < 3; ++k) {
      of[k] = next;
      left -= next;
      more -= count[k] * next;
      next *= (readings - count[k]) / (count[k] + 1.0) * odds;
    }
    of[3] = std::max(left, 1e-12);
    count[3] = std::max(more / of[3], 3.0);
    constexpr auto kPlaces = static_cast<double>(kWheelWindow);
    of[1] /= kPlaces;
    of[2] /= 0.5 * kPlaces * (kPlaces - 1.0);
  }
};

// Log density of a window's rows under one pattern, and its derivatives.
struct Weighed {
  double logarithm = 0.0;
  WheelParameters score;
};

// A window's rows without outliers.
struct SoundRows {
  Rows z, walk;
  double read = 0.0;  ///< variance of a row by its readings
};

SoundRows sound_rows(const WheelWindow& w, const WheelParameters& p) {
  SoundRows rows;
  for (std::size_t i = 0; i < kWheelRows; ++i) {
    const RowVariance v = row_variance(w, i, p);
    rows.z[static_cast<Eigen::Index>(i)] = w.rows[i];
    rows.walk[static_cast<Eigen::Index>(i)] = v.walk;
    rows.read = v.read;
  }
  return rows;
}

Weighed weighed(const WheelWindow& w, const SoundRows& rows, const Pattern& pattern) {
  constexpr double kMore = 99.0;  // variances of a reading that an outlier adds
  const double one = kMore * static_cast<double>(kWheelWindow) / w.readings;
  Covariance all = rows.read * one * pattern.added;
  all.diagonal().array() += rows.walk.array() + rows.read;
  const Covariance inverse = all.inverse();
  const Rows solved = inverse * rows.z;
  const double square = rows.z.dot(solved);
  const double of_walk = rows.walk.dot((solved.cwiseAbs2() - inverse.diagonal()).eval());
  return {-0.5 * (std::log(all.determinant()) + square),
          change_of(w, 0.5 * (square - static_cast<double>(kWheelRows)), 0.5 * of_walk)};
}

// As `add_normal`, for a mixture; its information is the square of its own score.
WheelParameters add_mixed(const WheelWindow& w,
                          const WheelParameters& p,
                          const std::vector<Pattern>& patterns,
                          const Chances& chances,
                          WheelScores& s) {
  const SoundRows rows = sound_rows(w, p);
  double highest = -1e300, sum = 0.0;
  WheelParameters own = WheelParameters::Zero();
  for (const Pattern& pattern : patterns) {
    Weighed one = weighed(w, rows, pattern);
    one.score[kOutlierOdds] = chances.count[pattern.count] - chances.mean;
    const double logarithm = one.logarithm + std::log(chances.of[pattern.count]);
    const double scale = std::exp(std::min(highest - logarithm, 0.0));
    highest = std::max(highest, logarithm);
    const double weight = std::exp(logarithm - highest);
    sum = sum * scale + weight;
    own = own * scale + weight * one.score;
  }
  own /= sum;
  s.sum += own;
  s.information += own * own.transpose();
  return own;
}

}  // namespace

RowVariance row_variance(const WheelWindow& w, std::size_t row, const WheelParameters& p) {
  const double grown = p[kBySpeed] * w.speed + p[kByTurn] * w.turn;
  return {w.read * std::exp(p[kReadingNoise] + grown),
          w.walk[row] * std::exp(p[walk_of(w)] + grown)};
}

WheelScores wheel_scores(const std::vector<WheelWindow>& windows, const WheelParameters& p) {
  const bool mixed = p[kOutlierOdds] > kNoOutliers;
  const std::vector<Pattern> all = mixed ? patterns() : std::vector<Pattern>{};
  const double odds = std::exp(p[kOutlierOdds]);
  WheelScores s;
  for (std::size_t i = 0; i < windows.size();) {
    // Distance and heading of the same readings have the same outliers.
    WheelParameters own = WheelParameters::Zero();
    do {
      const WheelWindow& w = windows[i];
      own += mixed ? add_mixed(w, p, all, Chances(w.readings, odds), s) : add_normal(w, p, s);
    } while (++i < windows.size() && windows[i].along);
    s.scatter += own * own.transpose();
  }
  return s;
}

WheelParameters fitted_wheels(const std::vector<WheelWindow>& windows,
                              WheelParameters p,
                              const FreeParameters& free) {
  constexpr int kMostScorings = 30;
  constexpr double kWidestStep = 1.0;
  for (int i = 0; i < kMostScorings; ++i) {
    const WheelScores s = wheel_scores(windows, p);
    Eigen::MatrixXd information = s.information(free, free);
    information.diagonal().array() += 1e-3;
    const Eigen::VectorXd step =
        information.ldlt().solve(s.sum(free)).cwiseMax(-kWidestStep).cwiseMin(kWidestStep);
    p(free) += step;
    if (step.cwiseAbs().maxCoeff() < 1e-4) break;
  }
  return p;
}

}  // namespace roadbook
