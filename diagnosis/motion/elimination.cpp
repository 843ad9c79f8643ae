#include "diagnosis/motion/elimination.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Columns of the rows at a knot: eliminated unknowns (creep, speed and yaw rate at A), then the
// slots of the next interval; its end C comes after B.
constexpr std::size_t kCreep = 0, kGoneSpeed = 1, kGoneYaw = 2, kKeptColumns = 3;
constexpr std::size_t kKnotColumns = 3 + kSlots;
constexpr std::size_t kKnotRows = 3 + kSlots;
constexpr std::size_t kGone = 3;
// Columns of the rows at a walk: old drifts, then the slots with the new ones.
constexpr std::size_t kWalkColumns = 2 + kSlots;
constexpr std::size_t kWalkRows = 4;

// An unknown without information: a pivot this small against the rows' unit noise.
constexpr double kNoPivot = 1e-9;

}  // namespace

Elimination::Elimination(std::size_t sides, bool keep)
    : sides_(sides),
      padded_((sides + kTailBlock - 1) / kTailBlock * kTailBlock),
      stride_(kSlots + padded_),
      keep_(keep),
      factor_(kSlots * stride_, 0.0),
      left_(kKnotRows * kKnotColumns, 0.0),
      tails_(kGone * padded_, 0.0) {}

double Elimination::measure(double* row) {
  double cosine = 1.0;
  std::array<double, kSlots> c{};
  std::array<double, kSlots> s{};
  for (std::size_t i = 0; i < kSlots; ++i) {
    double* pivot = factor(i);
    if (std::abs(row[i]) > kNoPivot && std::abs(pivot[i]) < kNoPivot) cosine = 0.0;
    c[i] = 1.0;
    if (row[i] == 0.0) continue;
    const double length = std::sqrt(pivot[i] * pivot[i] + row[i] * row[i]);
    c[i] = pivot[i] / length;
    s[i] = row[i] / length;
    for (std::size_t k = i; k < kSlots; ++k) {
      const double u = pivot[k];
      const double v = row[k];
      pivot[k] = c[i] * u + s[i] * v;
      row[k] = c[i] * v - s[i] * u;
    }
    row[i] = 0.0;
    cosine *= c[i];
  }
  rotate_tail(row + kSlots, factor(0) + kSlots, stride_, kSlots, padded_, c.data(), s.data());
  return cosine * cosine < 1e-12 ? 0.0 : 1.0 / (cosine * cosine);
}

// Left parts of the rows at a knot; the step's contributions to right-hand sides go into the tails.
void Elimination::fill_knot_rows(const KnotStep& step) {
  std::fill(left_.begin(), left_.end(), 0.0);
  double* creep = left_.data();
  double* speed = creep + kKnotColumns;
  double* yaw = speed + kKnotColumns;
  creep[kCreep] = 1.0 / step.creep_sigma;
  speed[kGoneSpeed] = 1.0 / step.speed_sigma;
  speed[kKeptColumns + kSpeedA] = -2.0 / step.speed_sigma;
  speed[kKeptColumns + kSpeedB] = 1.0 / step.speed_sigma;
  tails_[padded_] -= step.speed_bend / step.speed_sigma;
  yaw[kGoneYaw] = 1.0 / step.yaw_sigma;
  yaw[kKeptColumns + kYawA] = -2.0 / step.yaw_sigma;
  yaw[kKeptColumns + kYawB] = 1.0 / step.yaw_sigma;
  tails_[2 * padded_] -= step.yaw_bend / step.yaw_sigma;
  for (std::size_t i = 0; i < kSlots; ++i) {
    double* from = factor(i);
    double* to = left_.data() + (kGone + i) * kKnotColumns;
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
    to[kKeptColumns + kDrift] = from[kDrift];
    to[kKeptColumns + kTurnDrift] = from[kTurnDrift];
    to[kKeptColumns + kSpeedA] = rates[2];
    to[kKeptColumns + kYawA] = rates[3];
    to[kKeptColumns + kX] = ax;
    to[kKeptColumns + kY] = ay;
    to[kKeptColumns + kHeading] = turn;
    from[kSlots] += ax * step.defect[0] + ay * step.defect[1] + turn * step.defect[2];
  }
}

void Elimination::advance(const KnotStep& step, const double* sides) {
  std::fill(tails_.begin(), tails_.end(), 0.0);
  for (std::size_t i = 0; sides != nullptr && i < kGone; ++i)
    std::copy_n(sides + i * sides_, sides_, tails_.data() + i * padded_);
  fill_knot_rows(step);
  triangularise(left_.data(), kKnotRows, kKnotColumns, kKnotColumns, rotations_);
  std::array<double*, kKnotRows> tails{};
  for (std::size_t i = 0; i < kGone; ++i) tails[i] = tails_.data() + i * padded_;
  for (std::size_t i = 0; i < kSlots; ++i) tails[kGone + i] = factor(i) + kSlots;
  // Of many columns, only the residual is non-zero in the eliminated rows: a product is cheaper
  // there than as many rotations.
  const bool many = !keep_ && sides == nullptr && padded_ > 8 * kTailBlock;
  rotate_tails(tails.data(), kKnotRows, many ? kTailBlock : padded_, rotations_);
  if (many) {
    for (std::size_t i = 0; i < kSlots; ++i) tails[kGone + i] += kTailBlock;
    product_of(rotations_, kKnotRows, kSlots, product_);
    multiply_tails(tails.data() + kGone, kSlots, padded_ - kTailBlock, product_.data());
  }
  for (std::size_t i = 0; i < kSlots; ++i)
    std::copy_n(left_.data() + (kGone + i) * kKnotColumns + kKeptColumns, kSlots, factor(i));
  if (!keep_) return;
  Operation op;
  op.knot = true;
  op.step = step;
  op.rows = keep_rows(kGone, kKnotColumns);
  op.own = kept_.size();
  if (sides != nullptr)
    kept_.insert(kept_.end(), sides, sides + 3 * sides_);
  else
    kept_.insert(kept_.end(), 3 * sides_, 0.0);
  operations_.push_back(op);
}

// The first rows, whose unknowns are eliminated: left parts from left_, sides from tails_.
std::size_t Elimination::keep_rows(std::size_t count, std::size_t columns) {
  const std::size_t at = kept_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = left_.begin() + static_cast<std::ptrdiff_t>(i * columns);
    const auto tail = tails_.begin() + static_cast<std::ptrdiff_t>(i * padded_);
    kept_.insert(kept_.end(), left, left + static_cast<std::ptrdiff_t>(columns));
    kept_.insert(kept_.end(), tail, tail + static_cast<std::ptrdiff_t>(padded_));
  }
  return at;
}

void Elimination::walk(const WheelStep& step, const double* drift_sides, const double* turn_sides) {
  std::fill_n(left_.begin(), kWalkRows * kWalkColumns, 0.0);
  for (std::size_t i = 0; i < 2; ++i) {
    double* to = left_.data() + i * kWalkColumns;
    to[0] = factor(i)[kDrift];
    to[1] = factor(i)[kTurnDrift];
    std::copy_n(factor(i) + 2, kSlots - 2, to + 4);
    std::copy_n(factor(i) + kSlots, padded_, tails_.data() + i * padded_);
  }
  const auto walk_row = [&](std::size_t slot, const std::array<double, 4>& rolls, double sigma,
                            const double* sides) {
    double* to = left_.data() + (2 + slot) * kWalkColumns;
    to[slot] = -1.0 / sigma;
    to[2 + slot] = 1.0 / sigma;
    for (std::size_t k = 0; k < 4; ++k) to[2 + kSpeedA + k] = -rolls[k] / sigma;
    std::copy_n(sides, sides_, factor(slot) + kSlots);
  };
  walk_row(kDrift, step.drift, step.drift_sigma, drift_sides);
  walk_row(kTurnDrift, step.turn_drift, step.turn_sigma, turn_sides);
  triangularise(left_.data(), kWalkRows, kWalkColumns, 3, rotations_);
  // The old rows go and the walks' take their place in the factor.
  const std::array<double*, kWalkRows> tails{tails_.data(), tails_.data() + padded_,
                                             factor(0) + kSlots, factor(1) + kSlots};
  rotate_tails(tails.data(), kWalkRows, padded_, rotations_);
  for (std::size_t i = 0; i < 2; ++i)
    std::copy_n(left_.data() + (2 + i) * kWalkColumns + 2, kSlots, factor(i));
  if (!keep_) return;
  Operation op;
  op.walk = step;
  op.rows = keep_rows(2, kWalkColumns);
  op.own = kept_.size();
  kept_.insert(kept_.end(), drift_sides, drift_sides + sides_);
  kept_.insert(kept_.end(), turn_sides, turn_sides + sides_);
  operations_.push_back(op);
}

double Elimination::combined(std::size_t sides_at, const Weights& weights) const {
  double sum = 0.0;
  for (const auto& [side, weight] : weights) sum += weight * kept_[sides_at + side];
  return sum;
}

void Elimination::undo_knot(const Operation& op,
                            const Weights& weights,
                            std::array<double, kSlots>& now,
                            Solution& solution) const {
  const std::size_t width = kKnotColumns + padded_;
  const KnotStep& step = op.step;
  std::array<double, kKnotColumns> all{};
  std::copy(now.begin(), now.end(), all.begin() + kKeptColumns);
  for (std::size_t i = kGone; i-- > 0;) {
    const double* row = kept_.data() + op.rows + i * width;
    double value = combined(op.rows + i * width + kKnotColumns, weights);
    for (std::size_t k = i + 1; k < kKnotColumns; ++k) value -= row[k] * all[k];
    all[i] = std::abs(row[i]) < kNoPivot ? 0.0 : value / row[i];
  }
  const double own = weights.front().first == 0 ? weights.front().second : 0.0;
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
                            const Weights& weights,
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
    all[i] = std::abs(row[i]) < kNoPivot ? 0.0 : value / row[i];
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

Elimination::Solution Elimination::back_substitute(const std::vector<double>& all) const {
  ROADBOOK_ASSERT(keep_ && all.size() == sides_);
  Weights weights;
  for (std::size_t k = 0; k < sides_; ++k)
    if (all[k] != 0.0) weights.emplace_back(k, all[k]);
  if (weights.empty()) weights.emplace_back(0, 0.0);
  Solution solution;
  std::array<double, kSlots> now{};
  for (std::size_t i = kSlots; i-- > 0;) {
    const double* row = factor_.data() + i * stride_;
    double value = 0.0;
    for (const auto& [side, weight] : weights) value += weight * row[kSlots + side];
    for (std::size_t k = i + 1; k < kSlots; ++k) value -= row[k] * now[k];
    now[i] = std::abs(row[i]) < kNoPivot ? 0.0 : value / row[i];
  }
  solution.knots.push_back(now);
  for (auto op = operations_.rbegin(); op != operations_.rend(); ++op)
    op->knot ? undo_knot(*op, weights, now, solution) : undo_walk(*op, weights, now, solution);
  return solution;
}

}  // namespace roadbook
