#include "diagnosis/columns.hpp"

#include <algorithm>

#include "diagnosis/motion_prediction.hpp"

namespace roadbook {

Columns effect_columns(const Observations& obs,
                       const MotionPoint& point,
                       const std::vector<std::size_t>& effects) {
  Columns columns;
  columns.count = effects.size();
  const std::size_t rows = obs.offsets().back();
  columns.values.assign(rows * std::max<std::size_t>(columns.count, 1), 0.0);
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const MotionEffect& effect = motion_effects()[effects[k]];
    const double step = 0.02 * declaration_of(effect.name).plausible;
    MotionEffects less = point.effects;
    MotionEffects more = point.effects;
    effect.size(less) -= step;
    effect.size(more) += step;
    std::vector<double> change = predict_rows(obs, point.trajectory, more, effect.streams);
    const std::vector<double> low = predict_rows(obs, point.trajectory, less, effect.streams);
    for (std::size_t i = 0; i < rows; ++i) change[i] = (change[i] - low[i]) / (2.0 * step);
    if ((effect.streams & kPoses) != 0)
      turn_pose_rows(obs, point.trajectory, point.effects, change);
    for (std::size_t i = 0; i < rows; ++i) columns.values[i * columns.count + k] = change[i];
  }
  return columns;
}

Columns joined(const Columns& a, const Columns& b, std::size_t rows) {
  Columns both;
  both.count = a.count + b.count;
  both.values.resize(rows * std::max<std::size_t>(both.count, 1));
  for (std::size_t i = 0; i < rows; ++i) {
    std::copy_n(a.row(i), a.count, both.values.data() + i * both.count);
    std::copy_n(b.row(i), b.count, both.values.data() + i * both.count + a.count);
  }
  return both;
}

}  // namespace roadbook
