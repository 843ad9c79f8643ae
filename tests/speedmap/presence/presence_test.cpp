#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"
#include "speedmap/presence/presence_map.hpp"

namespace roadbook {
namespace {

// A random graph: a ring with chords, random priors, weights over four decades.
PresenceGraph random_graph(Random& random, int size) {
  PresenceGraph graph;
  const auto weight = [&] { return std::pow(10.0, random.uniform(-2.0, 2.0)); };
  for (int i = 0; i < size; ++i) graph.nodes.push_back({random.uniform(), weight()});
  for (int i = 0; i + 1 < size; ++i) graph.edges.push_back({i, i + 1, weight()});
  for (int i = 0; i + 7 < size; i += 3) graph.edges.push_back({i + 7, i, weight()});
  return graph;
}

std::vector<PresenceObservation> random_observations(Random& random, int size, int count) {
  std::vector<PresenceObservation> list;
  for (int k = 0; k < count; ++k)
    list.push_back({static_cast<int>(random.below(static_cast<std::uint64_t>(size))),
                    random.uniform(), random.uniform(0.0, 5.0)});
  return list;
}

PresenceGraph square(int side, double prior, double weight, double pull) {
  PresenceGraph graph;
  for (int i = 0; i < side * side; ++i) graph.nodes.push_back({prior, weight});
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      if (x + 1 < side) graph.edges.push_back({y * side + x, y * side + x + 1, pull});
      if (y + 1 < side) graph.edges.push_back({y * side + x, y * side + x + side, pull});
    }
  return graph;
}

// Sum over the printed sums (2) and (3): every edge from both its ends, all weights 1.
double printed_energy(const Eigen::VectorXd& x,
                      const std::vector<double>& priors,
                      const std::vector<std::pair<int, int>>& edges,
                      const std::vector<std::pair<int, double>>& z) {
  double sum = 0.0;
  for (std::size_t i = 0; i < priors.size(); ++i)
    sum += std::pow(x[static_cast<Eigen::Index>(i)] - priors[i], 2);
  for (const auto& [a, b] : edges) sum += 2.0 * std::pow(x[a] - x[b], 2);
  for (const auto& [node, value] : z) sum += std::pow(value - x[node], 2);
  return sum;
}

// Figure 5: seven places in two rows, a crossing among lanes and spaces, two observations z_a1,
// z_a2 at place a and one at place b. The judge minimises the printed sums without any matrix.
TEST(Presence, TheGraphOfFigure5HasTheMinimumOfThePrintedSums) {
  const std::vector<double> priors{0.05, 0.3, 0.3, 0.05, 0.02, 0.02, 0.1};
  const std::vector<std::pair<int, int>> edges{{0, 1}, {1, 2}, {2, 3}, {4, 5},
                                               {5, 6}, {0, 4}, {1, 5}, {2, 6}};
  const int a = 1;
  const int b = 6;
  const std::vector<std::pair<int, double>> z{{a, 1.0}, {a, 1.0}, {b, 1.0}};
  PresenceGraph graph;
  for (const double prior : priors) graph.nodes.push_back({prior, 1.0});
  for (const auto& [from, to] : edges) graph.edges.push_back({from, to, 2.0});
  PresenceMap map(graph);
  map.add(std::vector<PresenceObservation>{{a, 1.0, 1.0}, {a, 1.0, 1.0}, {b, 1.0, 1.0}});
  map.solve();

  Eigen::VectorXd x = Eigen::VectorXd::Zero(7);  // one coordinate at a time to its minimum
  const auto energy = [&](const Eigen::VectorXd& at) {
    return printed_energy(at, priors, edges, z);
  };
  for (int sweep = 0; sweep < 400; ++sweep)
    for (Eigen::Index i = 0; i < 7; ++i) {
      Eigen::VectorXd up = x;
      Eigen::VectorXd down = x;
      up[i] += 0.5;
      down[i] -= 0.5;
      const double slope = energy(up) - energy(down);
      x[i] -= slope / (4.0 * (energy(up) + energy(down) - 2.0 * energy(x))) * 2.0 * 0.5;
    }
  EXPECT_LT((map.presence() - x).cwiseAbs().maxCoeff(), 1e-9) << map.presence().transpose();
  EXPECT_GT(map.presence()[a], map.presence()[2]) << "seen twice";
}

// (1 + 2 + 2) a - 2 b = 1/4 + 2 and (1 + 2) b - 2 a = 0.
TEST(Presence, TwoPlacesByHand) {
  PresenceMap map(PresenceGraph{{{0.25, 1.0}, {0.0, 1.0}}, {{0, 1, 2.0}}});
  map.add(std::vector<PresenceObservation>{{0, 1.0, 1.0}, {0, 1.0, 1.0}});
  map.solve();
  EXPECT_NEAR(map.presence()[0], 27.0 / 44.0, 1e-15);
  EXPECT_NEAR(map.presence()[1], 18.0 / 44.0, 1e-15);
}

TEST(Presence, TheSparseSolveIsTheDenseOneAndStaysWithinItsData) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Random random(seed, "presence");
    const int n = 5 + static_cast<int>(random.below(40));
    const PresenceGraph graph = random_graph(random, n);
    const auto observations = random_observations(random, n, 2 * n);
    PresenceMap map(graph);
    map.add(observations);
    map.solve();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    double low = 1.0;
    double high = 0.0;
    const auto pull = [&](int node, double value, double weight) {
      A(node, node) += weight;
      b[node] += weight * value;
      low = std::min(low, value);
      high = std::max(high, value);
    };
    for (int i = 0; i < n; ++i) {
      const PresenceNode& node = graph.nodes[static_cast<std::size_t>(i)];
      pull(i, node.prior, node.weight);
    }
    for (const PresenceObservation& z : observations) pull(z.node, z.value, z.weight);
    for (const PresenceEdge& e : graph.edges) {
      A(e.a, e.a) += e.weight;
      A(e.b, e.b) += e.weight;
      A(e.a, e.b) -= e.weight;
      A(e.b, e.a) -= e.weight;
    }
    EXPECT_LT((map.presence() - A.fullPivLu().solve(b)).cwiseAbs().maxCoeff(), 1e-10) << seed;
    EXPECT_GE(map.presence().minCoeff(), low);
    EXPECT_LE(map.presence().maxCoeff(), high);
    const Eigen::VectorXd variances = map.variances();
    const Eigen::VectorXd dense = A.inverse().diagonal();
    EXPECT_LT((variances - dense).cwiseQuotient(dense).cwiseAbs().maxCoeff(), 1e-10) << seed;
  }
}

// A lattice too large for the factor: Eigen's own factor judges. The weak priors of the second need
// more steps than conjugate gradients may take.
TEST(Presence, ManyPlacesAreSolvedAsAFactorSolvesThem) {
  for (const double prior_weight : {1.0, 1e-7}) {
    Random random(5, "many");
    const int side = 80;
    PresenceGraph graph = square(side, 0.1, 1.0, 2.25);
    for (PresenceNode& node : graph.nodes)
      node = {random.uniform(), prior_weight * random.uniform(0.5, 2.0)};
    for (PresenceEdge& edge : graph.edges) edge.weight *= std::pow(10.0, random.uniform(-1.0, 1.0));
    PresenceMap map(graph);
    map.add(random_observations(random, side * side, prior_weight < 1.0 ? 3 : side * side));
    map.solve();
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor(map.matrix());
    const Eigen::VectorXd x = factor.solve(map.right_hand_side());
    EXPECT_LT((map.presence() - x).cwiseAbs().maxCoeff(), prior_weight < 1.0 ? 1e-7 : 2e-12);
  }
}

TEST(Presence, TheSolutionIsWhereTheEnergyIsFlat) {
  Random random(1, "flat");
  PresenceMap map(random_graph(random, 30));
  map.add(random_observations(random, 30, 40));
  map.solve();
  const double h = 1e-4;
  for (Eigen::Index i = 0; i < 30; ++i) {
    Eigen::VectorXd up = map.presence();
    Eigen::VectorXd down = up;
    up[i] += h;
    down[i] -= h;
    EXPECT_NEAR((map.energy(up) - map.energy(down)) / (2.0 * h), 0.0, 1e-8);
  }
}

// Draws from the posterior: every term of E pushes with the square root of its weight, which gives
// A^-1 noise the covariance A^-1.
TEST(Presence, VariancesAreThoseOfDrawsFromThePosterior) {
  const int side = 15;
  const PresenceGraph graph = square(side, 0.1, 1.0, 4.0);
  Random random(3, "draws");
  const auto observations = random_observations(random, side * side, 60);
  PresenceMap map(graph);
  map.add(observations);
  map.solve();
  const Eigen::MatrixXd lower = map.matrix();
  const Eigen::LLT<Eigen::MatrixXd> A(lower.selfadjointView<Eigen::Lower>().toDenseMatrix());
  const int draws = 4000;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(side * side);
  for (int k = 0; k < draws; ++k) {
    Eigen::VectorXd noise = Eigen::VectorXd::Zero(side * side);
    for (int i = 0; i < side * side; ++i) noise[i] += random.normal();
    for (const PresenceObservation& z : observations)
      noise[z.node] += std::sqrt(z.weight) * random.normal();
    for (const PresenceEdge& e : graph.edges) {
      const double push = std::sqrt(e.weight) * random.normal();
      noise[e.a] += push;
      noise[e.b] -= push;
    }
    squares += A.solve(noise).cwiseAbs2();
  }
  const Eigen::ArrayXd ratio = (squares / draws).cwiseQuotient(map.variances()).array();
  EXPECT_NEAR(ratio.mean(), 1.0, 0.01);
  // A variance of 4000 draws is off by 2.2 %: four times that.
  EXPECT_LT((ratio - 1.0).abs().maxCoeff(), 0.09);
}

TEST(Presence, ALocalUpdateIsAsGoodAsItSaysAndTouchesLittle) {
  const int side = 200;
  PresenceMap local(square(side, 0.1, 1.0, 4.0));
  PresenceMap whole(square(side, 0.1, 1.0, 4.0));
  local.solve();
  const double tolerance = 1e-8;
  for (const int node : {100 * side + 100, 100 * side + 102, 40 * side + 40}) {
    const std::vector<PresenceObservation> seen{{node, 1.0, 2.0}};
    local.add(seen);
    whole.add(seen);
    const PresenceUpdate update = local.update(tolerance);
    whole.solve();
    EXPECT_LE(update.error_bound, tolerance);
    EXPECT_LE((local.presence() - whole.presence()).cwiseAbs().maxCoeff(),
              update.error_bound + 1e-13);
    EXPECT_LT(update.solved, whole.size() / 4);
  }
  // Observations at all places are solved globally.
  std::vector<PresenceObservation> all;
  for (int i = 0; i < side * side; ++i) all.push_back({i, 0.0, 0.5});
  local.add(all);
  whole.add(all);
  EXPECT_EQ(local.update(tolerance).solved, local.size());
  whole.solve();
  EXPECT_EQ(local.presence(), whole.presence());
}

TEST(Presence, AMillionRandomUpdatesLeaveProbabilities) {
  const int side = 40;
  PresenceMap map(square(side, 0.1, 1.0, 4.0));
  Random random(5, "million");
  for (int round = 0; round < 1000; ++round) {
    std::vector<PresenceObservation> seen;
    const double scale = std::pow(10.0, random.uniform(-6.0, 3.0));
    for (int k = 0; k < 1000; ++k)
      seen.push_back({static_cast<int>(random.below(side * side)),
                      random.uniform() < 0.5 ? 0.0 : 1.0, scale * random.uniform()});
    map.add(seen);
    if (round % 50 == 0) (void)map.update();
  }
  map.solve();
  EXPECT_TRUE(map.presence().allFinite());
  EXPECT_GE(map.presence().minCoeff(), 0.0);
  EXPECT_LE(map.presence().maxCoeff(), 1.0);
  EXPECT_GT(map.variances().minCoeff(), 0.0);
}

// A solution that nobody asks for costs as much as the one after the observations.
TEST(Presence, IsSolvedWhenItIsAskedForAndNotBefore) {
  PresenceGraph graph = square(4, 0.2, 1.0, 1.0);
  graph.nodes[5].prior = 0.9;
  PresenceMap map(graph);
  EXPECT_EQ(map.presence()[5], 0.9);
  EXPECT_EQ(map.presence()[6], 0.2);
  PresenceMap solved(graph);
  solved.solve();
  EXPECT_LT(solved.presence()[5], 0.8);
  EXPECT_EQ(map.update().solved, map.size()) << "the first time, nothing is known";
  EXPECT_EQ(map.presence(), solved.presence());
  EXPECT_EQ(map.update().solved, 0U);
}

TEST(Presence, BadInputIsNamedAndChangesNothing) {
  PresenceMap map(square(4, 0.2, 1.0, 1.0));
  map.solve();
  const Eigen::VectorXd before = map.presence();
  for (const PresenceObservation& bad : std::vector<PresenceObservation>{{16, 1.0, 1.0},
                                                                         {-1, 1.0, 1.0},
                                                                         {0, 1.5, 1.0},
                                                                         {0, NAN, 1.0},
                                                                         {0, 1.0, -1.0},
                                                                         {0, 1.0, INFINITY}}) {
    EXPECT_THROW(map.add(std::vector<PresenceObservation>{{3, 1.0, 1.0}, bad}), BadInput);
    map.solve();
    EXPECT_EQ(map.presence(), before);
  }
  const auto refuse = [](const PresenceGraph& graph) {
    EXPECT_THROW(PresenceMap{graph}, InvalidOption);
  };
  refuse({});
  refuse({{{1.2, 1.0}}, {}});
  refuse({{{0.5, 0.0}}, {}});
  refuse({{{0.5, 1.0}, {0.5, 1.0}}, {{0, 1, -1.0}}});
  refuse({{{0.5, 1.0}, {0.5, 1.0}}, {{0, 0, 1.0}}});
  refuse({{{0.5, 1.0}, {0.5, 1.0}}, {{0, 2, 1.0}}});
  refuse({{{0.5, 1.0}, {0.5, 1.0}}, {{0, 1, 1.0}, {1, 0, 1.0}}});
}

}  // namespace
}  // namespace roadbook
