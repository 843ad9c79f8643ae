#pragma once

#include <functional>
#include <limits>
#include <vector>

namespace roadbook {

/// A stretch of a path with one speed limit.
struct SpeedPiece {
  double begin_m = 0.0;
  double end_m = 0.0;
  double speed = 0.0;  ///< [m/s]
  [[nodiscard]] double length_m() const { return end_m - begin_m; }
};

struct SpeedPieceOptions {
  double shortest_m = 5.0;  ///< shorter pieces only if the path is too short for `at_least`
  double longest_m = std::numeric_limits<double>::infinity();
  int at_least = 1;            ///< number of pieces, e.g. 2 for a ring
  double further_cut_s = 0.2;  ///< a further piece must save this travel time
  /// Whether a piece may end at s; not called for the end of the path. Empty: anywhere. If
  /// `longest_m` cannot be kept otherwise, pieces end anywhere.
  std::function<bool(double s_m)> may_cut{};

  /// Throws InvalidOption.
  void check() const;
};

/// Least speed [m/s] of a profile between two positions of a path, ends included; above 0.
using LeastSpeed = std::function<double(double from_m, double to_m)>;

/// Divides a speed profile from `begin_m` to `end_m` into pieces with one limit each, for formats
/// without profiles. The pieces are in order, without gaps, and nowhere faster than the profile.
///
/// Dynamic programming over cuts on a grid of about 0.5 m finds the pieces with the least sum of
/// travel time and `further_cut_s` a piece. Cost: length over grid step, times `longest_m` over
/// grid step (at most 4,000 steps). Throws InvalidOption.
[[nodiscard]] std::vector<SpeedPiece> speed_pieces(const LeastSpeed& least_speed,
                                                   double begin_m,
                                                   double end_m,
                                                   const SpeedPieceOptions& options = {});

}  // namespace roadbook
