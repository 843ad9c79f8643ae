#include "speedmap/speeds/speed_map.hpp"

#include <memory>

#include "base/cell_grid.hpp"

namespace roadbook {

double SpeedMap::coverage() const {
  std::size_t seen = 0;
  for (const SpeedCell& cell : cells) seen += cell.visits > 0 ? 1U : 0U;
  return cells.empty() ? 0.0 : static_cast<double>(seen) / static_cast<double>(cells.size());
}

std::function<const SpeedCell*(const Eigen::Vector2d&)> cells_of(const SpeedMap& map) {
  auto numbers = std::make_shared<CellGrid<std::size_t>>(map.cell_m);
  for (std::size_t i = 0; i < map.cells.size(); ++i) numbers->insert(map.cells[i].centre, i);
  return [&map, numbers](const Eigen::Vector2d& p) -> const SpeedCell* {
    const auto* found = numbers->find(p);
    return found == nullptr ? nullptr : &map.cells[found->front()];
  };
}

PresenceAt presence_of(const SpeedMap& map) {
  return [at = cells_of(map)](const Eigen::Vector2d& p) -> std::optional<PresenceValue> {
    const SpeedCell* const cell = at(p);
    if (cell == nullptr) return std::nullopt;
    return PresenceValue{cell->presence, cell->sigma * cell->sigma};
  };
}

}  // namespace roadbook
