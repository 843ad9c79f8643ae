#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/map_changes/landmark_chances.hpp"
#include "diagnosis/numerics/group_counts.hpp"

namespace roadbook {

// Squares of a map in which far fewer landmarks are found again than chance and the scatter
// between squares allow.

struct GoneSquareOptions {
  std::vector<double> sides_m{2.0, 3.0, 4.0};  ///< of the squares, each at four offsets
  double least_expected = 4.0;                 ///< landmarks to be found in one
  /// Probability of a square that is taken for fallen at first. Where a fifth has fallen a
  /// cautious one leaves half of that in what should tell how much standing squares scatter.
  double try_at = 0.01;
  double apart_m = 1.0;  ///< between lost landmarks of two things
};

struct GoneSquare {
  std::vector<std::size_t> landmarks;                ///< of the chances given
  std::size_t size = 0;                              ///< in `sides_m`
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< [m] lower left, map frame
  double p = 1.0;  ///< of so few by chance and scatter of what stands; 1: not nearly empty
};

/// Squares by those landmarks that stand.
struct StandingSquares {
  std::vector<GoneSquare> squares;
  std::vector<double> scatter;         ///< by size, in log odds
  std::vector<std::uint8_t> can_tell;  ///< by size: whether there are squares to tell that by

  [[nodiscard]] double widest_scatter() const;  ///< of sizes that can tell; 0: none
};

/// Fills the chances by those landmarks that stand, and counts squares of them.
[[nodiscard]] StandingSquares standing_squares(const std::vector<std::uint8_t>& stands,
                                               const GoneSquareOptions& options,
                                               std::vector<LandmarkChance>& chances);

struct FallenSquares {
  std::vector<GoneSquare> squares;  ///< below `try_at` each; no landmark is in two of them
  std::vector<GoneSquare> tests;    ///< all squares there were, with all their landmarks
  std::size_t neighbours = 0;       ///< that touch one of them, at most
};

/// Takes the surest square for fallen, then the surest of what it leaves, and so on; each by chance
/// and scatter of what is left without it, for what is gone tells nothing of what stands, and alike
/// ones hide each other. Deterministic.
[[nodiscard]] FallenSquares fallen_squares(std::vector<LandmarkChance>& chances,
                                           const GoneSquareOptions& options = {});

/// Count of some landmarks under their chances.
[[nodiscard]] GroupCount count_of(const std::vector<std::size_t>& landmarks,
                                  const std::vector<LandmarkChance>& chances);
/// Probability of so few; 1 where they are not nearly empty.
[[nodiscard]] double chance_of(const std::vector<std::size_t>& landmarks,
                               double scatter,
                               const std::vector<LandmarkChance>& chances);

}  // namespace roadbook
