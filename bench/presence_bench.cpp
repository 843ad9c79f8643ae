#include <benchmark/benchmark.h>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <cmath>

#include "speedmap/presence/presence_map.hpp"

// Measures the dynamic map's solve on a square of places, from a start without observations.
// Compares it with three simple methods: CHOLMOD's and Eigen's sparse factorisation, and sweeps
// over the places until no value changes.

namespace roadbook {
namespace {

PresenceGraph square(int side) {
  PresenceGraph graph;
  graph.nodes.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), {0.05, 1.0});
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int i = y * side + x;
      if (x + 1 < side) graph.edges.push_back({i, i + 1, 2.25});
      if (y + 1 < side) graph.edges.push_back({i, i + side, 2.25});
    }
  return graph;
}

std::vector<PresenceObservation> visit(int side) {
  std::vector<PresenceObservation> seen;
  for (int i = 0; i < side * side; i += 3) seen.push_back({i, i % 97 == 0 ? 1.0 : 0.0, 1.0});
  return seen;
}

void solve(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  const PresenceMap without(square(side));
  for (auto _ : state) {
    state.PauseTiming();
    PresenceMap map = without;
    map.add(visit(side));
    state.ResumeTiming();
    map.solve();
  }
  state.counters["places"] = side * side;
}
BENCHMARK(solve)->Arg(100)->Arg(316)->Arg(1000)->Unit(benchmark::kMillisecond);

void solve_with_cholmod(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  PresenceMap map(square(side));
  map.add(visit(side));
  for (auto _ : state) {
    Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> cholesky;
    cholesky.cholmod().nmethods = 1;
    cholesky.cholmod().method[0].ordering = CHOLMOD_AMD;
    cholesky.compute(map.matrix());
    Eigen::VectorXd x = cholesky.solve(map.right_hand_side());
    benchmark::DoNotOptimize(x);
  }
  state.counters["places"] = side * side;
}
BENCHMARK(solve_with_cholmod)->Arg(100)->Arg(316)->Arg(1000)->Unit(benchmark::kMillisecond);

void solve_with_eigen(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  PresenceMap map(square(side));
  map.add(visit(side));
  for (auto _ : state) {
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky(map.matrix());
    Eigen::VectorXd x = cholesky.solve(map.right_hand_side());
    benchmark::DoNotOptimize(x);
  }
  state.counters["places"] = side * side;
}
BENCHMARK(solve_with_eigen)->Arg(100)->Arg(316)->Arg(1000)->Unit(benchmark::kMillisecond);

// Gauss-Seidel over the places until none moves by more than 1e-10.
void solve_by_sweeps(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  PresenceMap map(square(side));
  map.add(visit(side));
  const Eigen::SparseMatrix<double, Eigen::RowMajor> A =
      Eigen::SparseMatrix<double>(map.matrix().selfadjointView<Eigen::Lower>());
  for (auto _ : state) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(A.rows());
    for (double moved = 1.0; moved > 1e-10;) {
      moved = 0.0;
      for (int i = 0; i < A.rows(); ++i) {
        double rest = map.right_hand_side()[i];
        double diagonal = 1.0;
        for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator at(A, i); at; ++at)
          if (at.col() == i)
            diagonal = at.value();
          else
            rest -= at.value() * x[at.col()];
        moved = std::max(moved, std::abs(rest / diagonal - x[i]));
        x[i] = rest / diagonal;
      }
    }
    benchmark::DoNotOptimize(x);
  }
  state.counters["places"] = side * side;
}
BENCHMARK(solve_by_sweeps)->Arg(100)->Arg(316)->Arg(1000)->Unit(benchmark::kMillisecond);

void update_in_one_place(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  PresenceMap map(square(side));
  map.add(visit(side));
  map.solve();
  int node = side * side / 3;
  for (auto _ : state) {
    const std::vector<PresenceObservation> seen{{node, 1.0, 1e-3}, {node + 1, 1.0, 1e-3}};
    map.add(seen);
    benchmark::DoNotOptimize(map.update(1e-4));
    node += 7;
  }
}
BENCHMARK(update_in_one_place)->Arg(100)->Arg(316)->Arg(1000)->Unit(benchmark::kMillisecond);

void variances(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  const PresenceMap map(square(side));
  for (auto _ : state) benchmark::DoNotOptimize(map.variances());
  state.counters["places"] = side * side;
}
BENCHMARK(variances)->Arg(100)->Arg(316)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadbook
