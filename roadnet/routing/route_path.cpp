#include "roadnet/routing/route_path.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kSearch_m = 0.1;  // between the places of a path tried for one of its lane

// A leg on its piece: stretch of the curve, and whether it is driven as the curve runs.
struct PieceLeg {
  int piece = -1;
  bool along = true;
  double from_m = 0.0;
  double to_m = 0.0;
};

double nearest_s(const PathCurve& curve, const Eigen::Vector3d& p) {
  const int steps = std::max(1, static_cast<int>(std::ceil(curve.length_m() / kSearch_m)));
  double best = 0.0;
  double best2 = std::numeric_limits<double>::max();
  for (int i = 0; i <= steps; ++i) {
    const double s = curve.length_m() * i / steps;
    const double d2 = (curve.at(s).position - p.head<2>()).squaredNorm();
    if (d2 < best2) best = s;
    best2 = std::min(best2, d2);
  }
  return best;
}

// Where a leg over the whole of a piece begins (driven backwards: ends).
double on_curve_begin(const LanePiece& piece, bool along) {
  return along ? piece.s_begin_m : piece.s_end_m;
}

class Builder {
 public:
  explicit Builder(double step_m) : step_m_(step_m) {}

  void add(const PathCurve& curve,
           double from_m,
           double to_m,
           double width_m,
           std::uint64_t lane,
           bool turn) {
    const double length = std::abs(to_m - from_m);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / step_m_)));
    for (int i = path.points.empty() ? 0 : 1; i <= steps; ++i) {
      RoutePoint point;
      point.s_m = done_ + length * i / steps;
      point.at = curve.at(from_m + (to_m - from_m) * i / steps);
      if (to_m < from_m) {
        point.at.tangent = -point.at.tangent;
        point.at.curvature = -point.at.curvature;
      }
      point.width_m = width_m;
      point.lane = lane;
      point.turn = turn;
      path.points.push_back(point);
    }
    done_ += length;
  }

  RoutePath path;

 private:
  double step_m_;
  double done_ = 0.0;
};

const Connector* connector(const LaneLayout& layout,
                           const PieceLeg& a,
                           const PieceLeg& b,
                           bool& backwards) {
  const auto same = [](const PieceEnd& end, int piece, bool at_end) {
    return end.piece == piece && end.at_end == at_end;
  };
  for (const Connector& c : layout.connectors) {
    backwards = false;
    if (same(c.from, a.piece, a.along) && same(c.to, b.piece, !b.along)) return &c;
    backwards = true;
    if (c.both_ways && same(c.to, a.piece, a.along) && same(c.from, b.piece, !b.along)) return &c;
  }
  return nullptr;
}

}  // namespace

RoutePath route_path(const RoadNetwork& network,
                     const LaneLayout& layout,
                     const Route& route,
                     double step_m) {
  RoutePath none;
  if (route.status != RouteStatus::kFound) {
    none.reason = to_text(route.status);
    return none;
  }
  std::vector<PieceLeg> legs;
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    const RouteLeg& leg = route.legs[i];
    if (leg.gear == Gear::kReverse) {
      none.reason = "lane " + std::to_string(leg.id) + " is driven in reverse gear";
      return none;
    }
    const auto piece = std::find_if(layout.pieces.begin(), layout.pieces.end(),
                                    [&](const LanePiece& p) { return p.lane == leg.lane; });
    if (piece == layout.pieces.end()) {
      none.reason = "lane " + std::to_string(leg.id) + " has no path";
      return none;
    }
    const Lane& lane = network.lanes[static_cast<std::size_t>(leg.lane)];
    PieceLeg on{static_cast<int>(piece - layout.pieces.begin()), leg.along != piece->turned,
                on_curve_begin(*piece, leg.along != piece->turned),
                on_curve_begin(*piece, leg.along == piece->turned)};
    // A place so near an intersection that turns pass over it is moved to where they end.
    const auto on_piece = [&](double s_m) {
      return std::clamp(nearest_s(piece->curve, lane_spot(lane, s_m).position), piece->s_begin_m,
                        piece->s_end_m);
    };
    if (i == 0) on.from_m = on_piece(leg.from_s_m);
    if (i + 1 == route.legs.size()) on.to_m = on_piece(leg.to_s_m);
    legs.push_back(on);
  }
  Builder builder(step_m);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const LanePiece& piece = layout.pieces[static_cast<std::size_t>(legs[i].piece)];
    builder.add(piece.curve, legs[i].from_m, legs[i].to_m, piece.width_m, piece.id, false);
    if (i + 1 == legs.size()) break;
    if (piece.curve.closed() && legs[i + 1].piece == legs[i].piece) continue;  // over the seam
    bool backwards = false;
    const Connector* turn = connector(layout, legs[i], legs[i + 1], backwards);
    if (turn == nullptr) {
      none.reason = "it turns round at the end of lane " + std::to_string(piece.id);
      return none;
    }
    const double length = turn->curve.length_m();
    builder.add(turn->curve, backwards ? length : 0.0, backwards ? 0.0 : length, turn->width_m,
                piece.id, true);
  }
  return std::move(builder.path);
}

}  // namespace roadbook
