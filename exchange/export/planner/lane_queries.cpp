#include "exchange/export/planner/lane_queries.hpp"

#include "base/error.hpp"
#include "exchange/layers/item_table.hpp"

namespace roadbook {
namespace {

SpeedMap require_speeds(const MapLayers& layers, const std::vector<LanePath>& paths) {
  auto speeds = read_current_speeds(layers, paths);
  if (!speeds)
    throw BadInput(Problem{Severity::kError, layers.file().string(), 0, "speed_profile", "none",
                           "a speed map: run `roadbook speeds` on the map"});
  return std::move(*speeds);
}

}  // namespace

// Most of a map are images and landmarks, which no query reads.
LaneQueries::LaneQueries(const std::filesystem::path& map, const QueryContent& content)
    : LaneQueries(MapLayers(map, VerifiedPart::kWhatIsRead), content) {}

LaneQueries::LaneQueries(const MapLayers& layers, const QueryContent& content)
    : stored_(load_paths(layers)),
      speeds_(require_speeds(layers, stored_.paths)),
      items_(content.everything ? read_items(layers) : std::vector<LayerItem>()),
      now_ns_(content.now_ns.value_or(time_of_items(items_, speeds_.now_ns))),
      effects_(items_, now_ns_, speeds_.options),
      friction_(read_friction_layers(layers, stored_.paths)),
      strips_(friction_ ? friction_->strips : LaneStrips(stored_.paths, 1.0, 2.0)) {
  if (content.everything) read_everything(layers);
  const GroundFields fields{occupancy_ ? &*occupancy_ : nullptr, labels_ ? &*labels_ : nullptr};
  const auto cell_at = cells_of(speeds_);
  const auto place = [cell_at](const Eigen::Vector2d& p) {
    const SpeedCell* const cell = cell_at(p);
    return cell == nullptr ? PlaceClass::kOther : cell->place;
  };
  for (const LaneProfile& profile : speeds_.profiles)
    if (strips_.find(profile.lane) != nullptr)
      queries_.emplace(profile.lane, LaneQuery(strips_, profile, presence_of(speeds_), place,
                                               friction_ ? &friction_->map : nullptr,
                                               speeds_.options, 1.0, fields));
}

void LaneQueries::read_everything(const MapLayers& layers) {
  occupancy_ = read_occupancy_field(layers, now_ns_);
  labels_ = read_label_field(layers);
  if (items_.empty()) return;
  // The stored profiles have the items at the time of `speeds`.
  for (LaneProfile& profile : speeds_.profiles)
    for (const Lane& lane : stored_.network.lanes)
      if (lane.id == profile.lane) {
        profile.from_intersection = lane.from_intersection;
        profile.to_intersection = lane.to_intersection;
      }
  apply_items(speeds_.profiles, effects_, speeds_.options);
}

}  // namespace roadbook
