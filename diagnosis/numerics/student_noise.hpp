#pragma once

#include <vector>

namespace roadbook {

// Noise of views: Student's t of two dimensions, whose tails hold the matches that are wrong but
// not wild. Corners are searched for where the nominal model expects them; wrong matches therefore
// lie about the nominal prediction, and with a normal's weight they pull every size towards zero.

/// As good as normal.
inline constexpr double kNormalFreedom = 1e6;

/// Of chi-squared of two degrees of freedom.
inline constexpr double kMedianOfTwoSquares = 1.3863;

struct StudentNoise {
  double sigma = 1.0;  ///< scale, of one coordinate
  double freedom = kNormalFreedom;
};

/// By maximum likelihood from squares of (x, y) errors; normal where tails are not heavier by more
/// than chance. At least one square.
[[nodiscard]] StudentNoise student_noise(const std::vector<double>& squares);

/// Weight of an error, `square` in units of sigma^2: its part in the score against that of normal
/// noise (Lange, Little, Taylor, Robust statistical modeling using the t distribution, 1989).
[[nodiscard]] double student_weight(double square, double freedom);

/// Gate of outliers in sigma, with all catalogued effects free: 4 for normal noise; with heavy
/// tails, the value of the same probability, at most 8.
[[nodiscard]] double view_gate(double freedom);

/// With these weights held, information is larger than that of the sizes by this factor:
/// E[w] / E[d(w r)/dr] = (freedom + 4) / (freedom + 2).
[[nodiscard]] double student_excess(double freedom);

}  // namespace roadbook
