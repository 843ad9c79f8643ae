#include "diagnosis/numerics/size_interval.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/effects.hpp"

namespace roadbook {
namespace {

bool is_share(const EffectInfo& info) { return info.lowest == 0.0 && info.highest == 1.0; }

}  // namespace

SizeInterval interval95(std::string_view effect, double size, double sigma) {
  const double half = kSigmas95 * sigma;
  const auto info = declared_effect(effect);
  if (!info || size <= info->lowest || size >= info->highest) return {size - half, size + half};
  const double above = size - info->lowest;
  const double below = info->highest - size;
  if (!is_share(*info))
    return {std::max(size - half, info->lowest), std::min(size + half, info->highest)};
  const double width = above + below;
  const double at = std::log(above / below);
  const double reach = half * width / (above * below);
  const auto back = [&](double u) { return info->lowest + width / (1.0 + std::exp(-u)); };
  return {back(at - reach), back(at + reach)};
}

}  // namespace roadbook
