#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "diagnosis/detector/foot_position_problem.hpp"

namespace roadbook {

// Noise of the detections, standing or walking pedestrians, and the lines of sight.

using Eigen::Index;

// Sets the lines of sight through positions smoothed by the same motion model that projects the
// paths out. Errors of these positions are then uncorrelated with the innovations. Another smoother
// would correlate them, and their always positive product would look like a position bias of 5 mm.
void FootPositionProblem::aim() {
  for (const Person& person : people_) {
    const PersonMotion motion{person.stands ? 1e-3 : kWalking, noise_.memory_s, noise_.shift};
    std::vector<PlacedFeet> seen;
    for (std::size_t i = person.first; i < person.first + person.count; ++i) {
      const Place& p = places_[i];
      Eigen::Matrix2d R;
      R << p.along, Eigen::Vector2d(-p.along.y(), p.along.x());
      const Eigen::Vector2d sigma(noise_.along * p.sigma_along, noise_.across * p.sigma_across);
      seen.push_back({moments_[i].t_s, p.foot, R * sigma.cwiseAbs2().asDiagonal() * R.transpose()});
    }
    const std::vector<Eigen::Vector2d> feet = smoothed_feet(seen, motion);
    for (std::size_t i = 0; i < feet.size(); ++i) {
      Place& p = places_[person.first + i];
      p.along = (feet[i] - p.eye).normalized();
    }
  }
}

// Log likelihood with the catalogued effect and a bias proportional to range free, both with their
// priors.
double FootPositionProblem::log_likelihood(const Noise& noise, Eigen::Vector2d* sizes) const {
  const double tau = detector_effect(kName).tau;
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(static_cast<Index>(rows()), 3);
  sides.col(0) = readings();

  for (std::size_t i = 0; i < places_.size(); ++i) {
    sides(static_cast<Index>(2 * i), 1) = tau;
    sides(static_cast<Index>(2 * i), 2) = 0.1 * moments_[i].range_m;
  }
  double log_determinant = 0.0;
  for (const Person& person : people_) log_determinant += whiten(person, noise, sides, nullptr);
  const Eigen::Matrix3d G = sides.transpose() * sides;
  const Eigen::Matrix2d F = G.bottomRightCorner<2, 2>() + Eigen::Matrix2d::Identity();
  const Eigen::Vector2d u = G.bottomLeftCorner<2, 1>();
  const Eigen::Vector2d step = F.ldlt().solve(u);
  if (sizes != nullptr) *sizes = Eigen::Vector2d(tau, 0.1).cwiseProduct(step);
  return -0.5 * (log_determinant + G(0, 0) - u.dot(step));
}

// Decides by likelihood whether each pedestrian stands or walks, with the estimated bias removed.
void FootPositionProblem::classify_standing(const Eigen::Vector2d& sizes) {
  Eigen::MatrixXd left = readings();
  for (std::size_t i = 0; i < places_.size(); ++i)
    left(static_cast<Index>(2 * i), 0) -= sizes[0] + sizes[1] * moments_[i].range_m;
  for (Person& person : people_) {
    double best = -1e300;
    bool stands = false;
    for (const bool trial : {false, true}) {
      person.stands = trial;
      Eigen::MatrixXd sides = left;
      const double log_determinant = whiten(person, noise_, sides, nullptr);
      const auto n = static_cast<Index>(2 * person.count);
      const double squares =
          sides.middleRows(static_cast<Index>(2 * person.first), n).squaredNorm();
      const double likelihood = -0.5 * (log_determinant + squares);
      if (likelihood <= best) continue;
      best = likelihood;
      stands = trial;
    }
    person.stands = stands;
  }
}

// Variance inflation by pedestrians that turn round or were mixed up: the squared score of each
// pedestrian over its expected value.
double FootPositionProblem::over_dispersion(const Eigen::Vector2d& sizes) const {
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(static_cast<Index>(rows()), 2);
  sides.col(0) = readings();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const auto row = static_cast<Index>(2 * i);
    sides(row, 0) -= sizes[0] + sizes[1] * moments_[i].range_m;
    sides(row, 1) = 1.0;
  }
  double seen = 0.0;
  double expected = 0.0;
  for (const Person& person : people_) {
    (void)whiten(person, noise_, sides, nullptr);
    const Eigen::MatrixXd own = sides.middleRows(static_cast<Index>(2 * person.first),
                                                 static_cast<Index>(2 * person.count));
    seen += std::pow(own.col(0).dot(own.col(1)), 2);
    expected += own.col(1).squaredNorm();
  }
  return std::max(1.0, seen / std::max(expected, 1e-12));
}

void FootPositionProblem::estimate_noise() {
  struct Knob {
    double Noise::*value;
    double low, high;
  };
  constexpr Knob kKnobs[] = {{&Noise::along, 0.2, 5.0},
                             {&Noise::across, 0.2, 5.0},
                             {&Noise::memory_s, 1.0, 60.0},
                             {&Noise::shift, 0.003, 0.3}};
  Eigen::Vector2d sizes;
  double best = log_likelihood(noise_, &sizes);
  for (int round = 0; round < 4; ++round) {
    if (round > 0) {
      classify_standing(sizes);
      best = log_likelihood(noise_, &sizes);
    }
    // Coordinate search with halved steps in the log of each parameter.
    for (double step = std::pow(2.0, -round); step > 0.04; step *= 0.5)
      for (const Knob& knob : kKnobs)
        for (const double factor : {std::exp(step), std::exp(-step)})
          for (;;) {
            Noise trial = noise_;
            trial.*knob.value = std::clamp(trial.*knob.value * factor, knob.low, knob.high);
            Eigen::Vector2d of_trial;
            const double likelihood = log_likelihood(trial, &of_trial);
            if (!(likelihood > best + 1e-6)) break;
            best = likelihood;
            noise_ = trial;
            sizes = of_trial;
          }
  }
  dispersion_ = over_dispersion(sizes);
}

}  // namespace roadbook
