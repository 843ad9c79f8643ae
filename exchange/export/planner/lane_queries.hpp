#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/ground_fields.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "speedmap/items/item_effects.hpp"
#include "speedmap/speeds/path_query.hpp"

namespace roadbook {

/// Content of the queries.
struct QueryContent {
  /// Occupancy, labels, and the items of layers as they are at `now_ns`. Without: the speeds as
  /// `speeds` stored them.
  bool everything = false;
  /// Since 1970; empty: the time of the speed map, or of the newest item if that is later.
  std::optional<std::int64_t> now_ns{};
};

/// Queries of a map at positions of its lanes (`roadbook query`): speed, presence of people, grip
/// and class of the ground.
class LaneQueries {
 public:
  /// Throws BadInput if `roads` or `speeds` was not run on the map.
  explicit LaneQueries(const std::filesystem::path& map, const QueryContent& content = {});
  LaneQueries(const LaneQueries&) = delete;
  LaneQueries& operator=(const LaneQueries&) = delete;

  [[nodiscard]] const StoredPaths& stored() const { return stored_; }
  [[nodiscard]] const SpeedMap& speeds() const { return speeds_; }
  [[nodiscard]] const std::optional<FrictionMap>& friction() const { return friction_; }
  /// All items of the map; none without `everything`.
  [[nodiscard]] const std::vector<LayerItem>& items() const { return items_; }
  /// Those that are used at `now_ns`.
  [[nodiscard]] const ItemEffects& effects() const { return effects_; }
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
  /// The lanes with their tubes.
  [[nodiscard]] const LaneStrips& strips() const { return strips_; }
  /// The query of one lane of `strips`. Safe to use from several threads.
  [[nodiscard]] const LaneQuery& of(std::uint64_t lane) const { return queries_.at(lane); }

 private:
  LaneQueries(const MapLayers& layers, const QueryContent& content);
  void read_everything(const MapLayers& layers);

  StoredPaths stored_;
  SpeedMap speeds_;
  std::vector<LayerItem> items_;
  std::int64_t now_ns_;
  ItemEffects effects_;
  std::optional<OccupancyField> occupancy_;
  std::optional<LabelField> labels_;
  std::optional<FrictionMap> friction_;
  LaneStrips strips_;
  std::map<std::uint64_t, LaneQuery> queries_;
};

}  // namespace roadbook
