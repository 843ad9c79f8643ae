#include "exchange/export/nav2/nav2_keepout.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/geometry/outline.hpp"
#include "exchange/export/nav2/seen_ground.hpp"
#include "exchange/export/nav2/space_entry.hpp"

namespace roadbook {
namespace {

using Ring = std::vector<Eigen::Vector2d>;

constexpr double kClearance_m = 0.1;   // and a cell, on each side of the vehicle
constexpr double kSweepStep_m = 0.05;  // between poses of a sweep: corners move little more

double clearance_of(const MaskGrid& grid) { return kClearance_m + grid.place().resolution_m; }

Ring flat(const std::vector<Eigen::Vector3d>& ring) {
  Ring result;
  for (const Eigen::Vector3d& p : ring) result.emplace_back(p.head<2>());
  return result;
}

// In which directions the vehicle looked, along the lane's own direction and against it.
struct Headings {
  bool along = true;
  bool against = false;
};

Headings headings_of(const Lane& lane) {
  return {true, lane.backward_passes > 0 || lane.reverse_gear_passes > 0};
}

void sweep(const PathCurve& curve,
           const Headings& headings,
           VehicleFootprint vehicle,
           double width_m,
           MaskGrid& grid) {
  const double clearance_m = clearance_of(grid);
  vehicle.width_m = std::max(vehicle.width_m, width_m - 2.0 * clearance_m);
  const int steps = std::max(1, static_cast<int>(std::ceil(curve.length_m() / kSweepStep_m)));
  for (int i = 0; i <= steps; ++i) {
    const PathPoint at = curve.at(curve.length_m() * i / steps);
    if (headings.along) grid.mark(vehicle.at(at.position, at.tangent, clearance_m), 1);
    if (headings.against) grid.mark(vehicle.at(at.position, -at.tangent, clearance_m), 1);
  }
}

void sweep_lanes(const PlannerMap& planner, const VehicleFootprint& vehicle, MaskGrid& grid) {
  const LaneLayout& layout = planner.layout();
  for (const LanePiece& piece : layout.pieces) {
    const Lane& lane = planner.stored().network.lanes[static_cast<std::size_t>(piece.lane)];
    Headings headings = headings_of(lane);
    // A piece may run against the lane, whose poses are exported as they lie.
    if (piece.turned) headings.against = true;
    sweep(piece.curve, headings, vehicle, piece.width_m, grid);
  }
  for (const Connector& turn : layout.connectors)
    sweep(turn.curve, {true, turn.both_ways}, vehicle, turn.width_m, grid);
}

void mark_places(const PlannerMap& planner, MaskGrid& grid) {
  for (const PlannerCrossing& crossing : planner.crossings()) grid.mark(flat(crossing.corners), 1);
  for (const PlannerSpace& space : planner.spaces()) grid.mark(flat(space.corners), 1);
}

// Frees unseen ground between the spaces and their lanes: the ground straight before a space and
// the ground that the vehicle sweeps when it reverses into the space. Obstacles stay.
void mark_entries(const PlannerMap& planner, const VehicleFootprint& vehicle, MaskGrid& grid) {
  const double clearance_m = clearance_of(grid);
  MaskGrid swept = grid;
  std::fill(swept.cells().begin(), swept.cells().end(), std::uint8_t{0});
  for (const PlannerSpace& space : planner.spaces()) {
    if (!space.link) continue;
    swept.mark(ground_before(space, planner.layout(), vehicle.width_m + 2.0 * clearance_m), 1);
    for (const VehiclePlace& pose : reversing_into(space, planner.layout(), vehicle))
      swept.mark(vehicle.at(pose.position, pose.heading, clearance_m), 1);
  }
  for (std::size_t i = 0; i < grid.cells().size(); ++i)
    if (swept.cells()[i] != 0 && grid.cells()[i] == kUnseenGround) grid.cells()[i] = kFreeGround;
}

Eigen::AlignedBox2d extent_of(const PlannerMap& planner,
                              const MapLayers& layers,
                              const VehicleFootprint& vehicle,
                              double resolution_m) {
  Eigen::AlignedBox2d lanes;
  for (const LanePiece& piece : planner.layout().pieces)
    for (double s = 0.0; s <= piece.curve.length_m(); s += 1.0)
      lanes.extend(piece.curve.at(s).position);
  for (const PlannerSpace& space : planner.spaces())
    for (const Eigen::Vector3d& p : space.corners) lanes.extend(Eigen::Vector2d(p.head<2>()));
  for (const PlannerCrossing& crossing : planner.crossings())
    for (const Eigen::Vector3d& p : crossing.corners) lanes.extend(Eigen::Vector2d(p.head<2>()));
  const double reach = vehicle.length_m + vehicle.width_m + 2.0;
  Eigen::AlignedBox2d box(lanes.min().array() - reach, lanes.max().array() + reach);
  box.extend(overhead_extent(layers));
  // The outermost cells are never free: Nav2 applies no mask beyond them.
  return {box.min().array() - resolution_m, box.max().array() + resolution_m};
}

// Cells about which free ground reaches half the vehicle's width, as far as they hang together with
// those of a lane.
MaskGrid reached_cells(const PlannerMap& planner, double width_m, const MaskGrid& grid) {
  const RasterPlace& place = grid.place();
  MaskGrid reached = grid;
  cv::Mat distance_px;
  cv::distanceTransform(cv::Mat(place.rows, place.columns, CV_8U, reached.cells().data()),
                        distance_px, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  std::fill(reached.cells().begin(), reached.cells().end(), std::uint8_t{0});
  constexpr double kHalfDiagonal = 0.70711;  // of a cell
  const auto wide_enough = [&](int column, int row) {
    return (distance_px.at<float>(row, column) - kHalfDiagonal) * place.resolution_m >=
           0.5 * width_m;
  };
  std::vector<std::pair<int, int>> open;
  const auto reach = [&](int column, int row) {
    if (!grid.holds(column, row) || reached.cells()[grid.index(column, row)] != 0 ||
        !wide_enough(column, row))
      return;
    reached.cells()[grid.index(column, row)] = 1;
    open.emplace_back(column, row);
  };
  for (const LanePiece& piece : planner.layout().pieces)
    for (double s = 0.0; s <= piece.curve.length_m(); s += 0.5) {
      const Eigen::Vector2d p = piece.curve.at(s).position;
      reach(grid.column_of(p.x()), grid.row_of(p.y()));
    }
  while (!open.empty()) {
    const auto [column, row] = open.back();
    open.pop_back();
    reach(column + 1, row);
    reach(column - 1, row);
    reach(column, row + 1);
    reach(column, row - 1);
  }
  return reached;
}

std::vector<std::string> cut_off_spaces(const PlannerMap& planner,
                                        double width_m,
                                        const MaskGrid& grid) {
  std::vector<std::string> ids;
  if (planner.spaces().empty()) return ids;
  const MaskGrid reached = reached_cells(planner, width_m, grid);
  for (const PlannerSpace& space : planner.spaces()) {
    const Ring ring = flat(space.corners);
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : ring) box.extend(p);
    bool found = false;
    for (int row = grid.row_of(box.max().y()); row <= grid.row_of(box.min().y()); ++row)
      for (int c = grid.column_of(box.min().x()); c <= grid.column_of(box.max().x()); ++c)
        found = found ||
                (reached.cells()[grid.index(c, row)] != 0 && is_inside(ring, grid.centre(c, row)));
    if (!found) ids.push_back(space.id);
  }
  return ids;
}

}  // namespace

KeepOutMask keep_out_mask(const std::filesystem::path& map_file,
                          const Map& map,
                          const PlannerMap& planner,
                          const VehicleFootprint& vehicle,
                          double resolution_m) {
  vehicle.check();
  const MapLayers layers(map_file);
  const Eigen::AlignedBox2d extent = extent_of(planner, layers, vehicle, resolution_m);
  KeepOutMask mask{
      MaskGrid(extent.min(), extent.max(), resolution_m), !overhead_extent(layers).isEmpty(), {}};
  mark_seen_ground(layers, map, mask.grid);
  mark_entries(planner, vehicle, mask.grid);
  mark_places(planner, mask.grid);
  sweep_lanes(planner, vehicle, mask.grid);
  for (std::uint8_t& cell : mask.grid.cells()) cell = cell == kFreeGround ? 1 : 0;
  mask.cut_off = cut_off_spaces(planner, vehicle.width_m, mask.grid);
  return mask;
}

}  // namespace roadbook
