#include "vo/keyframe_spacing.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kRounding = 1e-6;  // of the way: logged angles are rounded

}  // namespace

double KeyframeSpacing::progress(double distance_m, double turn_rad) const {
  const double progress =
      std::max(distance_m / (spacing_m_ + carried_m_), std::abs(turn_rad) / turn_rad_);
  return std::abs(progress - 1.0) < kRounding ? 1.0 : progress;
}

void KeyframeSpacing::taken(double distance_m, double turn_rad, bool had_choice) {
  const double wanted_m = spacing_m_ + carried_m_;
  // A turn makes keyframes denser than the spacing: that is no debt of the spacing.
  const bool by_turn = std::abs(turn_rad) / turn_rad_ > distance_m / wanted_m;
  carried_m_ = by_turn || (!had_choice && distance_m > wanted_m)
                   ? 0.0
                   : std::clamp(wanted_m - distance_m, -0.25 * spacing_m_, 0.25 * spacing_m_);
}

}  // namespace roadbook
