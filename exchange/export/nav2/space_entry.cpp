#include "exchange/export/nav2/space_entry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kRadius_m = 5.5;
constexpr double kLeastRadius_m = 3.5;
constexpr double kPoseStep_m = 0.05;
constexpr double kBehind_m = 0.25;  // left between the vehicle and the back of the space

// How a space is entered from its lane.
struct Axis {
  Eigen::Vector2d front = Eigen::Vector2d::Zero();     ///< middle of the side of the entry
  Eigen::Vector2d outwards = Eigen::Vector2d::Zero();  ///< unit
  double depth_m = 0.0;                                ///< along `outwards`
  double width_m = 0.0;                                ///< of the side of the entry
  double to_lane_m = 0.0;  ///< from `front` along `outwards` to the lane's centre
  Eigen::Vector2d lane_tangent = Eigen::Vector2d::Zero();
  bool parallel = false;  ///< the space lies along its lane
};

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d left_of_axis(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

// Entry over the side from corner `first` to the next one.
Axis entry_over(const PlannerSpace& space, std::size_t first, const PathPoint& lane) {
  const auto corner = [&](std::size_t i) -> Eigen::Vector2d {
    return space.corners[(first + i) % 4].head<2>();
  };
  Axis axis;
  axis.front = 0.5 * (corner(0) + corner(1));
  const Eigen::Vector2d back = 0.5 * (corner(2) + corner(3));
  axis.outwards = (axis.front - back).normalized();
  axis.depth_m = (axis.front - back).norm();
  axis.width_m = (corner(0) - corner(1)).norm();
  axis.lane_tangent = lane.tangent;
  // The lane as a straight line through its nearest point.
  const Eigen::Vector2d across = lane.position - axis.front;
  const double sine = cross(axis.outwards, lane.tangent);
  // Straight ahead of the end of a lane: as far as that end.
  axis.to_lane_m = std::abs(sine) < 0.3
                       ? across.norm()
                       : std::clamp(cross(across, lane.tangent) / sine, 0.0, 4.0 * across.norm());
  return axis;
}

// The open side of a space along its lane is a short one: such a space is entered over the long
// side that faces the lane.
Axis axis_of(const PlannerSpace& space, const LanePiece& piece) {
  constexpr double kParallel = 0.8;  // cosine
  const PathPoint lane = piece.curve.at(space.link->s_m);
  const Axis over_open_side = entry_over(space, 0, lane);
  const Eigen::Vector2d& out = over_open_side.outwards;
  const Eigen::Vector2d across = lane.position - over_open_side.front;
  const bool lane_is_beside = std::abs(cross(out, across)) > std::abs(out.dot(across));
  if (std::abs(out.dot(lane.tangent)) <= kParallel || !lane_is_beside) return over_open_side;
  for (const std::size_t side : {std::size_t{1}, std::size_t{3}}) {
    Axis axis = entry_over(space, side, lane);
    axis.parallel = true;
    if (axis.outwards.dot(lane.position - axis.front) > 0.0) return axis;
  }
  return over_open_side;
}

// Adds an arc from `from` that turns by `turn_rad` (left: positive); returns its last pose.
VehiclePlace add_arc(const VehiclePlace& from,
                     double turn_rad,
                     double radius_m,
                     std::vector<VehiclePlace>& poses) {
  const double side = turn_rad > 0.0 ? 1.0 : -1.0;
  const Eigen::Vector2d centre = from.position + side * radius_m * left_of_axis(from.heading);
  const int steps = static_cast<int>(std::ceil(std::abs(turn_rad) * radius_m / kPoseStep_m)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d now = Eigen::Rotation2Dd(turn_rad * i / steps) * from.heading;
    poses.push_back({centre - side * radius_m * left_of_axis(now), now});
  }
  return poses.back();
}

// Out of a space along the lane: one arc towards the lane and one back to its direction.
void add_parallel_run(const Axis& axis,
                      const Eigen::Vector2d& heading,
                      const VehicleFootprint& vehicle,
                      std::vector<VehiclePlace>& poses) {
  Eigen::Vector2d along = left_of_axis(axis.outwards);
  if (along.dot(heading) < 0.0) along = -along;
  const Eigen::Vector2d middle = axis.front - 0.5 * axis.depth_m * axis.outwards;
  const Eigen::Vector2d parked =
      middle - (0.5 * vehicle.length_m - vehicle.rear_overhang_m) * along;
  const double cosine = 1.0 - (0.5 * axis.depth_m + axis.to_lane_m) / (2.0 * kRadius_m);
  if (!(cosine > 0.0)) return;  // too far for two arcs
  const double turn = std::copysign(std::acos(cosine), cross(along, axis.outwards));
  const VehiclePlace between = add_arc({parked, along}, turn, kRadius_m, poses);
  add_arc(between, -turn, kRadius_m, poses);
}

void add_run(const Axis& axis,
             const Eigen::Vector2d& heading,
             const VehicleFootprint& vehicle,
             std::vector<VehiclePlace>& poses) {
  const Eigen::Vector2d& out = axis.outwards;
  const double turn = std::atan2(cross(out, heading), out.dot(heading));
  const double half_tangent = std::tan(0.5 * std::abs(turn));
  const Eigen::Vector2d parked =
      axis.front - (axis.depth_m - vehicle.rear_overhang_m - kBehind_m) * out;
  const Eigen::Vector2d meeting = axis.front + axis.to_lane_m * out;
  const double room = (meeting - parked).dot(out);
  const double radius = std::min(kRadius_m, room / std::max(half_tangent, 1e-6));
  if (!(std::abs(turn) < 2.6 && radius >= kLeastRadius_m)) return;
  // As it leaves: along the axis, then round to the lane.
  const Eigen::Vector2d begin = meeting - radius * half_tangent * out;
  const double straight = (begin - parked).dot(out);
  for (double d = 0.0; d < straight; d += kPoseStep_m) poses.push_back({parked + d * out, out});
  add_arc({begin, out}, turn, radius, poses);
}

const LanePiece& piece_of(const PlannerSpace& space, const LaneLayout& layout) {
  return layout.pieces[static_cast<std::size_t>(space.link->piece)];
}

}  // namespace

std::vector<Eigen::Vector2d> ground_before(const PlannerSpace& space,
                                           const LaneLayout& layout,
                                           double width_m) {
  const Axis axis = axis_of(space, piece_of(space, layout));
  const Eigen::Vector2d half = 0.5 * std::max(width_m, axis.width_m) *
                               Eigen::Vector2d(-axis.outwards.y(), axis.outwards.x());
  const Eigen::Vector2d end = axis.front + axis.to_lane_m * axis.outwards;
  return {axis.front + half, axis.front - half, end - half, end + half};
}

std::vector<VehiclePlace> reversing_into(const PlannerSpace& space,
                                         const LaneLayout& layout,
                                         const VehicleFootprint& vehicle) {
  const LanePiece& piece = piece_of(space, layout);
  const Axis axis = axis_of(space, piece);
  std::vector<VehiclePlace> poses;
  const auto add = axis.parallel ? add_parallel_run : add_run;
  add(axis, axis.lane_tangent, vehicle, poses);
  if (piece.both_ways) add(axis, -axis.lane_tangent, vehicle, poses);
  return poses;
}

}  // namespace roadbook
