#include "roadnet/lane_ids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace roadbook {
namespace {

constexpr double kSameLane = 0.7;  // share of either lane that lies on the other

bool before(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

void turn_round(Lane& lane) {
  std::reverse(lane.centre.begin(), lane.centre.end());
  std::swap(lane.from_intersection, lane.to_intersection);
  std::swap(lane.forward_passes, lane.backward_passes);
}

void start_ring_at_smallest(Lane& lane) {
  lane.centre.pop_back();
  std::rotate(lane.centre.begin(), std::min_element(lane.centre.begin(), lane.centre.end(), before),
              lane.centre.end());
  lane.centre.push_back(lane.centre.front());
}

void direct(Lane& lane) {
  if (lane.closed) start_ring_at_smallest(lane);
  const std::size_t quarter = lane.centre.size() / 4;  // tells the ways round a loop apart
  const bool from_smaller =
      lane.centre.front() == lane.centre.back()
          ? before(lane.centre[quarter], lane.centre[lane.centre.size() - 1 - quarter])
          : before(lane.centre.front(), lane.centre.back());
  const bool right = lane.forward_passes != lane.backward_passes
                         ? lane.forward_passes > lane.backward_passes
                         : from_smaller;
  if (!right) turn_round(lane);
}

double distance(const Eigen::Vector3d& p, const std::vector<Eigen::Vector3d>& line) {
  double best2 = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector3d d = line[i + 1] - line[i];
    const double along = d.squaredNorm() > 0.0 ? (p - line[i]).dot(d) / d.squaredNorm() : 0.0;
    best2 = std::min(best2, (line[i] + std::clamp(along, 0.0, 1.0) * d - p).squaredNorm());
  }
  return std::sqrt(best2);
}

double share_on(const Lane& lane, const Lane& other, double reach_m) {
  const auto near = std::count_if(lane.centre.begin(), lane.centre.end(), [&](const auto& p) {
    return distance(p, other.centre) <= reach_m;
  });
  return static_cast<double>(near) / static_cast<double>(lane.centre.size());
}

bool boxes_meet(const Lane& a, const Lane& b, double margin_m) {
  const auto low = [](const Lane& lane) {
    return std::accumulate(lane.centre.begin(), lane.centre.end(), lane.centre.front(),
                           [](const auto& m, const auto& p) { return m.cwiseMin(p).eval(); });
  };
  const auto high = [](const Lane& lane) {
    return std::accumulate(lane.centre.begin(), lane.centre.end(), lane.centre.front(),
                           [](const auto& m, const auto& p) { return m.cwiseMax(p).eval(); });
  };
  return ((low(a).array() - margin_m) <= high(b).array()).all() &&
         ((low(b).array() - margin_m) <= high(a).array()).all();
}

// Whether `lane` runs against `old`, judged by how far along `old` its quarters lie.
bool runs_against(const Lane& lane, const Lane& old) {
  const auto index_on = [&](const Eigen::Vector3d& p) {
    return std::min_element(old.centre.begin(), old.centre.end(),
                            [&](const auto& a, const auto& b) {
                              return (a - p).squaredNorm() < (b - p).squaredNorm();
                            }) -
           old.centre.begin();
  };
  const std::size_t quarter = lane.centre.size() / 4;
  return index_on(lane.centre[quarter]) > index_on(lane.centre[lane.centre.size() - 1 - quarter]);
}

std::uint64_t id_of_place(const Eigen::Vector3d& place, std::uint64_t kind) {
  // SplitMix64's mixing of the place in decimetres.
  std::uint64_t id = kind;
  for (const double value : place) {
    id += static_cast<std::uint64_t>(std::llround(value * 10.0)) + 0x9E3779B97F4A7C15U;
    id = (id ^ (id >> 30U)) * 0xBF58476D1CE4E5B9U;
    id = (id ^ (id >> 27U)) * 0x94D049BB133111EBU;
    id ^= id >> 31U;
  }
  // 53 bits: GeoJSON readers keep numbers as doubles.
  return std::max<std::uint64_t>(id >> 11U, 1U);
}

std::uint64_t fresh_id(std::set<std::uint64_t>& used, std::uint64_t id) {
  while (!used.insert(id).second) ++id;
  return id;
}

// Pairs (new, old) with the best score first, each part in one pair at most.
template <typename Score>
std::vector<int> best_pairs(std::size_t count_new, std::size_t count_old, const Score& score) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < count_new; ++i) {
    for (std::size_t k = 0; k < count_old; ++k) {
      const double s = score(i, k);
      if (s > 0.0) pairs.emplace_back(-s, i, k);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<int> match(count_new, -1);
  std::vector<bool> taken(count_old, false);
  for (const auto& [s, i, k] : pairs) {
    if (match[i] >= 0 || taken[k]) continue;
    match[i] = static_cast<int>(k);
    taken[k] = true;
  }
  return match;
}

void sort_intersections(RoadNetwork& network) {
  std::vector<int> order(network.intersections.size());
  std::iota(order.begin(), order.end(), 0);
  const auto& all = network.intersections;
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return before(all[static_cast<std::size_t>(a)].position,
                  all[static_cast<std::size_t>(b)].position);
  });
  std::vector<Intersection> sorted;
  std::vector<int> place(order.size());
  for (const int i : order) {
    place[static_cast<std::size_t>(i)] = static_cast<int>(sorted.size());
    sorted.push_back(all[static_cast<std::size_t>(i)]);
  }
  network.intersections = std::move(sorted);
  for (Lane& lane : network.lanes) {
    for (int* const end : {&lane.from_intersection, &lane.to_intersection}) {
      if (*end >= 0) *end = place[static_cast<std::size_t>(*end)];
    }
  }
}

void name_intersections(RoadNetwork& network, const RoadNetwork& old) {
  auto& parts = network.intersections;
  const auto match =
      best_pairs(parts.size(), old.intersections.size(), [&](std::size_t i, std::size_t k) {
        return network.reach_m - (parts[i].position - old.intersections[k].position).norm();
      });
  std::set<std::uint64_t> used;
  for (const Intersection& part : old.intersections) used.insert(part.id);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].id = match[i] >= 0 ? old.intersections[static_cast<std::size_t>(match[i])].id
                                : fresh_id(used, id_of_place(parts[i].position, 1));
  }
}

void name_lanes(RoadNetwork& network, const RoadNetwork& old) {
  auto& lanes = network.lanes;
  const double near_m = 0.5 * network.reach_m;
  const auto match = best_pairs(lanes.size(), old.lanes.size(), [&](std::size_t i, std::size_t k) {
    if (!boxes_meet(lanes[i], old.lanes[k], near_m)) return 0.0;
    const double score = std::min(share_on(lanes[i], old.lanes[k], near_m),
                                  share_on(old.lanes[k], lanes[i], near_m));
    return score >= kSameLane ? score : 0.0;
  });
  std::set<std::uint64_t> used;
  for (const Lane& lane : old.lanes) used.insert(lane.id);
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    if (match[i] < 0) {
      lanes[i].id = fresh_id(used, id_of_place(lanes[i].centre[lanes[i].centre.size() / 2], 2));
      continue;
    }
    const Lane& same = old.lanes[static_cast<std::size_t>(match[i])];
    lanes[i].id = same.id;
    if (runs_against(lanes[i], same)) turn_round(lanes[i]);
  }
}

}  // namespace

void assign_stable_ids(RoadNetwork& network, const RoadNetwork* previous) {
  sort_intersections(network);
  for (Lane& lane : network.lanes) direct(lane);
  std::sort(network.lanes.begin(), network.lanes.end(), [](const Lane& a, const Lane& b) {
    return std::lexicographical_compare(a.centre.begin(), a.centre.end(), b.centre.begin(),
                                        b.centre.end(), before);
  });
  const RoadNetwork nothing;
  name_intersections(network, previous != nullptr ? *previous : nothing);
  name_lanes(network, previous != nullptr ? *previous : nothing);
}

}  // namespace roadbook
