#include "roadnet/routing/routing.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/astar_search.hpp>
#include <boost/graph/breadth_first_search.hpp>
#include <cmath>

#include "base/error.hpp"
#include "roadnet/routing/route_states.hpp"

namespace roadbook {
namespace {

using Graph = boost::adjacency_list<boost::vecS,
                                    boost::vecS,
                                    boost::directedS,
                                    boost::no_property,
                                    boost::property<boost::edge_weight_t, double>>;
using Vertex = std::size_t;

// Straight distance to the goal: no route is cheaper.
class Bound : public boost::astar_heuristic<Graph, double> {
 public:
  Bound(const std::vector<Eigen::Vector3d>& places, const Eigen::Vector3d& goal)
      : places_(places), goal_(goal) {}
  double operator()(Vertex v) const { return (places_[v] - goal_).norm(); }

 private:
  const std::vector<Eigen::Vector3d>& places_;
  Eigen::Vector3d goal_;
};

struct Onward {
  Vertex from, to;
  double cost_m;
};

// The graph of one question: the states, its start and goal, and states cut short at the start.
struct Query {
  std::vector<Onward> edges;
  std::vector<Eigen::Vector3d> places;  // of the vertices
  std::vector<std::size_t> begun;       // states of the vertices after the goal
  Vertex start = 0;
  Vertex goal = 0;
};

struct Arrived {};

class StopAt : public boost::default_astar_visitor {
 public:
  explicit StopAt(Vertex goal) : goal_(goal) {}
  void examine_vertex(Vertex v, const Graph&) const {
    if (v == goal_) throw Arrived{};
  }

 private:
  Vertex goal_;
};

}  // namespace

// Vertices 0 to n-1 are the states, at their beginning; an edge is the whole of a state and going
// over to the next. A query adds, for its start, states cut short.
struct Router::Impl {
  RoadNetwork network;
  RoutingOptions options;
  std::vector<LaneState> states;
  std::vector<Onward> onward;
  std::vector<int> island;  // of each lane: lanes of one island touch, whatever their direction

  void add_onward(std::vector<Onward>& edges,
                  Vertex from,
                  const LaneState& state,
                  double rest_m) const {
    for (std::size_t b = 0; b < states.size(); ++b) {
      const auto cost = transition_cost(state, states[b], options);
      if (cost) edges.push_back({from, b, rest_m * state.cost_per_m + *cost});
    }
  }

  void number_islands() {
    std::vector<int> at_intersection(network.intersections.size(), -1);
    island.resize(network.lanes.size());
    for (std::size_t l = 0; l < island.size(); ++l) island[l] = static_cast<int>(l);
    const auto join = [&](int a, int b) {
      const int low = std::min(a, b);
      const int high = std::max(a, b);
      for (int& i : island)
        if (i == high) i = low;
    };
    for (std::size_t l = 0; l < island.size(); ++l) {
      for (const int end : {network.lanes[l].from_intersection, network.lanes[l].to_intersection}) {
        if (end < 0) continue;
        int& first = at_intersection[static_cast<std::size_t>(end)];
        if (first >= 0)
          join(island[static_cast<std::size_t>(first)], island[l]);
        else
          first = static_cast<int>(l);
      }
    }
  }

  void check_place(const char* which, const NetworkPlace& place) const {
    const bool there = place.lane >= 0 && place.lane < static_cast<int>(network.lanes.size());
    if (!there)
      throw InvalidOption(which, "lane " + std::to_string(place.lane), "a lane of the network");
    const double length = network.lanes[static_cast<std::size_t>(place.lane)].length_m;
    if (!(place.s_m >= -1e-6 && place.s_m <= length + 1e-6))
      throw InvalidOption(which, "s " + std::to_string(place.s_m),
                          "0 to " + std::to_string(length));
  }

  [[nodiscard]] const Lane& lane_of(const NetworkPlace& place) const {
    return network.lanes[static_cast<std::size_t>(place.lane)];
  }

  // Way to go over a state's lane from its beginning to `s_m`.
  [[nodiscard]] double way_in(const LaneState& state, double s_m) const {
    return state.along ? s_m : network.lanes[static_cast<std::size_t>(state.lane)].length_m - s_m;
  }

  [[nodiscard]] Query ask(const NetworkPlace& from, const NetworkPlace& to) const {
    Query query{onward, {}, {}, states.size(), states.size() + 1};
    for (const LaneState& state : states) query.places.push_back(state.begin);
    const Eigen::Vector3d start_place = lane_spot(lane_of(from), from.s_m).position;
    query.places.push_back(start_place);
    query.places.push_back(lane_spot(lane_of(to), to.s_m).position);
    for (std::size_t a = 0; a < states.size(); ++a) {
      const LaneState& state = states[a];
      if (state.lane == to.lane)
        query.edges.push_back({a, query.goal, way_in(state, to.s_m) * state.cost_per_m});
      if (state.lane != from.lane) continue;
      const Vertex v = query.goal + 1 + query.begun.size();
      query.begun.push_back(a);
      query.places.push_back(start_place);
      query.edges.push_back({query.start, v, 0.0});
      const double done = way_in(state, from.s_m);
      add_onward(query.edges, v, state, lane_of(from).length_m - done);
      const double ahead = way_in(state, to.s_m) - done;
      if (state.lane == to.lane && ahead >= 0.0)
        query.edges.push_back({v, query.goal, ahead * state.cost_per_m});
    }
    return query;
  }

  [[nodiscard]] Route read_back(const Query& query,
                                const std::vector<Vertex>& before,
                                double cost_m,
                                const NetworkPlace& from,
                                const NetworkPlace& to) const {
    Route route;
    route.status = RouteStatus::kFound;
    route.cost_m = cost_m;
    for (Vertex v = before[query.goal]; v != query.start; v = before[v]) {
      const bool first = v > query.goal;
      const LaneState& state = states[first ? query.begun[v - query.goal - 1] : v];
      const Lane& lane = network.lanes[static_cast<std::size_t>(state.lane)];
      const double begin_s = state.along ? 0.0 : lane.length_m;
      const double end_s = state.along ? lane.length_m : 0.0;
      route.legs.push_back({state.lane, lane.id, state.along, state.gear,
                            first ? from.s_m : begin_s, route.legs.empty() ? to.s_m : end_s});
      route.length_m += route.legs.back().length_m();
    }
    std::reverse(route.legs.begin(), route.legs.end());
    return route;
  }
};

const char* to_text(RouteStatus status) {
  switch (status) {
    case RouteStatus::kFound:
      return "found";
    case RouteStatus::kNotConnected:
      return "no chain of lanes leads there";
    case RouteStatus::kOnlyAgainstWay:
      return "lanes lead there only against the way they were driven";
  }
  return "";
}

Router::Router(const RoadNetwork& network, const RoutingOptions& options)
    : impl_(std::make_unique<Impl>()) {
  options.check();
  impl_->network = network;
  impl_->options = options;
  impl_->states = lane_states(network, options);
  for (std::size_t a = 0; a < impl_->states.size(); ++a) {
    const LaneState& state = impl_->states[a];
    impl_->add_onward(impl_->onward, a, state,
                      network.lanes[static_cast<std::size_t>(state.lane)].length_m);
  }
  impl_->number_islands();
}

Router::Router(Router&&) noexcept = default;
Router& Router::operator=(Router&&) noexcept = default;
Router::~Router() = default;

Route Router::route(const NetworkPlace& from, const NetworkPlace& to) const {
  impl_->check_place("route's start", from);
  impl_->check_place("route's end", to);
  const Query query = impl_->ask(from, to);
  Graph graph(query.places.size());
  for (const Onward& edge : query.edges) boost::add_edge(edge.from, edge.to, edge.cost_m, graph);
  std::vector<Vertex> before(query.places.size());
  std::vector<double> cost(query.places.size());
  try {
    boost::astar_search(graph, query.start, Bound(query.places, query.places[query.goal]),
                        boost::predecessor_map(before.data())
                            .distance_map(cost.data())
                            .visitor(StopAt(query.goal)));
  } catch (const Arrived&) {
    return impl_->read_back(query, before, cost[query.goal], from, to);
  }
  Route none;
  const bool touching = impl_->island[static_cast<std::size_t>(from.lane)] ==
                        impl_->island[static_cast<std::size_t>(to.lane)];
  none.status = touching ? RouteStatus::kOnlyAgainstWay : RouteStatus::kNotConnected;
  return none;
}

std::vector<Eigen::Vector3d> route_line(const RoadNetwork& network, const Route& route) {
  std::vector<Eigen::Vector3d> line;
  const auto add = [&line](const Eigen::Vector3d& p) {
    if (line.empty() || (line.back() - p).norm() > 1e-6) line.push_back(p);
  };
  for (const RouteLeg& leg : route.legs) {
    const Lane& lane = network.lanes[static_cast<std::size_t>(leg.lane)];
    add(lane_spot(lane, leg.from_s_m).position);
    std::vector<Eigen::Vector3d> inner;
    double s = 0.0;
    for (std::size_t i = 0; i < lane.centre.size(); ++i) {
      if (i > 0) s += (lane.centre[i] - lane.centre[i - 1]).norm();
      if (s > std::min(leg.from_s_m, leg.to_s_m) && s < std::max(leg.from_s_m, leg.to_s_m))
        inner.push_back(lane.centre[i]);
    }
    if (!leg.along) std::reverse(inner.begin(), inner.end());
    for (const auto& p : inner) add(p);
    add(lane_spot(lane, leg.to_s_m).position);
  }
  return line;
}

}  // namespace roadbook
