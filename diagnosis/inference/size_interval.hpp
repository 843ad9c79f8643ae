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

/// Of an estimate with this standard error, within what the effect's size can be: of shares (0 to
/// 1) taken on the logistic scale (the delta method), of others cut at the bounds. Where the
/// estimate is at a bound or beyond (a difference to a known size), or nothing is declared of the
/// effect, `size` -+ `kSigmas95` `sigma`.
[[nodiscard]] SizeInterval interval95(std::string_view effect, double size, double sigma);

}  // namespace roadbook
