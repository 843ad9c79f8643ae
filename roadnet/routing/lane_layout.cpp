#include "roadnet/routing/lane_layout.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "roadnet/routing/route_states.hpp"

namespace roadbook {
namespace {

constexpr double kMostOfLane = 0.4;  // that a cut takes at one end

LanePiece piece_of(const RoadNetwork& network, int index, const LanePath& path, double cut_m) {
  const Lane& lane = network.lanes[static_cast<std::size_t>(index)];
  const bool turned = lane.forward_passes == 0 && lane.backward_passes > 0;
  LanePiece piece{index, lane.id, PathCurve(turned ? reversed(path.path) : path.path), turned};
  piece.both_ways = lane.forward_passes == 0 || lane.backward_passes == 0
                        ? lane.forward_passes == lane.backward_passes
                        : true;
  piece.width_m = path.width_m;
  const double length = piece.curve.length_m();
  const double cut = std::min(cut_m, kMostOfLane * length);
  const bool joined_first = !lane.closed && lane.from_intersection >= 0;
  const bool joined_last = !lane.closed && lane.to_intersection >= 0;
  piece.s_begin_m = (turned ? joined_last : joined_first) ? cut : 0.0;
  piece.s_end_m = length - ((turned ? joined_first : joined_last) ? cut : 0.0);
  return piece;
}

// The place where traffic leaves a piece at one of its ends, looking out of the piece.
PathPoint leaving(const LanePiece& piece, bool at_end) {
  PathPoint p = piece.curve.at(at_end ? piece.s_end_m : piece.s_begin_m);
  if (at_end) return p;
  p.tangent = -p.tangent;
  p.curvature = -p.curvature;
  return p;
}

PathPoint turned_round(PathPoint p) {
  p.tangent = -p.tangent;
  p.curvature = -p.curvature;
  return p;
}

struct EndLess {
  bool operator()(const PieceEnd& a, const PieceEnd& b) const {
    return a.piece != b.piece ? a.piece < b.piece : a.at_end < b.at_end;
  }
};

// Turns that traffic makes at one intersection: ends between which it goes, with direction.
using Turn = std::pair<PieceEnd, PieceEnd>;
struct TurnLess {
  bool operator()(const Turn& a, const Turn& b) const {
    const EndLess less;
    if (less(a.first, b.first) || less(b.first, a.first)) return less(a.first, b.first);
    return less(a.second, b.second);
  }
};

}  // namespace

PathCurve connecting_curve(const PathPoint& from, const PathPoint& to) {
  const double chord = (to.position - from.position).norm();
  const double turn = std::acos(std::clamp(from.tangent.dot(to.tangent), -1.0, 1.0));
  // Length of an arc with this chord and turn: the speed with which both ends are left.
  const double half = 0.5 * std::min(turn, 2.5);
  const double h = chord * (half > 1e-6 ? half / std::sin(half) : 1.0);
  const Eigen::Vector2d a1 = from.position + h / 5.0 * from.tangent;
  const Eigen::Vector2d b1 = to.position - h / 5.0 * to.tangent;
  const Eigen::Vector2d a2 = 2.0 * a1 - from.position + h * h / 20.0 * from.curvature * from.left();
  const Eigen::Vector2d b2 = 2.0 * b1 - to.position + h * h / 20.0 * to.curvature * to.left();
  BezierPath path;
  path.degree = 5;
  path.knots = {0.0, 1.0};
  int k = 0;
  for (const Eigen::Vector2d& p : {from.position, a1, a2, b2, b1, to.position}) {
    const double height = from.height_m + (to.height_m - from.height_m) * k++ / 5.0;
    path.points.emplace_back(p.x(), p.y(), height);
  }
  return PathCurve(path);
}

LaneLayout lay_out(const RoadNetwork& network,
                   const std::vector<LanePath>& paths,
                   const LaneLayoutOptions& options) {
  LaneLayout layout;
  std::map<std::uint64_t, const LanePath*> path_of;
  for (const LanePath& path : paths) path_of[path.lane] = &path;
  std::vector<int> piece_of_lane(network.lanes.size(), -1);
  for (std::size_t l = 0; l < network.lanes.size(); ++l) {
    const auto found = path_of.find(network.lanes[l].id);
    if (found == path_of.end() || found->second->status == LanePathStatus::kDegenerate) continue;
    piece_of_lane[l] = static_cast<int>(layout.pieces.size());
    layout.pieces.push_back(piece_of(network, static_cast<int>(l), *found->second, options.cut_m));
  }

  RoutingOptions routing = options.routing;
  routing.allow_reverse = false;
  const auto states = lane_states(network, routing);
  std::map<Turn, int, TurnLess> turns;  // to the intersection
  for (const LaneState& a : states) {
    const int from = piece_of_lane[static_cast<std::size_t>(a.lane)];
    if (from < 0 || a.ends_dead || network.lanes[static_cast<std::size_t>(a.lane)].closed) continue;
    for (const LaneState& b : states) {
      const int to = piece_of_lane[static_cast<std::size_t>(b.lane)];
      if (to < 0 || !transition_cost(a, b, routing)) continue;
      const bool a_end = a.along != layout.pieces[static_cast<std::size_t>(from)].turned;
      const bool b_end = b.along == layout.pieces[static_cast<std::size_t>(to)].turned;
      turns[{{from, a_end}, {to, b_end}}] = a.leaves;
    }
  }
  for (const auto& [turn, intersection] : turns) {
    const Turn back{turn.second, turn.first};
    const bool both = turns.contains(back);
    if (both && TurnLess{}(back, turn)) continue;  // the other one stands for both
    const LanePiece& from = layout.pieces[static_cast<std::size_t>(turn.first.piece)];
    const LanePiece& to = layout.pieces[static_cast<std::size_t>(turn.second.piece)];
    layout.connectors.push_back({intersection, turn.first, turn.second, both,
                                 connecting_curve(leaving(from, turn.first.at_end),
                                                  turned_round(leaving(to, turn.second.at_end))),
                                 std::min(from.width_m, to.width_m)});
  }
  std::stable_sort(
      layout.connectors.begin(), layout.connectors.end(),
      [](const Connector& a, const Connector& b) { return a.intersection < b.intersection; });
  return layout;
}

}  // namespace roadbook
