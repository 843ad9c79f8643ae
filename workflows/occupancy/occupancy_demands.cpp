#include "workflows/occupancy/occupancy_demands.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "workflows/occupancy/drive_poses.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

double share_of(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
}

// The folder of the newest drive of the grid, if a session of the map was made of it.
std::vector<std::filesystem::path> newest_drive(const std::filesystem::path& map_file,
                                                const Map& map,
                                                const StoredOccupancy& stored) {
  if (stored.drives.empty()) return {};
  for (const Session& session : map.sessions) {
    if (session.drive_digest != stored.drives.back().digest) continue;
    const auto folder = session_folder(map_file, session);
    if (std::filesystem::exists(folder / "truth")) return {folder};
  }
  return {};
}

}  // namespace

DrivenGround driven_ground(const OccupancyGrid& grid, double prior_log_odds, const Map& map) {
  constexpr double kHalf_m = 0.5;
  const CellShape& shape = grid.shape;
  std::vector<char> driven(shape.size(), 0);
  const double reach = kHalf_m / shape.cell_m;
  const int cells = static_cast<int>(std::ceil(reach));
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Vector3d place = map.T_map_vehicle(static_cast<int>(k)).translation();
    const Eigen::Vector2d at = (place.head<2>() - shape.low) / shape.cell_m;
    const int column = static_cast<int>(std::floor(at.x()));
    const int row = static_cast<int>(std::floor(at.y()));
    for (int r = row - cells; r <= row + cells; ++r)
      for (int c = column - cells; c <= column + cells; ++c)
        if (shape.holds(c, r) && (Eigen::Vector2d(c + 0.5, r + 0.5) - at).norm() <= reach)
          driven[shape.index(c, r)] = 1;
  }
  DrivenGround ground;
  for (std::size_t i = 0; i < driven.size(); ++i) {
    if (driven[i] == 0) continue;
    ++ground.cells;
    if (grid.seen[i] == 0) continue;
    ++ground.seen;
    const double p = grid.probability(i, prior_log_odds);
    ground.free += is_free(p, grid.sigma(i, prior_log_odds)) ? 1U : 0U;
    ground.occupied += p > kOccupiedProbability ? 1U : 0U;
  }
  return ground;
}

double OccupancyDemands::area_m2() const {
  return static_cast<double>(figures.cells) * cell_m * cell_m;
}

double OccupancyDemands::updates_a_scan() const {
  double scans = 0.0, updates = 0.0;
  for (const OccupancyDrive& d : drives) {
    scans += static_cast<double>(d.scans);
    updates += static_cast<double>(d.updates);
  }
  return updates / std::max(1.0, scans);
}

double OccupancyDemands::undecided_share() const {
  return share_of(figures.undecided, figures.cells);
}

double OccupancyDemands::free_share() const { return share_of(figures.free, figures.cells); }

OccupancyDemands occupancy_demands(const StoredOccupancy& stored,
                                   const OccupancyGrid& grid,
                                   const Map& map,
                                   const std::optional<TruePlace>& place) {
  OccupancyDemands demands;
  const double prior = stored.prior_log_odds();
  demands.figures = occupancy_figures(stored, grid);
  demands.cell_m = stored.cell_m;
  demands.drives = stored.drives;
  demands.driven = driven_ground(grid, prior, map);
  if (!place) return demands;
  const TrueCells truth = true_cells(grid.shape, place->surfaces);
  demands.truth = score_occupancy(grid, prior, truth);
  const OccupancyTrails trails = score_trails(grid, prior, truth, place->walked);
  if (trails.crossed > 0) demands.trails = trails;
  return demands;
}

std::optional<OccupancyDemands> demands_of_map(const std::filesystem::path& map_file,
                                               const Map& map) {
  auto stored = read_occupancy_layers(MapLayers(map_file));
  if (!stored) return std::nullopt;
  const OccupancyGrid grid =
      place_patches(stored->patches, keyframe_poses(map), stored->reading_weights());
  if (grid.shape.size() == 0) return std::nullopt;
  return occupancy_demands(*stored, grid, map,
                           true_place(map_file, map, newest_drive(map_file, map, *stored)));
}

}  // namespace roadbook
