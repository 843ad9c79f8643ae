#include "exchange/export/commonroad/commonroad_network.hpp"

#include <cmath>
#include <map>
#include <queue>

namespace roadbook {

std::vector<DirectedLanelet> directed_lanelets(const LaneletNetwork& network) {
  std::vector<DirectedLanelet> directed;
  for (const Lanelet& lanelet : network.lanelets) {
    directed.push_back({lanelet, {}, {}});
    if (lanelet.both_ways) directed.push_back({reversed(lanelet), {}, {}});
  }
  std::map<std::pair<int, bool>, std::vector<std::size_t>> begins;
  for (std::size_t i = 0; i < directed.size(); ++i) {
    directed[i].lanelet.both_ways = false;
    const LaneletEnd& first = directed[i].lanelet.first;
    begins[{first.section, first.turned}].push_back(i);
  }
  for (std::size_t i = 0; i < directed.size(); ++i) {
    const LaneletEnd& last = directed[i].lanelet.last;
    directed[i].successors = begins[{last.section, last.turned}];
    for (const std::size_t next : directed[i].successors) directed[next].predecessors.push_back(i);
  }
  return directed;
}

namespace {

LaneletTrip longest_trip_from(const std::vector<DirectedLanelet>& lanelets, std::size_t from) {
  const auto time_of = [&](std::size_t i) {
    return lanelets[i].lanelet.bounds.centre_length_m() / lanelets[i].lanelet.speed;
  };
  using State = std::pair<double, std::size_t>;
  std::priority_queue<State, std::vector<State>, std::greater<>> open;
  std::vector<double> reached(lanelets.size(), INFINITY);
  open.emplace(reached[from] = time_of(from), from);
  LaneletTrip longest{from, from, reached[from]};
  while (!open.empty()) {
    const auto [time, i] = open.top();
    open.pop();
    if (time > reached[i]) continue;
    longest = {from, i, time};
    for (const std::size_t next : lanelets[i].successors)
      if (const double there = time + time_of(next); there < reached[next])
        open.emplace(reached[next] = there, next);
  }
  return longest;
}

}  // namespace

LaneletTrip longest_trip(const std::vector<DirectedLanelet>& lanelets) {
  constexpr std::size_t kMostTried = 50;
  LaneletTrip longest;
  const std::size_t step = (lanelets.size() + kMostTried - 1) / kMostTried;
  for (std::size_t from = 0; from < lanelets.size(); from += step)
    if (const LaneletTrip trip = longest_trip_from(lanelets, from); trip.time_s > longest.time_s)
      longest = trip;
  return longest;
}

}  // namespace roadbook
