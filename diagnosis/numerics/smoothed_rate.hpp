#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace roadbook {

/// Mean of a rate over a short time about `t_ns`, measured.
struct RateReading {
  std::int64_t t_ns = 0;
  double rate = 0.0;
  double variance = 1.0;  ///< up to a factor that all readings share
};

// Expected value of a rate that is measured with noise: Kalman filter and smoother (Rauch, Tung,
// Striebel 1965) of a rate whose derivative is a random walk, with sizes of walk and noise by
// maximum likelihood. A noisy regressor makes a coefficient too small by the noise's share of its
// variance; its expectation does not (regression calibration, Carroll et al., Measurement Error in
// Nonlinear Models, 2006, chapter 4).
class SmoothedRate {
 public:
  /// Readings in order of time; those without any time between them are left out.
  explicit SmoothedRate(const std::vector<RateReading>& readings);

  /// Rate and its derivative [1/s]; before the first and after the last reading those of that one.
  [[nodiscard]] Eigen::Vector2d at(std::int64_t t_ns) const;

 private:
  std::vector<std::int64_t> t_ns_;
  std::vector<Eigen::Vector2d> state_;
};

}  // namespace roadbook
