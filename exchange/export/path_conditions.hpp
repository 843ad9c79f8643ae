#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "exchange/layers/stored_paths.hpp"
#include "roadnet/routing/route_path.hpp"

namespace roadbook {

/// Speed and friction at one row of a path; NaN if the map does not know them.
struct PathCondition {
  double speed_limit = NAN;  ///< [m/s] of the lane
  double speed = NAN;        ///< [m/s] of a profile that the vehicle can follow
  double friction = NAN;     ///< mean, in the middle of the lane
  double friction_sigma = NAN;
  std::vector<PropertyMoments> further;  ///< of the map's other properties; empty: not known
};

/// Step [m] at which speeds along a route are computed, for any distance of its rows.
inline constexpr double kSpeedStepM = 0.25;

/// Speed and friction along exported paths. Lanes have the profile stored in the map; a route has a
/// separate profile over all its lanes and turns.
class PathConditions {
 public:
  /// `tables`: rows of each lane or of the one route; `fine_route`: the same route in steps short
  /// enough for speeds (`kSpeedStepM`), empty for lanes. Throws BadInput.
  PathConditions(const std::filesystem::path& map,
                 const StoredPaths& stored,
                 const std::vector<std::vector<RoutePoint>>& tables,
                 const std::vector<RoutePoint>& fine_route = {});

  /// By table and row.
  [[nodiscard]] const std::vector<std::vector<PathCondition>>& tables() const { return tables_; }
  /// Date of the newest visit, and of the newest friction value; empty if there is no such map.
  [[nodiscard]] std::optional<std::string> speed_date() const;
  [[nodiscard]] std::optional<std::string> friction_date() const;
  /// Share of the speed map's cells that were in sight, and of the friction map's knots that have
  /// labels; 0 without such a map.
  [[nodiscard]] double speed_coverage() const;
  [[nodiscard]] double friction_coverage() const;
  /// Names of the friction map's further properties.
  [[nodiscard]] std::vector<std::string> further() const;

 private:
  void set_friction(const RoutePoint& row, PathCondition& at) const;
  void set_lane_speed(const std::vector<RoutePoint>& rows, std::size_t i, PathCondition& at) const;
  void set_route_speeds(const std::vector<RoutePoint>& rows,
                        const std::vector<RoutePoint>& fine,
                        std::vector<PathCondition>& conditions) const;
  [[nodiscard]] const LaneProfile* profile_of(std::uint64_t lane) const;
  /// Legal limit at a row [m/s]; infinite where no lane states a limit.
  [[nodiscard]] double limit_at(const std::vector<RoutePoint>& rows, std::size_t i) const;

  std::optional<SpeedMap> speeds_;
  std::optional<FrictionMap> friction_;
  std::vector<std::vector<PathCondition>> tables_;
};

}  // namespace roadbook
