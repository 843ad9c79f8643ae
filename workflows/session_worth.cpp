#include "workflows/session_worth.hpp"

namespace roadbook {

std::vector<SessionValue> worth_of_sessions(const Map& map, const std::vector<Label>& labels) {
  std::vector<AnchoredPoint> points;
  for (const Label& label : labels) {
    if (!is_on_ground(label)) continue;
    const auto keyframe = nearest_keyframe_of(map, label.anchor);
    const auto pose = vehicle_of(map, label.anchor);
    if (!keyframe || !pose) continue;
    points.push_back({*keyframe, map.T_map_vehicle(*keyframe).inverse() * pose->T_map_vehicle *
                                     middle_of(label)});
  }
  return session_values(map, points);
}

}  // namespace roadbook
