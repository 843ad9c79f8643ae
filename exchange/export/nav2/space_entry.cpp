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

// The axis of a space and where it meets its lane.
struct Axis {
  Eigen::Vector2d front = Eigen::Vector2d::Zero();     ///< middle of the open side
  Eigen::Vector2d outwards = Eigen::Vector2d::Zero();  ///< unit
  double depth_m = 0.0;
  double width_m = 0.0;
  double to_lane_m = 0.0;  ///< from the open side along the axis
  Eigen::Vector2d lane_tangent = Eigen::Vector2d::Zero();
};

Axis axis_of(const PlannerSpace& space, const LanePiece& piece) {
  const auto& c = space.corners;
  Axis axis;
  axis.front = 0.5 * (c[0] + c[1]).head<2>();
  const Eigen::Vector2d back = 0.5 * (c[2] + c[3]).head<2>();
  axis.outwards = (axis.front - back).normalized();
  axis.depth_m = (axis.front - back).norm();
  axis.width_m = (c[0] - c[1]).head<2>().norm();
  const PathPoint lane = piece.curve.at(space.link->s_m);
  axis.lane_tangent = lane.tangent;
  const Eigen::Vector2d across = lane.position - axis.front;
  // The link lies before the open side; never longer than four times the distance (flat angles).
  const double cosine = across.norm() > 1e-9 ? across.normalized().dot(axis.outwards) : 1.0;
  axis.to_lane_m = across.norm() / std::max(cosine, 0.25);
  return axis;
}

void add_run(const Axis& axis,
             const Eigen::Vector2d& heading,
             const VehicleFootprint& vehicle,
             std::vector<VehiclePlace>& poses) {
  const Eigen::Vector2d& out = axis.outwards;
  const double turn = std::atan2(out.x() * heading.y() - out.y() * heading.x(), out.dot(heading));
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
  const double side = turn > 0.0 ? 1.0 : -1.0;
  const auto left_of = [](const Eigen::Vector2d& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  const Eigen::Vector2d centre = begin + side * radius * left_of(out);
  const int steps = static_cast<int>(std::ceil(std::abs(turn) * radius / kPoseStep_m)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d now = Eigen::Rotation2Dd(turn * i / steps) * out;
    poses.push_back({centre - side * radius * left_of(now), now});
  }
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
  add_run(axis, axis.lane_tangent, vehicle, poses);
  if (piece.both_ways) add_run(axis, -axis.lane_tangent, vehicle, poses);
  return poses;
}

}  // namespace roadbook
