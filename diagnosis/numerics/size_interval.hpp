#pragma once

#include <string_view>

namespace roadbook {

/// Half of a 95 % interval, in standard deviations.
inline constexpr double kSigmas95 = 1.96;

/// A 95 % interval.
struct SizeInterval {
  double low = 0.0;
  double high = 0.0;
};

/// 95 % interval of an estimated effect size, in the effect's unit. `sigma`: standard error of
/// `size`. The interval stays within the declared bounds of `effect`: shares (bounds 0 and 1) are
/// transformed to the logistic scale (delta method), other sizes are cut at the bounds. It is
/// `size` -+ `kSigmas95` `sigma` if the effect is not declared, or if `size` is at a bound or
/// outside (as the difference to a known size can be).
[[nodiscard]] SizeInterval interval95(std::string_view effect, double size, double sigma);

}  // namespace roadbook
