#include "exchange/layers/friction_carry.hpp"

#include <algorithm>
#include <cmath>

#include "roadnet/spatial_hash.hpp"

namespace roadbook {

Eigen::Vector2d ground_position(const LaneStrips::Strip& strip, const PathPlace& place) {
  const PathPoint at =
      strip.frame.curve().at(std::clamp(place.s_m - strip.begin_m, 0.0, strip.length_m()));
  return at.position + place.e_m * at.left();
}

void anchor_knots(const Map& map, FrictionMap& friction) {
  constexpr double kNear_m = 20.0;
  SpatialHash keyframes(kNear_m);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    keyframes.insert(map.T_map_vehicle(static_cast<int>(i)).translation());
  friction.anchors.clear();
  for (const PathPlace& place : friction.map.knots().places()) {
    const LaneStrips::Strip& strip = friction.strips.strip_of(place);
    const Eigen::Vector2d p = ground_position(strip, place);
    const double s = std::clamp(place.s_m - strip.begin_m, 0.0, strip.length_m());
    const Eigen::Vector3d at(p.x(), p.y(), strip.frame.curve().at(s).height_m);
    const int nearest = keyframes.nearest(at, kNear_m);
    if (nearest < 0) {
      friction.anchors.emplace_back();
      continue;
    }
    const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(nearest)];
    friction.anchors.push_back({map.sessions[static_cast<std::size_t>(keyframe.session)].name,
                                keyframe.t_ns,
                                (map.T_map_vehicle(nearest).inverse() * at).head<2>()});
  }
}

KnotCarrier::KnotCarrier(const Map& map, const LaneStrips& strips, double reach_m)
    : strips_(strips), reach_m_(reach_m) {
  for (std::size_t i = 0; i < map.sessions.size(); ++i)
    tracks_.emplace_back(map.sessions[i].name, SessionTrack(map, static_cast<int>(i)));
  for (const LaneStrips::Strip& strip : strips.strips()) {
    const double half = strip.half_width_m + reach_m;
    wide_.emplace_back(strip.frame.curve(), Tube{-half, half});
  }
}

std::optional<Eigen::Vector2d> KnotCarrier::ground_of(const KnotAnchor& anchor) const {
  for (const auto& [name, track] : tracks_) {
    if (name != anchor.session) continue;
    if (const auto T = track.at(anchor.t_ns))
      return (*T * Eigen::Vector3d(anchor.at.x(), anchor.at.y(), 0.0)).head<2>();
  }
  return std::nullopt;
}

std::optional<PathPlace> KnotCarrier::on_strip(std::size_t i, const Eigen::Vector2d& p) const {
  const LaneStrips::Strip& strip = strips_.strips()[i];
  for (const PathFrame* const frame : {&strip.frame, &wide_[i]})
    if (const PathProjection at = frame->project(p); at.inside())
      return PathPlace{strip.begin_m + at.s_m, at.e_m};
  if (strip.frame.curve().closed()) return std::nullopt;
  for (const double end : {0.0, strip.length_m()}) {
    const PathPoint at = strip.frame.curve().at(end);
    const Eigen::Vector2d offset = p - at.position;
    const double e = offset.dot(at.left());
    const double beyond = std::sqrt(std::max(0.0, offset.squaredNorm() - e * e));
    if (beyond <= reach_m_ && std::abs(e) <= strip.half_width_m + reach_m_)
      return PathPlace{strip.begin_m + end, e};
  }
  return std::nullopt;
}

std::optional<PathPlace> KnotCarrier::place_of(const StoredKnot& knot) const {
  const LaneStrips::Strip* const own = strips_.find(knot.lane);
  const auto p = ground_of(knot.anchor);
  if (!p) {
    if (own == nullptr) return std::nullopt;
    return PathPlace{own->begin_m + knot.s_share * own->length_m(), knot.e_m};
  }
  if (own != nullptr)
    if (const auto place = on_strip(static_cast<std::size_t>(own - strips_.strips().data()), *p))
      return place;
  // Its lane was divided, joined or is no more: the lane whose middle is nearest has the ground.
  std::optional<PathPlace> best;
  for (std::size_t i = 0; i < wide_.size(); ++i)
    if (const auto place = on_strip(i, *p);
        place && (!best || std::abs(place->e_m) < std::abs(best->e_m)))
      best = place;
  return best;
}

}  // namespace roadbook
