#include "exchange/export/planner/planner_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "exchange/layers/friction_layers.hpp"
#include "semantics/labels/label_layers.hpp"

namespace roadbook {
namespace {

// Profiles of a map without speeds: what bends and the default limit allow, one a lane with path.
std::vector<LaneProfile> profiles_of_bends(const StoredPaths& stored,
                                           const LaneSpeedOptions& options) {
  std::vector<LaneProfile> profiles;
  for (const LanePath& path : stored.paths) {
    if (path.status == LanePathStatus::kDegenerate) continue;
    const PathCurve curve(path.path);
    const auto s = even_places(curve, options.step_m);
    LaneProfile profile{path.lane, s[1] - s[0], curve.closed(), -1, -1, {}};
    for (const Lane& lane : stored.network.lanes)
      if (lane.id == path.lane) {
        profile.from_intersection = lane.from_intersection;
        profile.to_intersection = lane.to_intersection;
      }
    profile.places =
        speed_limits_along(way_points(curve, s), s, options.max_speed, {}, {}, options);
    make_feasible(profile.places, profile.step_m, profile.closed, options);
    profiles.push_back(std::move(profile));
  }
  agree_at_intersections(profiles, options);
  return profiles;
}

// Friction under the point of a way, the lowest of all lanes that it lies on.
FrictionAt friction_along(const FrictionMap& friction,
                          const std::vector<WayPoint>& way,
                          double step_m) {
  return [&friction, &way, step_m](double s_m, double e_m) -> std::optional<PropertyMoments> {
    const auto i = std::min(static_cast<std::size_t>(std::lround(s_m / step_m)), way.size() - 1);
    std::vector<PathPlace> places;
    friction.strips.places_of(way[i].position + e_m * way[i].left, places);
    std::optional<PropertyMoments> lowest;
    for (const PathPlace& place : places)
      if (const auto moments = friction.map.moments(0, place);
          moments && (!lowest || moments->mean < lowest->mean))
        lowest = moments;
    return lowest;
  };
}

std::vector<Eigen::Vector3d> ring_of(const Feature& feature) {
  std::vector<Eigen::Vector3d> ring;
  for (const Eigen::Vector4d& p : feature.points) ring.emplace_back(p.head<3>());
  if (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  return ring;
}

// The label's id, or the number of the feature without an id.
std::string id_of(const VectorLayer& layer, std::size_t index) {
  const auto column = layer.field("space");
  if (column && std::holds_alternative<std::int64_t>(layer.features[index].values[*column]))
    return std::to_string(std::get<std::int64_t>(layer.features[index].values[*column]));
  return std::to_string(index);
}

bool is_of_class(const VectorLayer& layer, std::size_t index, const std::string& kind) {
  const auto column = layer.field("class");
  const auto& values = layer.features[index].values;
  return column && std::holds_alternative<std::string>(values[*column]) &&
         std::get<std::string>(values[*column]) == kind;
}

// Place on a curve nearest to a point, at most `reach_m` from `around_m` along the curve: a lane
// may pass the same point twice.
double nearest_on(const PathCurve& curve,
                  const Eigen::Vector2d& point,
                  double around_m,
                  double reach_m) {
  constexpr int kRounds = 60;
  constexpr double kStep_m = 0.25;
  const auto at = [&](double s) {
    return curve.closed() ? s - curve.length_m() * std::floor(s / curve.length_m())
                          : std::clamp(s, 0.0, curve.length_m());
  };
  const auto distance = [&](double s) { return (curve.at(at(s)).position - point).norm(); };
  double best = around_m;
  for (double s = around_m - reach_m; s <= around_m + reach_m; s += kStep_m)
    if (distance(s) < distance(best)) best = s;
  double low = best - kStep_m;
  double high = best + kStep_m;
  for (int i = 0; i < kRounds; ++i) {
    const double third = (high - low) / 3.0;
    (distance(low + third) < distance(high - third) ? high : low) =
        distance(low + third) < distance(high - third) ? high - third : low + third;
  }
  return at(0.5 * (low + high));
}

}  // namespace

PlannerMap::PlannerMap(const std::filesystem::path& map) : stored_(load_paths(map)) {
  layout_ = lay_out(stored_.network, stored_.paths);
  const MapLayers layers(map);
  set_profiles(layers);
  read_places(layers);
}

void PlannerMap::set_profiles(const MapLayers& layers) {
  auto speeds = read_current_speeds(layers, stored_.paths);
  speeds_known_ = speeds.has_value();
  if (speeds) options_ = speeds->options;
  std::map<std::uint64_t, LaneProfile> of_lane;
  for (LaneProfile& profile : speeds ? speeds->profiles : profiles_of_bends(stored_, options_))
    of_lane[profile.lane] = std::move(profile);
  for (const LanePiece& piece : layout_.pieces) profiles_.push_back(of_lane.at(piece.id));
  set_turn_speeds(layers, speeds ? &*speeds : nullptr);
}

double PlannerMap::least_speed(int piece, double from_m, double to_m) const {
  const LanePiece& lane = layout_.pieces[static_cast<std::size_t>(piece)];
  const LaneProfile& profile = profiles_[static_cast<std::size_t>(piece)];
  const double length = lane.curve.length_m();
  if (lane.turned) {
    std::swap(from_m, to_m);
    from_m = length - from_m;
    to_m = length - to_m;
  }
  double least = std::min(profile.speed_at(from_m), profile.speed_at(to_m));
  for (double k = std::ceil(from_m / profile.step_m); k * profile.step_m < to_m; k += 1.0)
    least = std::min(least, profile.speed_at(k * profile.step_m));
  return least;
}

std::vector<SpeedPiece> PlannerMap::lane_speeds(int piece, const SpeedPieceOptions& options) const {
  const LanePiece& lane = layout_.pieces[static_cast<std::size_t>(piece)];
  return speed_pieces(
      [this, piece](double from_m, double to_m) { return least_speed(piece, from_m, to_m); },
      lane.s_begin_m, lane.s_end_m, options);
}

bool PlannerMap::returns_to_its_start(int piece) const {
  const LanePiece& lane = layout_.pieces[static_cast<std::size_t>(piece)];
  const Lane& driven = stored_.network.lanes[static_cast<std::size_t>(lane.lane)];
  return lane.curve.closed() ||
         (driven.from_intersection >= 0 && driven.from_intersection == driven.to_intersection);
}

double PlannerMap::turn_speed(int connector) const {
  return turn_speeds_[static_cast<std::size_t>(connector)];
}

// Of the lane between its cut and the intersection.
double PlannerMap::cut_off_speed(const PieceEnd& end) const {
  const LanePiece& lane = layout_.pieces[static_cast<std::size_t>(end.piece)];
  return end.at_end ? least_speed(end.piece, lane.s_end_m, lane.curve.length_m())
                    : least_speed(end.piece, 0.0, lane.s_begin_m);
}

void PlannerMap::set_turn_speeds(const MapLayers& layers, const SpeedMap* speeds) {
  const auto friction = read_friction_layers(layers, stored_.paths);
  const PresenceAt presence = speeds != nullptr ? presence_of(*speeds) : PresenceAt();
  for (const Connector& turn : layout_.connectors) {
    double speed = std::min(cut_off_speed(turn.from), cut_off_speed(turn.to));
    const auto s = even_places(turn.curve, options_.step_m);
    const auto way = way_points(turn.curve, s);
    const FrictionAt grip =
        speeds != nullptr && friction ? friction_along(*friction, way, s[1] - s[0]) : FrictionAt();
    for (const LaneSpeed& place :
         speed_limits_along(way, s, options_.max_speed, presence, grip, options_))
      speed = std::min(speed, place.speed);
    turn_speeds_.push_back(speed);
  }
}

std::optional<SpaceLink> PlannerMap::link_of(const SpacePlace& space, std::string& why) const {
  const LaneLink found = link_spaces(stored_.network, {space}).front();
  if (found.status != LinkStatus::kLinked) {
    why = found.reason;
    return std::nullopt;
  }
  for (std::size_t i = 0; i < layout_.pieces.size(); ++i) {
    const LanePiece& piece = layout_.pieces[i];
    if (piece.id != found.lane) continue;
    // The link's place on the lane's polyline, as a share of its length.
    const double share =
        found.place.s_m / stored_.network.lanes[static_cast<std::size_t>(piece.lane)].length_m;
    const double length_m = piece.curve.length_m();
    const double around_m = length_m * (piece.turned ? 1.0 - share : share);
    // Reach: the polyline differs from the path, and the link lies before the open side rather than
    // nearest to it.
    const Eigen::Vector2d front = space.front.head<2>();
    SpaceLink link{found.lane, static_cast<int>(i),
                   nearest_on(piece.curve, front, around_m,
                              2.0 + 0.3 * found.place.distance_m + 0.01 * length_m)};
    link.left = piece.turned ? !found.left : found.left;
    link.distance_m = (front - piece.curve.at(link.s_m).position).norm();
    return link;
  }
  why = "its lane has no path";
  return std::nullopt;
}

void PlannerMap::read_places(const MapLayers& layers) {
  const auto today = label_layers_of_today(layers);
  const auto each = [&](const char* name, const auto& visit) {
    if (const auto layer = layer_of_today(layers, today, name))
      for (std::size_t i = 0; i < layer->features.size(); ++i) visit(*layer, i);
  };
  each("parking_spaces", [&](const VectorLayer& layer, std::size_t i) {
    PlannerSpace space{id_of(layer, i), ring_of(layer.features[i])};
    space.rectangle = space.corners.size() == 4;
    if (space.rectangle) {
      space.corners = corners_with_open_side_first(space.corners, stored_.network);
      space.link = link_of(space_place(0, space.corners), space.no_link);
    } else {
      space.no_link = "it is no rectangle";
    }
    spaces_.push_back(std::move(space));
  });
  each("crossings", [&](const VectorLayer& layer, std::size_t i) {
    crossings_.push_back({id_of(layer, i), ring_of(layer.features[i])});
  });
  each("other_labels", [&](const VectorLayer& layer, std::size_t i) {
    if (is_of_class(layer, i, "parking_space"))
      spaces_.push_back(
          {id_of(layer, i), ring_of(layer.features[i]), false, std::nullopt, "it is no rectangle"});
    else
      ++other_labels_;
  });
}

}  // namespace roadbook
