#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/routing/network_place.hpp"
#include "roadnet/routing/routing_options.hpp"

namespace roadbook {

// Routes over the lanes, by the rules of the recorded driving: one-way lanes in their direction, no
// U-turns within a lane, reverse gear only where a vehicle was recorded in reverse gear.

struct RouteLeg {
  int lane = -1;
  std::uint64_t id = 0;  ///< of the lane
  bool along = true;     ///< first to last point of the lane's centre
  Gear gear = Gear::kForward;
  double from_s_m = 0.0;
  double to_s_m = 0.0;
  [[nodiscard]] double length_m() const { return along ? to_s_m - from_s_m : from_s_m - to_s_m; }
};

enum class RouteStatus : std::uint8_t {
  kFound,
  kNotConnected,    ///< no chain of lanes leads there
  kOnlyAgainstWay,  ///< lanes lead there, but only against their direction or by turns not allowed
};
[[nodiscard]] const char* to_text(RouteStatus status);

struct Route {
  RouteStatus status = RouteStatus::kNotConnected;
  std::vector<RouteLeg> legs;  ///< empty unless found
  double length_m = 0.0;
  double cost_m = 0.0;  ///< length with the costs of turns, gear changes and driving backwards
};

/// Finds routes over a network. Immutable; safe to share between threads.
class Router {
 public:
  /// Throws InvalidOption. The network is copied where needed.
  explicit Router(const RoadNetwork& network, const RoutingOptions& options = {});
  Router(Router&&) noexcept;
  Router& operator=(Router&&) noexcept;
  ~Router();

  /// Finds the cheapest route (A* with the straight distance as bound); of equally cheap ones the
  /// first in the order of lanes. The vehicle may face either direction at `from` and at `to`.
  /// Throws InvalidOption for a position that is not on the network.
  [[nodiscard]] Route route(const NetworkPlace& from, const NetworkPlace& to) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The centre line of a route's lanes from its first to its last place [m]; neighbours differ.
[[nodiscard]] std::vector<Eigen::Vector3d> route_line(const RoadNetwork& network,
                                                      const Route& route);

}  // namespace roadbook
