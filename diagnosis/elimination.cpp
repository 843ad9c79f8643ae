#include "diagnosis/elimination.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/givens.hpp"

namespace roadbook {
namespace {

// Columns of the rows at a knot: what goes (creep, speed and yaw rate at A), then the slots of the
// next interval; the next end C stands behind B.
constexpr std::size_t kCreep = 0, kGoneSpeed = 1, kGoneYaw = 2, kKept = 3;
constexpr std::size_t kKnotColumns = 3 + kSlots;
constexpr std::size_t kKnotRows = 3 + kSlots;
constexpr std::size_t kGone = 3;
// Columns of the rows at a walk: old drifts, then the slots with the new ones.
constexpr std::size_t kWalkColumns = 2 + kSlots;
constexpr std::size_t kWalkRows = 4;

// An unknown that nothing has told of yet: a pivot this small against the rows' unit noise.
constexpr double kNothing = 1e-9;

}  // namespace

Elimination::Elimination(std::size_t sides, bool keep)
    : sides_(sides),
      padded_((sides + 3) / 4 * 4),
      stride_(kSlots + padded_),
      keep_(keep),
      factor_(kSlots * stride_, 0.0),
      work_(kKnotRows * (kKnotColumns + padded_), 0.0) {}

double Elimination::measure(double* row) {
  double cosine = 1.0;
  for (std::size_t i = 0; i < kSlots; ++i) {
    double* pivot = factor(i);
    if (std::abs(row[i]) > kNothing && std::abs(pivot[i]) < kNothing) cosine = 0.0;
    const double c = rotate_rows(pivot, row, i, stride_);
    cosine *= c;
  }
  return cosine * cosine < 1e-12 ? 0.0 : 1.0 / (cosine * cosine);
}

void Elimination::fill_knot_rows(const KnotStep& step, const double* sides) {
  const std::size_t width = kKnotColumns + padded_;
  std::fill(work_.begin(), work_.end(), 0.0);
  double* creep = work_.data();
  double* speed = creep + width;
  double* yaw = speed + width;
  for (std::size_t i = 0; sides != nullptr && i < 3; ++i)
    std::copy_n(sides + i * sides_, sides_, creep + i * width + kKnotColumns);
  creep[kCreep] = 1.0 / step.creep_sigma;
  speed[kGoneSpeed] = 1.0 / step.speed_sigma;
  speed[kKept + kSpeedA] = -2.0 / step.speed_sigma;
  speed[kKept + kSpeedB] = 1.0 / step.speed_sigma;
  speed[kKnotColumns] -= step.speed_bend / step.speed_sigma;
  yaw[kGoneYaw] = 1.0 / step.yaw_sigma;
  yaw[kKept + kYawA] = -2.0 / step.yaw_sigma;
  yaw[kKept + kYawB] = 1.0 / step.yaw_sigma;
  yaw[kKnotColumns] -= step.yaw_bend / step.yaw_sigma;
  for (std::size_t i = 0; i < kSlots; ++i) {
    const double* from = factor(i);
    double* to = work_.data() + (kGone + i) * width;
    const double ax = from[kX];
    const double ay = from[kY];
    const double turn = from[kHeading] - ax * step.x_by_heading - ay * step.y_by_heading;
    std::array<double, 4> rates{from[kSpeedA], from[kYawA], from[kSpeedB], from[kYawB]};
    for (std::size_t k = 0; k < 4; ++k) {
      rates[k] -= ax * step.x[k] + ay * step.y[k] + from[kDrift] * step.drift[k] +
                  from[kTurnDrift] * step.turn_drift[k];
      if (k % 2 == 1) rates[k] -= turn * step.half_step_s;
    }
    to[kCreep] = -ax * step.sideways[0] - ay * step.sideways[1];
    to[kGoneSpeed] = rates[0];
    to[kGoneYaw] = rates[1];
    to[kKept + kDrift] = from[kDrift];
    to[kKept + kTurnDrift] = from[kTurnDrift];
    to[kKept + kSpeedA] = rates[2];
    to[kKept + kYawA] = rates[3];
    to[kKept + kX] = ax;
    to[kKept + kY] = ay;
    to[kKept + kHeading] = turn;
    std::copy_n(from + kSlots, padded_, to + kKnotColumns);
    to[kKnotColumns] += ax * step.defect[0] + ay * step.defect[1] + turn * step.defect[2];
  }
}

void Elimination::advance(const KnotStep& step, const double* sides) {
  const std::size_t width = kKnotColumns + padded_;
  fill_knot_rows(step, sides);
  for (std::size_t column = 0; column < kKnotColumns; ++column)
    for (std::size_t row = column + 1; row < kKnotRows; ++row)
      rotate_rows(work_.data() + column * width, work_.data() + row * width, column, width);
  for (std::size_t i = 0; i < kSlots; ++i)
    std::copy_n(work_.data() + (kGone + i) * width + kKept, stride_, factor(i));
  if (!keep_) return;
  Operation op;
  op.knot = true;
  op.step = step;
  op.rows = kept_.size();
  kept_.insert(kept_.end(), work_.begin(),
               work_.begin() + static_cast<std::ptrdiff_t>(kGone * width));
  op.own = kept_.size();
  if (sides != nullptr)
    kept_.insert(kept_.end(), sides, sides + 3 * sides_);
  else
    kept_.insert(kept_.end(), 3 * sides_, 0.0);
  operations_.push_back(op);
}

void Elimination::walk(const WheelStep& step, const double* drift_sides, const double* turn_sides) {
  const std::size_t width = kWalkColumns + padded_;
  double* rows = work_.data();
  std::fill_n(rows, kWalkRows * width, 0.0);
  for (std::size_t i = 0; i < 2; ++i) {
    rows[i * width] = factor(i)[kDrift];
    rows[i * width + 1] = factor(i)[kTurnDrift];
    std::copy_n(factor(i) + 2, stride_ - 2, rows + i * width + 4);
  }
  const auto walk_row = [&](std::size_t row, std::size_t slot, const std::array<double, 4>& rolls,
                            double sigma, const double* sides) {
    double* to = rows + row * width;
    to[slot] = -1.0 / sigma;
    to[2 + slot] = 1.0 / sigma;
    for (std::size_t k = 0; k < 4; ++k) to[2 + kSpeedA + k] = -rolls[k] / sigma;
    std::copy_n(sides, sides_, to + kWalkColumns);
  };
  walk_row(2, kDrift, step.drift, step.drift_sigma, drift_sides);
  walk_row(3, kTurnDrift, step.turn_drift, step.turn_sigma, turn_sides);
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t row = column + 1; row < kWalkRows; ++row)
      rotate_rows(rows + column * width, rows + row * width, column, width);
  for (std::size_t i = 0; i < 2; ++i) std::copy_n(rows + (2 + i) * width + 2, stride_, factor(i));
  if (!keep_) return;
  Operation op;
  op.walk = step;
  op.rows = kept_.size();
  kept_.insert(kept_.end(), rows, rows + 2 * width);
  op.own = kept_.size();
  kept_.insert(kept_.end(), drift_sides, drift_sides + sides_);
  kept_.insert(kept_.end(), turn_sides, turn_sides + sides_);
  operations_.push_back(op);
}

double Elimination::combined(std::size_t sides_at, const std::vector<double>& weights) const {
  double sum = 0.0;
  for (std::size_t k = 0; k < sides_; ++k) sum += weights[k] * kept_[sides_at + k];
  return sum;
}

void Elimination::undo_knot(const Operation& op,
                            const std::vector<double>& weights,
                            std::array<double, kSlots>& now,
                            Solution& solution) const {
  const std::size_t width = kKnotColumns + padded_;
  const KnotStep& step = op.step;
  std::array<double, kKnotColumns> all{};
  std::copy(now.begin(), now.end(), all.begin() + kKept);
  for (std::size_t i = kGone; i-- > 0;) {
    const double* row = kept_.data() + op.rows + i * width;
    double value = combined(op.rows + i * width + kKnotColumns, weights);
    for (std::size_t k = i + 1; k < kKnotColumns; ++k) value -= row[k] * all[k];
    all[i] = std::abs(row[i]) < kNothing ? 0.0 : value / row[i];
  }
  const double own = weights[0];
  const std::array<double, 3> sides{combined(op.own, weights), combined(op.own + sides_, weights),
                                    combined(op.own + 2 * sides_, weights)};
  const double speed_bend = all[kGoneSpeed] - 2.0 * now[kSpeedA] + now[kSpeedB];
  const double yaw_bend = all[kGoneYaw] - 2.0 * now[kYawA] + now[kYawB];
  solution.knot_sides.push_back(sides);
  solution.knot_residuals.push_back(
      {all[kCreep] / step.creep_sigma - sides[0],
       (speed_bend + own * step.speed_bend) / step.speed_sigma - sides[1],
       (yaw_bend + own * step.yaw_bend) / step.yaw_sigma - sides[2]});
  const std::array<double, 4> rates{all[kGoneSpeed], all[kGoneYaw], now[kSpeedA], now[kYawA]};
  std::array<double, kSlots> before{};
  before[kHeading] =
      now[kHeading] - step.half_step_s * (rates[1] + rates[3]) - own * step.defect[2];
  before[kX] = now[kX] - step.x_by_heading * before[kHeading] - step.sideways[0] * all[kCreep] -
               own * step.defect[0];
  before[kY] = now[kY] - step.y_by_heading * before[kHeading] - step.sideways[1] * all[kCreep] -
               own * step.defect[1];
  before[kDrift] = now[kDrift];
  before[kTurnDrift] = now[kTurnDrift];
  for (std::size_t k = 0; k < 4; ++k) {
    before[kX] -= step.x[k] * rates[k];
    before[kY] -= step.y[k] * rates[k];
    before[kDrift] -= step.drift[k] * rates[k];
    before[kTurnDrift] -= step.turn_drift[k] * rates[k];
    before[kSpeedA + k] = rates[k];
  }
  now = before;
  solution.knots.push_back(now);
}

void Elimination::undo_walk(const Operation& op,
                            const std::vector<double>& weights,
                            std::array<double, kSlots>& now,
                            Solution& solution) const {
  const std::size_t width = kWalkColumns + padded_;
  solution.readings.push_back(
      {now[kDrift] / op.walk.reading_sigma[0], now[kTurnDrift] / op.walk.reading_sigma[1]});
  std::array<double, kWalkColumns> all{};
  std::copy(now.begin(), now.end(), all.begin() + 2);
  for (std::size_t i = 2; i-- > 0;) {
    const double* row = kept_.data() + op.rows + i * width;
    double value = combined(op.rows + i * width + kWalkColumns, weights);
    for (std::size_t k = i + 1; k < kWalkColumns; ++k) value -= row[k] * all[k];
    all[i] = std::abs(row[i]) < kNothing ? 0.0 : value / row[i];
  }
  std::array<double, 2> moved{now[kDrift] - all[0], now[kTurnDrift] - all[1]};
  for (std::size_t k = 0; k < 4; ++k) {
    moved[0] -= op.walk.drift[k] * now[kSpeedA + k];
    moved[1] -= op.walk.turn_drift[k] * now[kSpeedA + k];
  }
  const std::array<double, 2> sides{combined(op.own, weights), combined(op.own + sides_, weights)};
  solution.walk_sides.push_back(sides);
  solution.walk_residuals.push_back(
      {moved[0] / op.walk.drift_sigma - sides[0], moved[1] / op.walk.turn_sigma - sides[1]});
  now[kDrift] = all[0];
  now[kTurnDrift] = all[1];
}

Elimination::Solution Elimination::back_substitute(const std::vector<double>& weights) const {
  ROADBOOK_ASSERT(keep_ && weights.size() == sides_);
  Solution solution;
  std::array<double, kSlots> now{};
  for (std::size_t i = kSlots; i-- > 0;) {
    const double* row = factor_.data() + i * stride_;
    double value = 0.0;
    for (std::size_t k = 0; k < sides_; ++k) value += weights[k] * row[kSlots + k];
    for (std::size_t k = i + 1; k < kSlots; ++k) value -= row[k] * now[k];
    now[i] = std::abs(row[i]) < kNothing ? 0.0 : value / row[i];
  }
  solution.knots.push_back(now);
  for (auto op = operations_.rbegin(); op != operations_.rend(); ++op)
    op->knot ? undo_knot(*op, weights, now, solution) : undo_walk(*op, weights, now, solution);
  return solution;
}

}  // namespace roadbook
