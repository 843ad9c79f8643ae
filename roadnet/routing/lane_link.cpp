#include "roadnet/routing/lane_link.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "base/error.hpp"
#include "roadnet/floor_height.hpp"

namespace roadbook {
namespace {

constexpr double kTryEach_m = 0.25;  // between the places of a lane that are tried

std::string metres(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.2f m", value);
  return text.data();
}

// The nearest place of one lane that lies in the cone before the space; distance infinite if none.
NetworkPlace nearest_before(const Lane& lane, int index, const SpacePlace& space, double cone_rad) {
  NetworkPlace best{index, 0.0, std::numeric_limits<double>::infinity()};
  const int steps = std::max(1, static_cast<int>(std::ceil(lane.length_m / kTryEach_m)));
  for (int i = 0; i <= steps; ++i) {
    const double s = lane.length_m * i / steps;
    const Eigen::Vector3d gap = lane_spot(lane, s).position - space.front;
    const double distance = gap.head<2>().norm();
    if (std::abs(gap.z()) > kFloorHeight_m || distance >= best.distance_m) continue;
    if (gap.head<2>().dot(space.outwards) < std::cos(cone_rad) * distance) continue;
    best.s_m = s;
    best.distance_m = distance;
  }
  return best;
}

void describe(const RoadNetwork& network, const SpacePlace& space, LaneLink& link) {
  const Lane& lane = network.lanes[static_cast<std::size_t>(link.place.lane)];
  const LaneSpot spot = lane_spot(lane, link.place.s_m);
  const Eigen::Vector2d d = (space.front - spot.position).head<2>();
  link.lane = lane.id;
  link.left = spot.direction.x() * d.y() - spot.direction.y() * d.x() > 0.0;
}

}  // namespace

void LaneLinkOptions::check() const {
  if (!(std::isfinite(reach_m) && reach_m > 0.0))
    throw InvalidOption("reach_m", std::to_string(reach_m), "more than 0");
  if (!(cone_rad > 0.0 && cone_rad <= 3.15))
    throw InvalidOption("cone_rad", std::to_string(cone_rad), "more than 0, at most pi");
}

SpacePlace space_place(std::uint64_t id, const std::vector<Eigen::Vector3d>& corners) {
  ROADBOOK_ASSERT(corners.size() >= 4);
  SpacePlace place;
  place.id = id;
  place.front = 0.5 * (corners[0] + corners[1]);
  const Eigen::Vector3d back = 0.5 * (corners[2] + corners[3]);
  place.outwards = (place.front - back).head<2>().stableNormalized();
  return place;
}

std::vector<LaneLink> link_spaces(const RoadNetwork& network,
                                  const std::vector<SpacePlace>& spaces,
                                  const LaneLinkOptions& options) {
  options.check();
  std::vector<LaneLink> links;
  for (const SpacePlace& space : spaces) {
    LaneLink link;
    link.space = space.id;
    link.place.distance_m = std::numeric_limits<double>::infinity();
    for (std::size_t l = 0; l < network.lanes.size(); ++l) {
      const NetworkPlace place =
          nearest_before(network.lanes[l], static_cast<int>(l), space, options.cone_rad);
      if (place.distance_m <= options.reach_m && place.distance_m < link.place.distance_m)
        link.place = place;
    }
    if (link.place.lane >= 0) {
      link.status = LinkStatus::kLinked;
      describe(network, space, link);
    } else if (const auto near = nearest_place(network, space.front, options.reach_m)) {
      link.status = LinkStatus::kNotBefore;
      link.place = *near;
      describe(network, space, link);
      link.reason = "lane " + std::to_string(link.lane) + ", " + metres(near->distance_m) +
                    " away, lies beside or behind it";
    } else {
      link.reason = "no lane within " + metres(options.reach_m);
    }
    links.push_back(std::move(link));
  }
  return links;
}

std::vector<SpaceAccess> space_access(const Router& router,
                                      const std::vector<LaneLink>& links,
                                      const NetworkPlace& entrance) {
  std::vector<SpaceAccess> access;
  for (const LaneLink& link : links) {
    SpaceAccess a;
    a.space = link.space;
    a.reason = link.reason;
    if (link.status == LinkStatus::kLinked) {
      const Route in = router.route(entrance, link.place);
      const Route out = router.route(link.place, entrance);
      a.reachable = in.status == RouteStatus::kFound && out.status == RouteStatus::kFound;
      a.way_in_m = in.length_m;
      if (in.status != RouteStatus::kFound)
        a.reason = std::string("way in: ") + to_text(in.status);
      else if (!a.reachable)
        a.reason = std::string("way out: ") + to_text(out.status);
    }
    access.push_back(std::move(a));
  }
  return access;
}

}  // namespace roadbook
