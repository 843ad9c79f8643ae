#include "speedmap/speeds/speed_map.hpp"

#include <cmath>
#include <memory>
#include <unordered_map>

namespace roadbook {

double SpeedMap::coverage() const {
  std::size_t seen = 0;
  for (const SpeedCell& cell : cells) seen += cell.visits > 0 ? 1U : 0U;
  return cells.empty() ? 0.0 : static_cast<double>(seen) / static_cast<double>(cells.size());
}

std::function<const SpeedCell*(const Eigen::Vector2d&)> cells_of(const SpeedMap& map) {
  const auto key = [cell_m = map.cell_m](const Eigen::Vector2d& p) {
    const auto index = [&](double x) {
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(x / cell_m)));
    };
    return std::uint64_t{index(p.x())} << 32U | index(p.y());
  };
  auto cells = std::make_shared<std::unordered_map<std::uint64_t, std::size_t>>();
  for (std::size_t i = 0; i < map.cells.size(); ++i) cells->emplace(key(map.cells[i].centre), i);
  return [&map, cells, key](const Eigen::Vector2d& p) -> const SpeedCell* {
    const auto found = cells->find(key(p));
    return found == cells->end() ? nullptr : &map.cells[found->second];
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
