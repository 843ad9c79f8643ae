#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/evaluation/occupancy/grid_rules.hpp"
#include "workflows/occupancy/occupancy_score.hpp"

namespace roadbook {

struct NamedGrid {
  std::string name;
  RuledGrid grid;
};

/// Draws grids side by side, `columns` in a row, north up: white where free, black where occupied,
/// grey between, blue where no reading came. Throws StorageError.
void write_grid_pictures(const std::filesystem::path& file,
                         const std::vector<NamedGrid>& grids,
                         int columns);

/// True share of occupied cells over the mean probability, one curve a grid: an SVG chart.
[[nodiscard]] std::string calibration_chart(
    const std::vector<std::pair<std::string, OccupancyTruth>>& scores);

}  // namespace roadbook
