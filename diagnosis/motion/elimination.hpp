#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "diagnosis/numerics/givens.hpp"

namespace roadbook {

// Sequential elimination of a trajectory by Givens rotations (square-root information form, Bierman
// 1977).
// There are nine unknowns at a time: the drift of the wheels' distance and heading since the start,
// speed and yaw rate at both ends of the current knot interval, and the pose at its beginning. Rows
// of readings are folded in one by one, with several right-hand sides. After all unknowns are
// rotated out, a row leaves its innovation: independent of all others, and N(0, 1) if the row's
// noise is. The whole trajectory, past and future, is projected out exactly. Cost: linear in the
// length of the drive.

/// The unknowns, in the order of elimination.
inline constexpr std::size_t kDrift = 0, kTurnDrift = 1, kSpeedA = 2, kYawA = 3, kSpeedB = 4,
                             kYawB = 5, kX = 6, kY = 7, kHeading = 8, kSlots = 9;

/// How the unknowns of one interval give those of the next; small changes about a reference.
struct KnotStep {
  std::array<double, 4> drift{};       ///< of the wheels' distance, by SpeedA, YawA, SpeedB, YawB
  std::array<double, 4> turn_drift{};  ///< of the wheels' heading
  std::array<double, 4> x{}, y{};      ///< of the position
  double x_by_heading = 0.0;
  double y_by_heading = 0.0;
  double half_step_s = 0.0;          ///< heading grows by this times both yaw rates
  std::array<double, 3> defect{};    ///< end of the interval less the next knot's pose (reference)
  std::array<double, 2> sideways{};  ///< direction of creep
  double creep_sigma = 1.0;          ///< [m]
  double speed_sigma = 1.0;          ///< of the second difference of the speed
  double yaw_sigma = 1.0;            ///< of the second difference of the yaw rate
  double speed_bend = 0.0;           ///< second difference of the reference
  double yaw_bend = 0.0;
};

/// Distance that the wheels roll from the last reading to this one, and standard deviations of both
/// drifts' random walks.
struct WheelStep {
  std::array<double, 4> drift{};
  std::array<double, 4> turn_drift{};
  double drift_sigma = 1.0;
  double turn_sigma = 1.0;
  std::array<double, 2> reading_sigma{1.0, 1.0};  ///< of the reading that ends the walk
};

class Elimination {
 public:
  /// `sides`: right-hand sides a row; column 0 is the residual. `keep`: store what
  /// `back_substitute` needs.
  Elimination(std::size_t sides, bool keep);

  /// Length of a row: the slots, then the right-hand sides, padded with zeros.
  [[nodiscard]] std::size_t stride() const { return stride_; }

  /// Folds one whitened row (slots, then sides) in; leaves the innovations in its sides. Returns
  /// the variance of the innovation relative to the row's noise, or 0 where the row was used up to
  /// determine an unknown and has no innovation.
  double measure(double* row);
  /// Continues with the next interval. `sides` (or null: zeros) are the right-hand sides of the
  /// rows of creep, speed and yaw rate, in addition to the step's own bends and defects.
  void advance(const KnotStep& step, const double* sides = nullptr);
  /// The wheels' drifts walk; `sides` are those of the two rows, drift first.
  void walk(const WheelStep& step, const double* drift_sides, const double* turn_sides);

  /// Solution, last first.
  struct Solution {
    std::vector<std::array<double, kSlots>> knots;  ///< unknowns in the interval of each knot
    // Innovations of the random walks' own rows, whitened, later ones first. `..._sides`: their
    // right-hand sides.
    std::vector<std::array<double, 3>> knot_residuals, knot_sides;  ///< creep, speed, yaw rate
    std::vector<std::array<double, 2>> walk_residuals, walk_sides;
    /// Drift at each reading of the wheels over the reading's sigma; the last reading comes first.
    /// Drifts are relative to the readings, so these are residuals of the fit.
    std::vector<std::array<double, 2>> readings;
  };
  /// For the right-hand side that is the sum of the sides, weighted by `all`.
  [[nodiscard]] Solution back_substitute(const std::vector<double>& all) const;

 private:
  struct Operation {
    bool knot = false;
    KnotStep step;
    WheelStep walk;
    std::size_t rows = 0;  ///< index of the dropped rows in kept_
    std::size_t own = 0;   ///< index of the operation's own sides in kept_
  };
  [[nodiscard]] double* factor(std::size_t row) { return factor_.data() + row * stride_; }
  using Weights = std::vector<std::pair<std::size_t, double>>;  ///< side, weight: not 0, ascending
  [[nodiscard]] double combined(std::size_t sides_at, const Weights& weights) const;
  void fill_knot_rows(const KnotStep& step);
  std::size_t keep_rows(std::size_t count, std::size_t columns);
  void undo_knot(const Operation& op,
                 const Weights& weights,
                 std::array<double, kSlots>& now,
                 Solution& solution) const;
  void undo_walk(const Operation& op,
                 const Weights& weights,
                 std::array<double, kSlots>& now,
                 Solution& solution) const;

  std::size_t sides_;
  std::size_t padded_;  ///< sides, padded
  std::size_t stride_;
  bool keep_;
  std::vector<double> factor_;  ///< 9 rows
  std::vector<double> left_;    ///< of the rows at a knot or walk
  std::vector<double> tails_;   ///< right-hand sides of those whose unknowns go
  std::vector<Rotation> rotations_;
  std::vector<double> product_;
  std::vector<double> kept_;
  std::vector<Operation> operations_;
};

}  // namespace roadbook
