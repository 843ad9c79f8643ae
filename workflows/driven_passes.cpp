#include "workflows/driven_passes.hpp"

namespace roadbook {

std::vector<DrivenPass> driven_passes(const Map& map) {
  std::vector<DrivenPass> passes;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    const bool apart =
        i == 0 || keyframe.session != map.keyframes[i - 1].session || keyframe.after_gap;
    const bool turned = !apart && keyframe.reversing != map.keyframes[i - 1].reversing;
    if (apart || turned) passes.push_back({keyframe.session, keyframe.reversing, {}});
    if (turned)
      passes.back().positions.push_back(map.T_map_vehicle(static_cast<int>(i) - 1).translation());
    passes.back().positions.push_back(map.T_map_vehicle(static_cast<int>(i)).translation());
  }
  return passes;
}

double driven_length_m(const std::vector<DrivenPass>& passes) {
  double length_m = 0.0;
  for (const DrivenPass& pass : passes)
    for (std::size_t i = 1; i < pass.positions.size(); ++i)
      length_m += (pass.positions[i] - pass.positions[i - 1]).norm();
  return length_m;
}

}  // namespace roadbook
