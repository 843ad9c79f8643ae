#include "tests/roadnet/random_lots.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include "base/random.hpp"

namespace roadbook::test {
namespace {

using Move = std::pair<int, int>;

Eigen::Vector3d at(double x, double y) { return {x, y, 0.0}; }

// Two long sides with `aisles` roads between them; the outer two are the short sides.
Lot ladder(int aisles, Random& random) {
  Lot lot;
  const double height = random.uniform(30.0, 60.0);
  double x = 0.0;
  for (int i = 0; i < aisles; ++i) {
    lot.places.push_back(at(x, 0.0));
    lot.places.push_back(at(x, height));
    x += random.uniform(16.0, 25.0);
    lot.roads.emplace_back(2 * i, 2 * i + 1);
    if (i == 0) continue;
    lot.roads.emplace_back(2 * i - 2, 2 * i);
    lot.roads.emplace_back(2 * i - 1, 2 * i + 1);
  }
  lot.intersections = 2 * (aisles - 2);
  lot.lanes = aisles + 2 * (aisles - 1) - 4;  // each corner joins two roads to one lane
  lot.cycle_rank = aisles - 1;
  return lot;
}

Lot dead_ends(Random& random) {
  Lot lot;
  const double w = random.uniform(40.0, 60.0);
  const double h = random.uniform(30.0, 45.0);
  const double d = random.uniform(15.0, 30.0);
  lot.places = {at(0, 0), at(w / 2, 0), at(w, 0),      at(w, h / 2),
                at(w, h), at(0, h),     at(w / 2, -d), at(w + d, h / 2)};
  lot.roads = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 0}, {1, 6}, {3, 7}};
  lot.intersections = 2;
  lot.lanes = 4;
  lot.cycle_rank = 1;
  return lot;
}

Lot figure_eight(Random& random) {
  Lot lot;
  const double w = random.uniform(30.0, 45.0);
  const double h = random.uniform(25.0, 40.0);
  lot.places = {at(0, 0), at(w, 0), at(w, h), at(0, h), at(-w, 0), at(-w, -h), at(0, -h)};
  lot.roads = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {4, 5}, {5, 6}, {6, 0}};
  lot.intersections = 1;
  lot.lanes = 2;
  lot.cycle_rank = 2;
  return lot;
}

Lot crossings(Random& random) {
  Lot lot;
  const double a = random.uniform(20.0, 35.0);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) lot.places.push_back(at(a * x, a * y));
  }
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) {
      if (x < 2) lot.roads.emplace_back(3 * y + x, 3 * y + x + 1);
      if (y < 2) lot.roads.emplace_back(3 * y + x, 3 * y + x + 3);
    }
  }
  lot.intersections = 5;
  lot.lanes = 8;
  lot.cycle_rank = 4;
  return lot;
}

Lot one_way_ring(Random& random) {
  Lot lot;
  const double w = random.uniform(30.0, 60.0);
  const double h = random.uniform(25.0, 40.0);
  lot.places = {at(0, 0), at(w, 0), at(w, h), at(0, h)};
  lot.roads = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  lot.one_way = true;
  lot.lanes = 1;
  lot.cycle_rank = 1;
  return lot;
}

Lot t_junction(Random& random) {
  Lot lot;
  lot.places = {at(0, 0), at(-random.uniform(25.0, 40.0), 0), at(random.uniform(25.0, 40.0), 0),
                at(random.uniform(-10.0, 10.0), random.uniform(25.0, 40.0))};
  lot.roads = {{0, 1}, {0, 2}, {0, 3}};
  lot.intersections = 1;
  lot.lanes = 3;
  return lot;
}

Lot ring_with_way_in(Random& random) {
  Lot lot = one_way_ring(random);
  lot.one_way = false;
  lot.places.push_back(at(-random.uniform(20.0, 30.0), 0.0));
  lot.roads.emplace_back(0, 4);
  lot.intersections = 1;
  lot.lanes = 2;
  return lot;
}

std::vector<int> onward(const Lot& lot, const Move& move) {
  std::vector<int> next;
  for (const auto& [a, b] : lot.roads) {
    if (a == move.second && b != move.first) next.push_back(b);
    if (!lot.one_way && b == move.second && a != move.first) next.push_back(a);
  }
  if (next.empty()) next.push_back(move.first);  // a dead end: back
  return next;
}

// Returns the shortest continuation from `move` that ends with a road that is not yet driven.
std::vector<int> to_undriven(const Lot& lot,
                             const Move& move,
                             const std::set<Move>& driven,
                             Random& random) {
  std::map<Move, Move> from;
  std::deque<Move> open{move};
  while (!open.empty()) {
    const Move here = open.front();
    open.pop_front();
    std::vector<int> next = onward(lot, here);
    for (std::size_t i = next.size(); i > 1; --i) std::swap(next[i - 1], next[random.below(i)]);
    for (const int place : next) {
      const Move step{here.second, place};
      if (from.contains(step) || step == move) continue;
      from[step] = here;
      open.push_back(step);
      if (driven.contains({std::min(step.first, step.second), std::max(step.first, step.second)})) {
        continue;
      }
      std::vector<int> way;
      for (Move back = step; back != move; back = from.at(back)) way.push_back(back.second);
      std::reverse(way.begin(), way.end());
      return way;
    }
  }
  return {};
}

std::vector<int> lap_route(const Lot& lot, Move& last, Random& random) {
  std::vector<int> route{last.first, last.second};
  std::set<Move> driven{{std::min(last.first, last.second), std::max(last.first, last.second)}};
  while (true) {
    const std::vector<int> way = to_undriven(lot, last, driven, random);
    if (way.empty()) return route;
    for (const int place : way) {
      last = {last.second, place};
      driven.insert({std::min(last.first, last.second), std::max(last.first, last.second)});
      route.push_back(place);
    }
  }
}

std::vector<Eigen::Vector3d> dense(const std::vector<Eigen::Vector3d>& corners, double step_m) {
  std::vector<Eigen::Vector3d> line{corners.front()};
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const int pieces = static_cast<int>(std::ceil((corners[i + 1] - corners[i]).norm() / step_m));
    for (int k = 1; k <= pieces; ++k) {
      line.push_back(corners[i] + (corners[i + 1] - corners[i]) * k / pieces);
    }
  }
  return line;
}

// Mean over 6 m: turns of about 4 m radius.
std::vector<Eigen::Vector3d> rounded(const std::vector<Eigen::Vector3d>& line, double step_m) {
  const auto half = static_cast<std::ptrdiff_t>(3.0 / step_m);
  const auto count = static_cast<std::ptrdiff_t>(line.size());
  std::vector<Eigen::Vector3d> smooth;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::ptrdiff_t h = std::min({half, i, count - 1 - i});
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::ptrdiff_t k = i - h; k <= i + h; ++k) sum += line[static_cast<std::size_t>(k)];
    smooth.push_back(sum / static_cast<double>(2 * h + 1));
  }
  return smooth;
}

std::vector<Eigen::Vector3d> scattered(const std::vector<Eigen::Vector3d>& line,
                                       double scatter_m,
                                       double step_m,
                                       double& offset,
                                       Random& random) {
  const double keep = std::exp(-step_m / 30.0);  // correlated over 30 m
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector3d d =
        (line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0]).normalized();
    out.push_back(line[i] + offset * Eigen::Vector3d(-d.y(), d.x(), 0.0));
    offset = keep * offset + std::sqrt(1.0 - keep * keep) * random.normal(0.0, scatter_m);
  }
  return out;
}

}  // namespace

Lot random_lot(int shape, std::uint64_t seed) {
  Random random(seed, "lot");
  const std::vector<std::string> names{"aisles",       "dead ends", "figure 8",        "crossings",
                                       "one-way ring", "T",         "ring with way in"};
  Lot lot;
  switch (shape) {
    case 0:
      lot = ladder(3 + static_cast<int>(random.below(3)), random);
      break;
    case 1:
      lot = dead_ends(random);
      break;
    case 2:
      lot = figure_eight(random);
      break;
    case 3:
      lot = crossings(random);
      break;
    case 4:
      lot = one_way_ring(random);
      break;
    case 5:
      lot = t_junction(random);
      break;
    default:
      lot = ring_with_way_in(random);
  }
  lot.name = names[static_cast<std::size_t>(shape)];
  const double angle = random.uniform(0.0, 6.283185307179586);
  for (Eigen::Vector3d& p : lot.places) {
    p = at(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
           std::sin(angle) * p.x() + std::cos(angle) * p.y());
  }
  return lot;
}

std::vector<DrivenPass> drive_lot(
    const Lot& lot, int laps, double scatter_m, double step_m, std::uint64_t seed) {
  Random random(seed, "drive");
  std::vector<DrivenPass> passes;
  Move last = lot.roads.front();
  double offset = random.normal(0.0, scatter_m);
  for (int lap = 0; lap < laps; ++lap) {
    const std::vector<int> route = lap_route(lot, last, random);
    std::vector<Eigen::Vector3d> corners;
    bool reversing = false;
    const auto flush = [&] {
      if (corners.size() < 2) return;
      const auto line = rounded(dense(corners, step_m), step_m);
      passes.push_back({0, reversing, scattered(line, scatter_m, step_m, offset, random)});
    };
    for (std::size_t i = 0; i < route.size(); ++i) {
      corners.push_back(lot.places[static_cast<std::size_t>(route[i])]);
      if (i == 0 || i + 1 == route.size() || route[i - 1] != route[i + 1]) continue;
      flush();
      corners = {corners.back()};
      reversing = !reversing;
    }
    flush();
  }
  return passes;
}

}  // namespace roadbook::test
