#pragma once

#include <cstddef>
#include <map>
#include <vector>

namespace roadbook {

/// What one measured row is and when.
struct Innovation {
  std::size_t row = 0;      ///< the problem's own number of it
  std::size_t channel = 0;  ///< index into the problem's `channels()`
  double t_s = 0.0;         ///< of the motion it shows
  double variance = 1.0;    ///< relative to the row's noise
  std::size_t drive = 0;    ///< of several that are joined
};

/// An innovation of a larger variance depends on the unknowns more than on the noise.
inline constexpr double kVague = 3.0;

/// Innovations of a problem's rows: the unknowns (trajectory, landmarks, ...) are projected out.
/// White and N(0, 1) if the model is right.
struct Innovations {
  std::size_t sides = 0;  ///< residual, then the columns, then what else rode along
  std::vector<Innovation> of;
  std::vector<double> values;  ///< row-major, `sides` each
  /// P-values of whiteness tests of channels that have a test of their own kind.
  std::map<std::size_t, double> whiteness_p{};
  [[nodiscard]] const double* row(std::size_t i) const { return values.data() + i * sides; }
};

/// Those of `all` whose rows `others`, of the same problem, have too.
[[nodiscard]] Innovations rows_in_both(const Innovations& all, const Innovations& others);

}  // namespace roadbook
