#include "mapping/sessions/thinned_map.hpp"

#include <cmath>
#include <optional>

#include "base/index.hpp"
#include "base/se3.hpp"

namespace roadbook {
namespace {

// The second motion after the first, with first-order covariance.
PlanarMotion joined_motion(const PlanarMotion& a, const PlanarMotion& b) {
  const double c = std::cos(a.motion.z());
  const double s = std::sin(a.motion.z());
  Eigen::Matrix3d J_b;
  J_b << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  PlanarMotion joined;
  joined.motion = a.motion + J_b * b.motion;
  Eigen::Matrix3d J_a = Eigen::Matrix3d::Identity();
  J_a(0, 2) = a.motion.y() - joined.motion.y();
  J_a(1, 2) = joined.motion.x() - a.motion.x();
  joined.covariance = J_a * a.covariance * J_a.transpose() + J_b * b.covariance * J_b.transpose();
  joined.distance_m = a.distance_m + b.distance_m;
  joined.reversing = joined.motion.x() < 0.0;
  return joined;
}

}  // namespace

ThinnedMap thinned_map(const Map& map, std::size_t step) {
  ThinnedMap thinned;
  thinned.map = map;
  thinned.map.corners.clear();
  if (step > 1) thinned.map.keyframes.clear();
  std::size_t since = 0;
  std::optional<PlanarMotion> wheels;  // since the last one kept
  std::vector<char> is_kept(map.keyframes.size(), 1);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (step <= 1) {
      thinned.now.push_back(static_cast<int>(k));
      continue;
    }
    Keyframe keyframe = map.keyframes[k];
    const bool is_first = k == 0 || keyframe.after_gap ||
                          map.keyframes[k - 1].session != keyframe.session ||
                          map.keyframes[k - 1].piece != keyframe.piece;
    if (!is_first && since > 0 && keyframe.wheels && wheels)
      wheels = joined_motion(*wheels, *keyframe.wheels);
    else
      wheels = is_first || since == 0 ? keyframe.wheels : std::nullopt;
    is_kept[k] = is_first || ++since == step ? 1 : 0;
    if (is_kept[k] != 0) {
      keyframe.wheels = wheels;
      thinned.map.keyframes.push_back(keyframe);
      since = 0;
    }
    thinned.now.push_back(static_cast<int>(thinned.map.keyframes.size()) - 1);
  }
  std::erase_if(thinned.map.observations,
                [&](const Observation& o) { return is_kept[at(o.keyframe)] == 0; });
  for (Observation& o : thinned.map.observations) o.keyframe = thinned.now[at(o.keyframe)];
  // A loop gets the nearest keyframes that stay. Their motions to its ends are those of the map.
  for (LoopEdge& loop : thinned.map.loops) {
    const int from = thinned.now[at(loop.from)];
    const int to = thinned.now[at(loop.to)];
    const Eigen::Isometry3d T_to_now =
        map.T_map_vehicle(loop.to).inverse() * thinned.map.T_map_vehicle(to);
    loop.T_from_to = thinned.map.T_map_vehicle(from).inverse() * map.T_map_vehicle(loop.from) *
                     loop.T_from_to * T_to_now;
    const Matrix6d A = se3_adjoint(T_to_now);
    loop.information = A.transpose() * loop.information * A;
    loop.from = from;
    loop.to = to;
  }
  return thinned;
}

}  // namespace roadbook
