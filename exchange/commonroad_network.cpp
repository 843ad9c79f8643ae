#include "exchange/commonroad_network.hpp"

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

FarthestLanelet farthest_from(const std::vector<DirectedLanelet>& lanelets, std::size_t from) {
  const auto time_of = [&](std::size_t i) {
    return lanelets[i].lanelet.bounds.centre_length_m() / lanelets[i].lanelet.speed;
  };
  using State = std::pair<double, std::size_t>;
  std::priority_queue<State, std::vector<State>, std::greater<>> open;
  std::vector<double> reached(lanelets.size(), INFINITY);
  open.emplace(reached[from] = time_of(from), from);
  FarthestLanelet farthest{from, reached[from]};
  while (!open.empty()) {
    const auto [time, i] = open.top();
    open.pop();
    if (time > reached[i]) continue;
    farthest = {i, time};
    for (const std::size_t next : lanelets[i].successors)
      if (const double there = time + time_of(next); there < reached[next])
        open.emplace(reached[next] = there, next);
  }
  return farthest;
}

}  // namespace roadbook
