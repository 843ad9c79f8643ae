#include "diagnosis/tilt/tilt_problem.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/gravity.hpp"
#include "diagnosis/inference/linear_fit.hpp"
#include "diagnosis/numerics/outlier_mixture.hpp"
#include "diagnosis/numerics/sequential_projection.hpp"
#include "sensors/effects.hpp"
#include "sensors/imu_imperfections.hpp"

namespace roadbook {
namespace {

using Eigen::Index;

constexpr const char* kRoll = "imu0.tilt_roll";
constexpr const char* kPitch = "imu0.tilt_pitch";
constexpr std::size_t kFewestWindows = 50;
constexpr std::size_t kMemory = 8;  // windows: 0.6 s at the usual step
constexpr double kForceCounts = 4.0;
constexpr std::size_t kRollRate = 0, kPitchRate = 1, kForward = 2, kLeft = 3;

// Standard deviations of the unknowns of each channel: bias [rad/s, m/s^2] of a consumer's IMU, and
// attitude of the body by acceleration: 0.6 degrees a m/s^2, which an accelerometer reads as a
// tenth of the acceleration. The latter also covers the scale of the accelerometer. Roads are
// banked by up to 0.1 rad, race tracks by more.
constexpr double kRoadBank = 0.15;  // [rad]
constexpr std::array<std::array<double, 3>, 4> kUnknown{{{0.05, 0.01, kRoadBank},
                                                         {0.05, 0.01, kRoadBank},
                                                         {0.3, 0.3, kRoadBank},
                                                         {0.3, 0.3, kRoadBank}}};

// Sizes of the model's tilt: roll, pitch.
Eigen::Vector2d tilt_of(const CauseModel& model) {
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();
  for (const Accepted& a : model.accepted)
    tilt[shared_name(a.candidate) == kRoll ? 0 : 1] += a.size[0];
  return tilt;
}

// Predicts each window from the windows before, by least squares: noise that lasts.
void set_memory(const std::vector<double>& left, Eigen::VectorXd& memory, double& fresh) {
  const auto order = static_cast<Index>(kMemory);
  Eigen::MatrixXd F =
      1e-6 * static_cast<double>(left.size()) * Eigen::MatrixXd::Identity(order, order);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(order);
  Eigen::VectorXd before(order);
  const auto load = [&](std::size_t k) {
    for (Index j = 0; j < order; ++j) before[j] = left[k - 1 - static_cast<std::size_t>(j)];
  };
  for (std::size_t k = kMemory; k < left.size(); ++k) {
    load(k);
    F += before * before.transpose();
    u += before * left[k];
  }
  memory = F.ldlt().solve(u);
  double squares = 0.0;
  for (std::size_t k = kMemory; k < left.size(); ++k) {
    load(k);
    squares += std::pow(left[k] - memory.dot(before), 2);
  }
  fresh = std::sqrt(std::max(squares / static_cast<double>(left.size() - kMemory), 1e-12));
}

// Derivative of the rotated readings by the tilt, times -1: what the readings change by.
Eigen::Vector3d read_by_tilt(const Eigen::Matrix3d& by_tilt,
                             const Eigen::Matrix3d& tilt,
                             const Eigen::Vector3d& expected) {
  return -by_tilt * tilt.transpose() * expected;
}

}  // namespace

TiltProblem::TiltProblem(std::vector<TiltWindow> windows,
                         TiltAxes axes,
                         bool bank_is_known,
                         LibraryOptions library)
    : windows_(std::move(windows)), bank_is_known_(bank_is_known), library_(std::move(library)) {
  if (axes.rates) used_.insert(used_.end(), {kRollRate, kPitchRate});
  if (axes.forces) used_.insert(used_.end(), {kForward, kLeft});
  if (usable()) estimate_noise();
}

bool TiltProblem::usable() const { return windows_.size() >= kFewestWindows && !used_.empty(); }

std::optional<Eigen::Vector2d> TiltProblem::tilt_by_gravity() const {
  if (used_.back() != kLeft) return std::nullopt;
  const Rows rows = rows_at(0.0, 0.0);
  const Eigen::Vector2d mean(rows.sides[kLeft].col(0).mean(), rows.sides[kForward].col(0).mean());
  return (mean / kGravity).cwiseMax(-1.0).cwiseMin(1.0).array().asin().matrix();
}

std::vector<ChannelName> TiltProblem::channels() const {
  return {{"imu0", "roll_rate"}, {"imu0", "pitch_rate"}, {"imu0", "forward"}, {"imu0", "left"}};
}

std::size_t TiltProblem::rows() const { return windows_.size() * used_.size(); }

TiltProblem::Rows TiltProblem::rows_at(double roll, double pitch) const {
  constexpr double kStep = 1e-5;      // [rad]
  constexpr double kStraight = 0.02;  // [rad/s]
  const Eigen::Matrix3d tilt = tilt_rotation(roll, pitch);
  const std::array<Eigen::Matrix3d, 2> by_tilt{
      (tilt_rotation(roll + kStep, pitch) - tilt_rotation(roll - kStep, pitch)) / (2.0 * kStep),
      (tilt_rotation(roll, pitch + kStep) - tilt_rotation(roll, pitch - kStep)) / (2.0 * kStep)};
  Rows rows;
  const auto n = static_cast<Index>(windows_.size());
  for (std::size_t c = 0; c < kChannels; ++c) {
    rows.sides[c].resize(n, 3);
    rows.unknowns[c].resize(n, kUnknowns);
  }
  for (Index k = 0; k < n; ++k) {
    const TiltWindow& w = windows_[static_cast<std::size_t>(k)];
    const Eigen::Vector3d rate = tilt * w.rate;
    const Eigen::Vector3d force = tilt * w.force;
    const double turn = (rate.z() - w.own_rate.z()) / w.up.z();
    const Eigen::Vector3d expected_rate = w.own_rate + turn * w.up;
    const double aside = w.speed * rate.z();
    const Eigen::Vector3d expected_force =
        Eigen::Vector3d(w.acceleration, aside, 0.0) + kGravity * w.up;
    const auto set = [&](std::size_t channel, Index axis, const Eigen::Vector3d& read,
                         const Eigen::Vector3d& expected, double by_acceleration, double by_bank) {
      rows.sides[channel](k, 0) = read[axis] - expected[axis];
      for (Index j = 0; j < 2; ++j)
        rows.sides[channel](k, 1 + j) =
            read_by_tilt(by_tilt[static_cast<std::size_t>(j)], tilt, expected)[axis];
      rows.unknowns[channel].row(k) << 1.0, by_acceleration, by_bank;
    };
    // A bank hangs down on the inner side of either bend. On a straight there is none.
    const double side = bank_is_known_ ? 0.0 : -turn / std::hypot(turn, kStraight);
    set(kRollRate, 0, rate, expected_rate, w.acceleration * turn, 0.0);
    set(kPitchRate, 1, rate, expected_rate, aside * turn, side * turn);
    set(kForward, 0, force, expected_force, w.acceleration, 0.0);
    set(kLeft, 1, force, expected_force, aside, side * kGravity);
  }
  return rows;
}

// With the tilt and all unknowns of a channel free; later rounds know outliers.
void TiltProblem::estimate_noise() {
  constexpr int kRounds = 4;
  constexpr double kSureOutliers = 20.0;  // twice the log likelihood
  const Rows rows = rows_at(0.0, 0.0);
  const auto n = static_cast<Index>(windows_.size());
  for (const std::size_t c : used_) {
    Noise& noise = noise_[c];
    noise.weight.assign(windows_.size(), 1.0);
    Eigen::MatrixXd X(n, 2 + kUnknowns);
    X << rows.sides[c].rightCols(2), rows.unknowns[c];
    std::vector<double> left(windows_.size());
    for (int round = 0; round < kRounds; ++round) {
      const Eigen::Map<const Eigen::VectorXd> w(noise.weight.data(), n);
      const Eigen::VectorXd size =
          (w.asDiagonal() * X).colPivHouseholderQr().solve(w.asDiagonal() * rows.sides[c].col(0));
      Eigen::Map<Eigen::VectorXd>(left.data(), n) = rows.sides[c].col(0) - X * size;
      const OutlierMixture m = fit_outliers(left);
      const bool mixed = 2.0 * m.gained > kSureOutliers;
      for (std::size_t k = 0; k < left.size(); ++k)
        noise.weight[k] = std::sqrt(mixed ? 1.0 - 0.99 * m.part[k] : 1.0) /
                          std::max(mixed ? m.scale : m.alone, 1e-12);
    }
    for (std::size_t k = 0; k < left.size(); ++k) left[k] *= noise.weight[k];
    set_memory(left, noise.memory, noise.fresh);
    // The accelerations come from the reference: their errors follow the driver and are no process
    // with one memory. The bias decides how much gravity says, hardly ever the noise.
    if (c == kForward || c == kLeft) noise.fresh *= kForceCounts;
  }
}

Innovations TiltProblem::whitened(const Rows& rows) const {
  Innovations result;
  result.sides = static_cast<std::size_t>(rows.sides[0].cols());
  Eigen::VectorXd variance(static_cast<Index>(kUnknowns * kChannels));
  for (std::size_t c = 0; c < kChannels; ++c)
    for (std::size_t j = 0; j < kUnknowns; ++j)
      variance[static_cast<Index>(kUnknowns * c + j)] = std::pow(kUnknown[c][j], 2);
  SequentialProjection projection(variance, rows.sides[0].cols());
  for (std::size_t k = kMemory; k < windows_.size(); ++k)
    for (const std::size_t c : used_) {
      const Noise& noise = noise_[c];
      Eigen::RowVectorXd sides = Eigen::RowVectorXd::Zero(rows.sides[c].cols());
      Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(variance.size());
      for (std::size_t j = 0; j <= kMemory; ++j) {
        const auto row = static_cast<Index>(k - j);
        const double share = (j == 0 ? 1.0 : -noise.memory[static_cast<Index>(j - 1)]) *
                             noise.weight[k - j] / noise.fresh;
        sides += share * rows.sides[c].row(row);
        unknowns.segment<kUnknowns>(static_cast<Index>(kUnknowns * c)) +=
            share * rows.unknowns[c].row(row).transpose();
      }
      const double grown = projection.next(unknowns, sides);
      result.of.push_back({k * kChannels + c, c, windows_[k].t_s, grown});
      result.values.insert(result.values.end(), sides.data(), sides.data() + sides.size());
    }
  return result;
}

CauseModel TiltProblem::nominal() const {
  CauseModel model;
  model.state = std::make_shared<CauseState>();
  fit(model, 1);
  return model;
}

std::vector<Candidate> TiltProblem::candidates(const CauseModel& /*model*/) const {
  std::vector<Candidate> all;
  if (!library_.named) return all;
  for (const EffectInfo& e : imu_effects()) {
    if ((e.name != kRoll && e.name != kPitch) || holds(library_.without, e.name)) continue;
    Candidate c;
    c.name = e.name;
    c.unit = e.unit;
    c.tau = e.plausible;
    if (library_.bounds) {
      c.lowest = e.lowest;
      c.highest = e.highest;
    }
    all.push_back(c);
  }
  return all;
}

Projection TiltProblem::project(const CauseModel& model, std::vector<Candidate> candidates) const {
  const Eigen::Vector2d tilt = tilt_of(model);
  const Rows rows = rows_at(tilt[0], tilt[1]);
  Projection projection;
  std::vector<Index> columns{0};
  const auto column_of = [](const Candidate& c) -> Index {
    return shared_name(c) == kRoll ? 1 : 2;
  };
  for (const Accepted& a : model.accepted) columns.push_back(column_of(a.candidate));
  projection.accepted = model.accepted.size();
  for (Candidate& c : candidates) {
    c.columns = {columns.size() - 1};
    columns.push_back(column_of(c));
    projection.candidates.push_back(std::move(c));
  }
  Rows chosen = rows;
  for (std::size_t c = 0; c < kChannels; ++c) {
    chosen.sides[c].resize(rows.sides[c].rows(), static_cast<Index>(columns.size()));
    for (std::size_t j = 0; j < columns.size(); ++j)
      chosen.sides[c].col(static_cast<Index>(j)) = rows.sides[c].col(columns[j]);
  }
  projection.innovations = whitened(chosen);
  return projection;
}

void TiltProblem::fit(CauseModel& model, int iterations) const {
  fit_beside(model, iterations, {});
}

void TiltProblem::fit_beside(CauseModel& model, int iterations, const SizePrior& others) const {
  constexpr double kNoStep = 1e-7;  // [rad]
  for (int i = 0; i < std::max(iterations, 1); ++i) {
    const Eigen::VectorXd before = sizes_of(model);
    linear_fit(project(model, {}), model, others);
    if (before.size() == 0 || (sizes_of(model) - before).cwiseAbs().maxCoeff() < kNoStep) break;
  }
}

RowCovariate TiltProblem::covariate(const CauseModel& /*model*/,
                                    const Candidate& /*cause*/,
                                    const Innovations& innovations) const {
  RowCovariate result{"turn rate [rad/s]", {}};
  for (const Innovation& i : innovations.of)
    result.values.push_back(windows_[i.row / kChannels].rate.z());
  return result;
}

}  // namespace roadbook
