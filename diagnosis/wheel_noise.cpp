#include "diagnosis/wheel_noise.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "diagnosis/noise_looks.hpp"
#include "diagnosis/wheel_windows.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kFewest = 50;  // windows
// What scatters by less was computed, not read: no encoder resolves it, and how it rounds is no
// noise.
constexpr double kFinest = 1e-6;  // [rad]

// Student's score with five degrees of freedom in place of the square of a row over its variance:
// a few outliers move it little. Means of it and of its slope under normal noise, by quadrature.
constexpr double kFreedom = 5.0;
constexpr double kMeanScore = 0.80764;
constexpr double kMeanSlope = 0.57707;
double score_of(double square) {
  return (kFreedom + 1.0) * square / (kFreedom + square) / kMeanScore;
}
constexpr double kSlope = kMeanSlope / kMeanScore;

// Logarithms of the variances of heading after a metre and of a reading, and the change of the
// latter with a covariate.
using Parameters = Eigen::Vector3d;
using Covariate = double WheelWindow::*;

double read_variance(const WheelWindow& w, const Parameters& p, Covariate covariate) {
  return w.read * std::exp(p[1] + p[2] * w.*covariate);
}

struct Scores {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< of the windows' own scores
};

Scores scores_at(const std::vector<WheelWindow>& windows,
                 const Parameters& p,
                 Covariate covariate) {
  Scores s;
  for (const WheelWindow& w : windows) {
    const double read = read_variance(w, p, covariate);
    Eigen::Vector3d own = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kWheelRows; ++i) {
      const double walk = w.walk[i] * std::exp(p[0]);
      const double variance = walk + read;
      const Eigen::Vector3d share{walk / variance, read / variance, w.*covariate * read / variance};
      own += 0.5 * (score_of(w.squares[i] / variance) - 1.0) * share;
      s.information += 0.5 * kSlope * share * share.transpose();
    }
    s.sum += own;
    s.scatter += own * own.transpose();
  }
  return s;
}

// Fisher scoring of the first `free` parameters; what the windows do not tell stays near its start.
Parameters fitted(const std::vector<WheelWindow>& windows,
                  Parameters p,
                  Eigen::Index free,
                  Covariate covariate) {
  constexpr int kMost = 30;
  constexpr double kStep = 1.0;
  for (int i = 0; i < kMost; ++i) {
    const Scores s = scores_at(windows, p, covariate);
    Eigen::MatrixXd information = s.information.topLeftCorner(free, free);
    information.diagonal().array() += 1e-3;
    const Eigen::VectorXd step =
        information.ldlt().solve(s.sum.head(free)).cwiseMax(-kStep).cwiseMin(kStep);
    p.head(free) += step;
    if (step.cwiseAbs().maxCoeff() < 1e-4) break;
  }
  return p;
}

// Score test beside the two variances, by the scatter that the windows' scores really have; size
// and its error of the fit with all three.
NoiseCause reading_variance_by(const char* name,
                               const char* unit,
                               const std::vector<WheelWindow>& windows,
                               const Parameters& null,
                               Covariate covariate) {
  const std::string effect = std::string("wheels0.variance(") + name + ")";
  const Scores at = scores_at(windows, null, covariate);
  const Eigen::Vector2d beside =
      at.information.topLeftCorner<2, 2>().ldlt().solve(at.information.topRightCorner<2, 1>());
  const Eigen::Vector3d direction{-beside[0], -beside[1], 1.0};
  const double scatter = direction.dot(at.scatter * direction);
  const double told = direction.dot(at.information * direction);
  if (!(told > 1e-2 * at.information(2, 2)) || !(scatter > 0.0))
    return noise_cause(effect, unit, 0.0, 0.0, 0.0);
  const double z = direction.dot(at.sum) / std::sqrt(scatter);
  const Parameters p = fitted(windows, null, 3, covariate);
  const Scores end = scores_at(windows, p, covariate);
  const Eigen::Matrix3d inverse = end.information.ldlt().solve(Eigen::Matrix3d::Identity());
  const double sigma = std::sqrt((inverse * end.scatter * inverse)(2, 2));
  return noise_cause(effect, unit, p[2], sigma, z);
}

std::vector<ScatterLook> looks_of(const std::vector<WheelWindow>& windows,
                                  const Parameters& p,
                                  Covariate covariate) {
  std::vector<ScatterLook> looks;
  for (const WheelWindow& w : windows) {
    ScatterLook look{0.0, static_cast<double>(kWheelRows), w.speed, w.turn};
    const double read = read_variance(w, p, covariate);
    for (std::size_t i = 0; i < kWheelRows; ++i)
      look.square += w.squares[i] / (w.walk[i] * std::exp(p[0]) + read) / look.freedom;
    looks.push_back(look);
  }
  return looks;
}

// Where the variance surely changes with something, readings lie far off only beside that.
std::vector<ScatterLook> looks_beside(const std::vector<WheelWindow>& windows,
                                      const Parameters& null,
                                      const NoiseCause& by_speed,
                                      const NoiseCause& by_turn) {
  constexpr double kSure = 5.0;  // [sigma]
  const double speed = std::abs(by_speed.z);
  const double turn = std::abs(by_turn.z);
  const Covariate covariate = speed > turn ? &WheelWindow::speed : &WheelWindow::turn;
  if (std::max(speed, turn) < kSure) return looks_of(windows, null, covariate);
  return looks_of(windows, fitted(windows, null, 3, covariate), covariate);
}

// Of one wheel while it stands, of both while they roll.
double readings_a_window(const std::vector<WheelWindow>& windows) {
  double readings = 0.0;
  for (const WheelWindow& w : windows) readings += w.readings / static_cast<double>(windows.size());
  return readings;
}

}  // namespace

void look_into_wheels(const Observations& obs,
                      const MotionModel& model,
                      std::vector<NoiseCause>& all) {
  const auto [windows, tick_rad] = wheel_windows(obs, model);
  if (windows.size() < kFewest) return;
  const Parameters start{2.0 * std::log(model.noise.heading_per_sqrt_m),
                         2.0 * std::log(model.noise.wheel_angle_rad), 0.0};
  const Parameters null = fitted(windows, start, 2, &WheelWindow::speed);
  if (std::exp(0.5 * null[1]) < kFinest) return;
  // What rounds readings by more than they scatter is no noise and changes with speed like one.
  if (tick_rad > std::exp(0.5 * null[1])) return;
  NoiseCause by_speed = reading_variance_by("speed", "s/m", windows, null, &WheelWindow::speed);
  const NoiseCause by_turn =
      reading_variance_by("turn", "s/rad", windows, null, &WheelWindow::turn);
  all.push_back(outliers("wheels0", looks_beside(windows, null, by_speed, by_turn),
                         readings_a_window(windows)));
  all.push_back(by_turn);
  // Less noise at higher speed is what readings look like whose neighbours correlate: beside the
  // walk of a rolling wheel the two are one, and neither can be said.
  if (by_speed.z < 0.0)
    by_speed = noise_cause(by_speed.effect, by_speed.unit.c_str(), 0.0, 0.0, 0.0);
  all.push_back(by_speed);
}

}  // namespace roadbook
