#include "exchange/export/planner/lane_queries.hpp"

#include "base/error.hpp"

namespace roadbook {
namespace {

SpeedMap require_speeds(const std::filesystem::path& map, const std::vector<LanePath>& paths) {
  auto speeds = read_current_speeds(MapLayers(map), paths);
  if (!speeds)
    throw BadInput(Problem{Severity::kError, map.string(), 0, "speed_profile", "none",
                           "a speed map: run `roadbook speeds` on the map"});
  return std::move(*speeds);
}

}  // namespace

LaneQueries::LaneQueries(const std::filesystem::path& map)
    : stored_(load_paths(map)),
      speeds_(require_speeds(map, stored_.paths)),
      friction_(read_friction_layers(MapLayers(map), stored_.paths)),
      strips_(friction_ ? friction_->strips : LaneStrips(stored_.paths, 1.0, 2.0)) {
  const auto cell_at = cells_of(speeds_);
  const auto place = [cell_at](const Eigen::Vector2d& p) {
    const SpeedCell* const cell = cell_at(p);
    return cell == nullptr ? PlaceClass::kOther : cell->place;
  };
  for (const LaneProfile& profile : speeds_.profiles)
    if (strips_.find(profile.lane) != nullptr)
      queries_.emplace(profile.lane,
                       LaneQuery(strips_, profile, presence_of(speeds_), place,
                                 friction_ ? &friction_->map : nullptr, speeds_.options));
}

}  // namespace roadbook
