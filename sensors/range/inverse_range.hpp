#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sensors/range/range_mixture.hpp"

namespace roadbook {

// The inverse sensor model: what a reading says about the cells on its beam. It is derived from the
// forward model, not set by hand. Source: document 001, "The inverse sensor model should also
// consider this"; Thrun, Burgard and Fox 2005, section 9.3.
//
// Along a beam, the distance r of the first surface has the prior density h exp(-h r), where h is
// the density of the map: surfaces a beam meets per metre. Bayes' rule gives the posterior of r for
// a reading z with the fitted forward model p(z | r). A cell is occupied if the first surface lies
// in it; if the first surface lies before it, the cell keeps its prior probability. If the first
// surface lies behind it, the beam crossed the cell and met nothing: the cell is free, or the beam
// missed the surface in it.
//
// A surface is a curve, and a cell is a square. Of two random lines that cross a square, the share
// 2 pi A / P^2 = pi / 8 meet within it (A: area, P: perimeter; Santalo 1976, chapter 3). A beam
// that grazes a wall crosses many of its cells without meeting it.

/// Probability that a ray that crosses an occupied cell meets the surface within the cell.
inline constexpr double kMetInCell = 0.39269908169872414;  // pi / 8

struct InverseRangeOptions {
  double cell_m = 0.1;          ///< side of a cell
  double surfaces_per_m = 0.1;  ///< density of the map along a beam [1/m]
  double cone_rad = 0.0;        ///< full angle of a wide beam, which covers cells; 0: a ray
  double met = kMetInCell;      ///< of a ray; a wide beam meets every surface in a cell
  double most_log_odds = 12.0;  ///< greatest change by one reading

  /// Throws InvalidOption.
  void check() const;
};

/// Changes of log odds, tabulated over the reading and the distance of the cell. Cost of the table:
/// the square of the maximum range over the step.
class InverseRangeModel {
 public:
  InverseRangeModel(const RangeMixture& mixture, double max_m, const InverseRangeOptions& options);

  /// Probability that a cell is occupied before any reading.
  [[nodiscard]] double prior() const { return prior_; }
  [[nodiscard]] double prior_log_odds() const;
  /// Probability that a beam that crosses an occupied cell meets its surface.
  [[nodiscard]] double met() const { return met_; }
  /// Distance between entries of a row [m].
  [[nodiscard]] double step_m() const { return step_m_; }
  [[nodiscard]] double max_m() const { return max_m_; }

  /// Changes of log odds for cells whose middles lie at i times `step_m` along the beam. The row
  /// ends some cells behind the reading; for the maximum range at the maximum range. `chord_m`:
  /// length of the beam within a cell, the cell's side up to 1.42 of it.
  [[nodiscard]] std::span<const float> changes(double read_m, double chord_m) const;

 private:
  static constexpr std::size_t kChords = 3;
  template <typename Occupied>
  void fill_row(std::size_t row,
                std::size_t chord,
                const InverseRangeOptions& options,
                const Occupied& occupied);

  double max_m_;
  double cell_m_;
  double step_m_;
  double met_;
  double prior_;
  std::size_t width_ = 0;                          ///< entries of a row
  std::size_t rows_ = 0;                           ///< readings, the last is the maximum range
  std::vector<std::size_t> ends_;                  ///< length of each row
  std::array<std::vector<float>, kChords> table_;  ///< for each length of chord
};

}  // namespace roadbook
