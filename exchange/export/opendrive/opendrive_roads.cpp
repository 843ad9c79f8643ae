#include "exchange/export/opendrive/opendrive_roads.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace roadbook {
namespace {

constexpr int kRingParts = 3;
constexpr int kLoopParts = 2;
constexpr double kShortestPiece_m = 5.0;  // of one speed limit
// Next to a turn; all of the first piece, and nothing of the second, lies within.
constexpr double kNextToTurn_m = 0.9 * kShortestPiece_m;
constexpr int kCutSearch = 60;          // places to either side that a cut is tried at
constexpr double kStraight = 1 / 16.0;  // [1/m] a left edge bent more is no place for a cut
constexpr double kLeastWidth_m = 1.81;  // SUMO closes lanes below 1.8 m for cars
constexpr double kMostBentWidth = 1.0;  // times the radius of the tightest bend

// Where SUMO's netconvert 1.15 cuts a road that is to be cut at s: it measures s along the left
// edge of the lane, scaled to the length of the road.
class CutPlaces {
 public:
  explicit CutPlaces(const DriveRoad& road) : begin_m_(road.begin_m) {
    const int steps = std::max(1, static_cast<int>(std::ceil(road.length_m() / 0.1)));
    step_m_ = road.length_m() / steps;
    edge_m_.push_back(0.0);
    const auto on_edge = [&](int i) -> Eigen::Vector2d {
      const PathPoint p = road.curve.at(begin_m_ + i * step_m_);
      return p.position + 0.5 * road.width_m * p.left();
    };
    for (int i = 0; i < steps; ++i)
      edge_m_.push_back(edge_m_.back() + (on_edge(i + 1) - on_edge(i)).norm());
  }

  [[nodiscard]] double of(double s_m) const {
    const double length = step_m_ * static_cast<double>(edge_m_.size() - 1);
    const double edge = (s_m - begin_m_) / length * edge_m_.back();
    const auto above = std::upper_bound(edge_m_.begin(), edge_m_.end(), edge) - edge_m_.begin();
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above, 1, static_cast<std::ptrdiff_t>(edge_m_.size()) - 1));
    const double part = (edge - edge_m_[i - 1]) / (edge_m_[i] - edge_m_[i - 1]);
    return begin_m_ + step_m_ * (static_cast<double>(i - 1) + std::clamp(part, 0.0, 1.0));
  }

 private:
  double begin_m_;
  double step_m_ = 0.0;
  std::vector<double> edge_m_;  // length of the left edge up to each step
};

// Whether the left edge of a road is nearly straight about a place.
bool is_straight(const DriveRoad& road, double s_m) {
  for (const double near_m : {-0.4, -0.2, 0.0, 0.2, 0.4}) {
    const double kappa = road.curve.at(s_m + near_m).curvature;
    if (std::abs(kappa) > kStraight * std::abs(1.0 - 0.5 * road.width_m * kappa)) return false;
  }
  return true;
}

class RoadBuilder {
 public:
  explicit RoadBuilder(const PlannerMap& planner) : planner_(planner), layout_(planner.layout()) {}

  DriveRoads build() {
    for (std::size_t i = 0; i < layout_.pieces.size(); ++i) add_lane(static_cast<int>(i));
    for (std::size_t i = 0; i < layout_.connectors.size(); ++i) add_turns(static_cast<int>(i));
    for (DriveRoad& road : all_.roads)
      if (road.piece >= 0) set_speeds(road);
    return std::move(all_);
  }

 private:
  void add_lane(int index) {
    const LanePiece& piece = layout_.pieces[static_cast<std::size_t>(index)];
    const int parts = piece.curve.closed()                   ? kRingParts
                      : planner_.returns_to_its_start(index) ? kLoopParts
                                                             : 1;
    const double width = lane_width(piece);
    const std::vector<double> cuts = part_ends(piece, parts);
    first_road_.push_back(number());
    for (int way = 0; way < (piece.both_ways ? 2 : 1); ++way) {
      const bool backward = way == 1;
      const double length = piece.curve.length_m();
      const int first = number();
      for (int k = 0; k < parts; ++k) {
        const int from = backward ? parts - k : k;
        const int to = backward ? from - 1 : from + 1;
        const auto on_curve = [&](int cut) {
          const double s = cuts[static_cast<std::size_t>(cut)];
          return backward ? length - s : s;
        };
        DriveRoad road{backward ? PathCurve(reversed(piece.curve.bezier())) : piece.curve,
                       on_curve(from), on_curve(to), width};
        if (k > 0) road.before.road = number() - 1;
        if (k + 1 < parts) road.after.road = number() + 1;
        if (piece.curve.closed() && k == 0) road.before.road = first + parts - 1;
        if (piece.curve.closed() && k + 1 == parts) road.after.road = first;
        road.piece = index;
        road.backward = backward;
        road.part = k;
        road.parts = parts;
        all_.roads.push_back(std::move(road));
      }
    }
  }

  // Begin, cuts and end of a piece in parts of about one length, cut where it is straightest.
  static std::vector<double> part_ends(const LanePiece& piece, int parts) {
    const double part = piece.length_m() / parts;
    const auto straightest = [&](double middle, double reach) {
      double best = middle;
      for (int i = -kCutSearch; i <= kCutSearch; ++i) {
        const double s = middle + reach * i / kCutSearch;
        if (std::abs(piece.curve.at(s).curvature) < std::abs(piece.curve.at(best).curvature) - 1e-3)
          best = s;
      }
      return best;
    };
    // The seam of a ring is moved, too: places count on over it.
    const double begin =
        piece.curve.closed() ? straightest(0.5 * part, 0.5 * part) : piece.s_begin_m;
    std::vector<double> ends{begin};
    for (int k = 1; k < parts; ++k) ends.push_back(straightest(begin + k * part, 0.25 * part));
    ends.push_back(begin + piece.length_m());
    return ends;
  }

  // Swept width, as far as the lane's bends have room for it.
  double lane_width(const LanePiece& piece) {
    const double bend =
        std::abs(curvature_peak(piece.curve, piece.s_begin_m, piece.s_end_m).curvature);
    const double room = bend > 0.0 ? kMostBentWidth / bend : INFINITY;
    all_.narrowed += piece.width_m > std::max(room, kLeastWidth_m) ? 1U : 0U;
    all_.widened += piece.width_m < kLeastWidth_m ? 1U : 0U;
    return std::max(std::min(piece.width_m, room), kLeastWidth_m);
  }

  void add_turns(int index) {
    const Connector& turn = layout_.connectors[static_cast<std::size_t>(index)];
    const int junction = junction_of(turn.intersection);
    meets_junction(turn.from, junction);
    meets_junction(turn.to, junction);
    for (int way = 0; way < (turn.both_ways ? 2 : 1); ++way) {
      const bool backward = way == 1;
      const PieceEnd& from = backward ? turn.to : turn.from;
      const PieceEnd& to = backward ? turn.from : turn.to;
      const double speed = planner_.turn_speed(index);
      const double length = turn.curve.length_m();
      DriveRoad road{backward ? PathCurve(reversed(turn.curve.bezier())) : turn.curve, 0.0, length,
                     turn.width_m};
      road.before.road = departing(from);
      road.after.road = entered(to);
      road.speeds = {{0.0, length, speed}};
      road.connector = index;
      road.backward = backward;
      road.junction = junction;
      const auto lower = [speed](double& limit) { limit = std::min(limit, speed); };
      lower(at_end_.try_emplace(road.before.road, INFINITY).first->second);
      lower(at_begin_.try_emplace(road.after.road, INFINITY).first->second);
      all_.junctions[static_cast<std::size_t>(junction)].turns.push_back(number());
      all_.roads.push_back(std::move(road));
    }
  }

  int junction_of(int intersection) {
    const auto [entry, added] =
        junction_.try_emplace(intersection, static_cast<int>(all_.junctions.size()));
    if (added) all_.junctions.push_back({intersection, {}});
    return entry->second;
  }

  // Both roads of a pair lead to the junction, also where one of them has no turn there.
  void meets_junction(const PieceEnd& end, int junction) {
    const bool both = layout_.pieces[static_cast<std::size_t>(end.piece)].both_ways;
    if (end.at_end || both)
      all_.roads[static_cast<std::size_t>(departing(end))].after.junction = junction;
    if (!end.at_end || both)
      all_.roads[static_cast<std::size_t>(entered(end))].before.junction = junction;
  }

  // The road that ends, the road that begins at an end of a piece.
  [[nodiscard]] int departing(const PieceEnd& end) const {
    return road_of(end.piece, !end.at_end) + parts_of(end.piece) - 1;
  }
  [[nodiscard]] int entered(const PieceEnd& end) const { return road_of(end.piece, end.at_end); }
  [[nodiscard]] int parts_of(int piece) const {
    return all_.roads[static_cast<std::size_t>(first_road_[static_cast<std::size_t>(piece)])].parts;
  }
  [[nodiscard]] int road_of(int piece, bool backward) const {
    return first_road_[static_cast<std::size_t>(piece)] + (backward ? parts_of(piece) : 0);
  }
  [[nodiscard]] int number() const { return static_cast<int>(all_.roads.size()); }

  // Least speed between two places that may lie beyond the seam of a ring.
  [[nodiscard]] double least_on_ring(const DriveRoad& road, double from, double to) const {
    const double length = road.curve.length_m();
    if (!road.curve.closed()) return planner_.least_speed(road.piece, from, to);
    const double turns = length * std::floor(from / length);
    from -= turns;
    to -= turns;
    if (to <= length) return planner_.least_speed(road.piece, from, to);
    return std::min(planner_.least_speed(road.piece, from, length),
                    planner_.least_speed(road.piece, 0.0, to - length));
  }

  void set_speeds(DriveRoad& road) const {
    const int number = static_cast<int>(&road - all_.roads.data());
    const auto limit = [number](const std::map<int, double>& limits) {
      const auto found = limits.find(number);
      return found == limits.end() ? INFINITY : found->second;
    };
    const double first = limit(at_begin_);
    const double last = limit(at_end_);
    const double length = road.curve.length_m();
    const CutPlaces cuts(road);
    const LeastSpeed least_speed = [&](double from, double to) {
      const double a = std::min(from, cuts.of(from));
      const double b = std::max(to, cuts.of(to));
      double speed =
          road.backward ? least_on_ring(road, length - b, length - a) : least_on_ring(road, a, b);
      if (from < road.begin_m + kNextToTurn_m) speed = std::min(speed, first);
      if (to > road.end_m - kNextToTurn_m) speed = std::min(speed, last);
      return speed;
    };
    SpeedPieceOptions options;
    options.shortest_m = kShortestPiece_m;
    // netconvert warns of edges that begin or end in a sharp bend.
    options.may_cut = [&](double s) { return is_straight(road, cuts.of(s)); };
    road.speeds = speed_pieces(least_speed, road.begin_m, road.end_m, options);
  }

  const PlannerMap& planner_;
  const LaneLayout& layout_;
  DriveRoads all_;
  std::vector<int> first_road_;     // of a piece
  std::map<int, int> junction_;     // of an intersection
  std::map<int, double> at_begin_;  // limits of turns into a road
  std::map<int, double> at_end_;    // and out of it
};

}  // namespace

DriveRoads drive_roads(const PlannerMap& planner) { return RoadBuilder(planner).build(); }

std::string name_of(const PlannerMap& planner, const DriveRoad& road) {
  if (road.piece < 0)
    return "turn " + std::to_string(road.connector) + (road.backward ? " back" : "");
  std::string name =
      "lane " + std::to_string(planner.layout().pieces[static_cast<std::size_t>(road.piece)].id);
  if (road.backward) name += " back";
  if (road.parts > 1)
    name += " part " + std::to_string(road.part + 1) + " of " + std::to_string(road.parts);
  return name;
}

}  // namespace roadbook
