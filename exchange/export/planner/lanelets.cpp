#include "exchange/export/planner/lanelets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace roadbook {
namespace {

constexpr std::uint64_t kWayBack = 0xBAC;  // marks ids of lanelets for the way back

std::uint64_t unused(std::uint64_t id, std::set<std::uint64_t>& used) {
  while (!used.insert(id).second) ++id;
  return id;
}

// Sections of a piece from its begin to its end; lanelets lie between neighbours.
using PieceSections = std::vector<int>;

PieceSections add_lane(LaneletNetwork& network,
                       const PlannerMap& map,
                       int index,
                       const LaneletOptions& options,
                       std::set<std::uint64_t>& used) {
  const LanePiece& piece = map.layout().pieces[static_cast<std::size_t>(index)];
  SpeedPieceOptions cuts;
  cuts.longest_m = options.longest_m;
  cuts.at_least = map.returns_to_its_start(index) ? 2 : 1;
  const auto parts = map.lane_speeds(index, cuts);
  const LaneBounds bounds = bounds_of(piece);
  PieceSections sections;
  for (std::size_t i = 0; i <= parts.size(); ++i)
    sections.push_back(i == parts.size() && piece.curve.closed() ? sections.front()
                                                                 : network.sections++);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Lanelet lanelet;
    lanelet.id = i == 0 ? piece.id : unused(derived_id(piece.id, i), used);
    lanelet.piece = index;
    lanelet.bounds = bounds.part(parts[i].begin_m, parts[i].end_m);
    lanelet.first = {sections[i], false};
    lanelet.last = {sections[i + 1], false};
    lanelet.both_ways = piece.both_ways;
    lanelet.speed = parts[i].speed;
    network.lanelets.push_back(std::move(lanelet));
  }
  return sections;
}

// The left and right point of each section, as seen along its lane.
using SectionPoints = std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>>;

SectionPoints section_points(const LaneletNetwork& network) {
  SectionPoints points(static_cast<std::size_t>(network.sections));
  for (const Lanelet& lanelet : network.lanelets) {
    const LaneBounds& b = lanelet.bounds;
    points[static_cast<std::size_t>(lanelet.last.section)] = {b.left.back(), b.right.back()};
    points[static_cast<std::size_t>(lanelet.first.section)] = {b.left.front(), b.right.front()};
  }
  return points;
}

// The very points of the lanes, where the turn's own differ by rounding.
void begin_and_end_at(Lanelet& turn, const SectionPoints& points) {
  const auto pin = [&](const LaneletEnd& end, Eigen::Vector3d& left, Eigen::Vector3d& right) {
    const auto& at = points[static_cast<std::size_t>(end.section)];
    left = end.turned ? at.second : at.first;
    right = end.turned ? at.first : at.second;
  };
  pin(turn.first, turn.bounds.left.front(), turn.bounds.right.front());
  pin(turn.last, turn.bounds.left.back(), turn.bounds.right.back());
}

}  // namespace

TurnDirection turn_direction(const Lanelet& lanelet) {
  constexpr double kStraight_rad = 30.0 * std::numbers::pi / 180.0;
  const LaneBounds& bounds = lanelet.bounds;
  const Eigen::Vector2d a = (bounds.left.front() - bounds.right.front()).head<2>();
  const Eigen::Vector2d b = (bounds.left.back() - bounds.right.back()).head<2>();
  const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  if (std::abs(turn) < kStraight_rad) return TurnDirection::kStraight;
  return turn > 0.0 ? TurnDirection::kLeft : TurnDirection::kRight;
}

std::uint64_t derived_id(std::uint64_t a, std::uint64_t b) {
  const std::uint64_t id = (a * 0x9E3779B97F4A7C15U) ^ (b * 0xBF58476D1CE4E5B9U);
  return std::max<std::uint64_t>((id ^ (id >> 29U)) >> 11U, 1U);
}

std::uint64_t id_of_label(const std::string& label, LabelKind kind) {
  auto id = static_cast<std::uint64_t>(kind);
  for (const char c : label) id = derived_id(id, static_cast<unsigned char>(c));
  return id;
}

LaneletNetwork lanelets_of(const PlannerMap& map, const LaneletOptions& options) {
  LaneletNetwork network;
  const LaneLayout& layout = map.layout();
  std::set<std::uint64_t> used;
  for (const LanePiece& piece : layout.pieces) used.insert(piece.id);
  std::vector<PieceSections> sections;
  for (std::size_t i = 0; i < layout.pieces.size(); ++i)
    sections.push_back(add_lane(network, map, static_cast<int>(i), options, used));
  const auto points = section_points(network);
  // Left and right as seen when driving out of the first lane and into the second.
  const auto end_of = [&](const PieceEnd& end, bool into) {
    const PieceSections& of_piece = sections[static_cast<std::size_t>(end.piece)];
    return LaneletEnd{end.at_end ? of_piece.back() : of_piece.front(), end.at_end == into};
  };
  for (std::size_t i = 0; i < layout.connectors.size(); ++i) {
    const Connector& turn = layout.connectors[i];
    Lanelet lanelet;
    lanelet.id = unused(derived_id(layout.pieces[static_cast<std::size_t>(turn.from.piece)].id,
                                   layout.pieces[static_cast<std::size_t>(turn.to.piece)].id),
                        used);
    lanelet.connector = static_cast<int>(i);
    lanelet.bounds = bounds_of(turn, layout);
    lanelet.first = end_of(turn.from, false);
    lanelet.last = end_of(turn.to, true);
    lanelet.both_ways = turn.both_ways;
    lanelet.speed = map.turn_speed(static_cast<int>(i));
    begin_and_end_at(lanelet, points);
    network.lanelets.push_back(std::move(lanelet));
  }
  return network;
}

std::uint64_t id_of_way_back(const Lanelet& lanelet) { return derived_id(lanelet.id, kWayBack); }

Lanelet reversed(const Lanelet& lanelet) {
  Lanelet back = lanelet;
  back.id = id_of_way_back(lanelet);
  back.bounds.left.assign(lanelet.bounds.right.rbegin(), lanelet.bounds.right.rend());
  back.bounds.right.assign(lanelet.bounds.left.rbegin(), lanelet.bounds.left.rend());
  const double end = lanelet.bounds.s_m.front() + lanelet.bounds.s_m.back();
  std::reverse(back.bounds.s_m.begin(), back.bounds.s_m.end());
  for (double& s : back.bounds.s_m) s = end - s;
  back.first = lanelet.last.reversed();
  back.last = lanelet.first.reversed();
  return back;
}

}  // namespace roadbook
