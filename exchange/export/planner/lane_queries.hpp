#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "speedmap/speeds/path_query.hpp"

namespace roadbook {

/// Queries of a map at positions of its lanes (`roadbook query`): speed, presence of people, grip
/// and class of the ground.
class LaneQueries {
 public:
  /// Throws BadInput if `roads` or `speeds` was not run on the map.
  explicit LaneQueries(const std::filesystem::path& map);
  LaneQueries(const LaneQueries&) = delete;
  LaneQueries& operator=(const LaneQueries&) = delete;

  [[nodiscard]] const StoredPaths& stored() const { return stored_; }
  [[nodiscard]] const SpeedMap& speeds() const { return speeds_; }
  [[nodiscard]] const std::optional<FrictionMap>& friction() const { return friction_; }
  /// The lanes with their tubes.
  [[nodiscard]] const LaneStrips& strips() const { return strips_; }
  /// The query of one lane of `strips`. Safe to use from several threads.
  [[nodiscard]] const LaneQuery& of(std::uint64_t lane) const { return queries_.at(lane); }

 private:
  StoredPaths stored_;
  SpeedMap speeds_;
  std::optional<FrictionMap> friction_;
  LaneStrips strips_;
  std::map<std::uint64_t, LaneQuery> queries_;
};

}  // namespace roadbook
