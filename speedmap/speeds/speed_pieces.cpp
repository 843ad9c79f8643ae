#include "speedmap/speeds/speed_pieces.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

constexpr double kGrid_m = 0.5;
constexpr int kMostSpeedSteps = 4000;

struct CutGrid {
  double begin_m;
  double step_m;
  int steps;
  [[nodiscard]] double at(int i) const { return begin_m + i * step_m; }
};

// Least and most number of grid steps in a piece, so that a division always exists.
struct PieceSteps {
  int least;
  int most;
};

PieceSteps allowed_steps(const CutGrid& grid, const SpeedPieceOptions& options) {
  const double most = std::min(options.longest_m / grid.step_m, static_cast<double>(grid.steps));
  PieceSteps allowed{};
  allowed.most = std::max(1, static_cast<int>(std::floor(most + 1e-9)));
  const int pieces = std::max(options.at_least, (grid.steps + allowed.most - 1) / allowed.most);
  const int wanted = static_cast<int>(std::ceil(options.shortest_m / grid.step_m - 1e-9));
  allowed.least = std::clamp(wanted, 1, std::max(1, grid.steps / pieces));
  return allowed;
}

// Cuts with the least travel time and cost of pieces: their grid places, the end first. Empty where
// `may_end` allows none.
std::vector<int> best_cuts(const std::vector<double>& speeds,
                           const CutGrid& grid,
                           const PieceSteps& allowed,
                           const std::vector<bool>& may_end,
                           double further_cut_s) {
  std::vector<double> cost(static_cast<std::size_t>(grid.steps) + 1, INFINITY);
  std::vector<int> from(cost.size(), -1);
  cost[0] = 0.0;
  for (int end = allowed.least; end <= grid.steps; ++end) {
    if (!may_end[static_cast<std::size_t>(end)]) continue;
    double least = INFINITY;
    for (int length = 1; length <= std::min(allowed.most, end); ++length) {
      const auto begin = static_cast<std::size_t>(end - length);
      least = std::min(least, speeds[begin]);
      if (length < allowed.least) continue;
      const double total = cost[begin] + length * grid.step_m / least + further_cut_s;
      if (!(total < cost[static_cast<std::size_t>(end)])) continue;
      cost[static_cast<std::size_t>(end)] = total;
      from[static_cast<std::size_t>(end)] = static_cast<int>(begin);
    }
  }
  if (from.back() < 0) return {};
  std::vector<int> cuts{grid.steps};
  while (cuts.back() > 0) {
    ROADBOOK_ASSERT(from[static_cast<std::size_t>(cuts.back())] >= 0);
    cuts.push_back(from[static_cast<std::size_t>(cuts.back())]);
  }
  return cuts;
}

// Halves the longest piece until there are enough.
void split_until(std::vector<SpeedPiece>& pieces, const LeastSpeed& least_speed, int at_least) {
  while (static_cast<int>(pieces.size()) < at_least) {
    const auto longest = std::max_element(
        pieces.begin(), pieces.end(),
        [](const SpeedPiece& a, const SpeedPiece& b) { return a.length_m() < b.length_m(); });
    const double middle = 0.5 * (longest->begin_m + longest->end_m);
    const SpeedPiece second{middle, longest->end_m, least_speed(middle, longest->end_m)};
    longest->end_m = middle;
    longest->speed = least_speed(longest->begin_m, middle);
    pieces.insert(longest + 1, second);
  }
}

}  // namespace

void SpeedPieceOptions::check() const {
  require_option(shortest_m > 0.0 && shortest_m <= longest_m, "shortest_m", shortest_m,
                 "above 0, to longest_m");
  require_option(at_least >= 1 && at_least <= 1000, "at_least", at_least, "1 to 1000");
  require_option(further_cut_s >= 0.0 && further_cut_s <= 1e3, "further_cut_s", further_cut_s,
                 "0 to 1000");
}

std::vector<SpeedPiece> speed_pieces(const LeastSpeed& least_speed,
                                     double begin_m,
                                     double end_m,
                                     const SpeedPieceOptions& options) {
  options.check();
  ROADBOOK_ASSERT(end_m > begin_m);
  const double length = end_m - begin_m;
  // A grid that the longest piece fits: at least that many steps as pieces are needed.
  const double needed = std::max(length / kGrid_m, 2.0 * length / options.longest_m);
  const int steps = std::clamp(static_cast<int>(std::ceil(needed)), 1, kMostSpeedSteps);
  const CutGrid grid{begin_m, length / steps, steps};
  std::vector<double> speeds;
  for (int i = 0; i < steps; ++i) speeds.push_back(least_speed(grid.at(i), grid.at(i + 1)));
  const PieceSteps allowed = allowed_steps(grid, options);
  std::vector<bool> may_end(static_cast<std::size_t>(steps) + 1, true);
  if (options.may_cut)
    for (int i = 0; i < steps; ++i)
      may_end[static_cast<std::size_t>(i)] = options.may_cut(grid.at(i));
  auto cuts = best_cuts(speeds, grid, allowed, may_end, options.further_cut_s);
  if (cuts.empty()) {
    may_end.assign(may_end.size(), true);
    cuts = best_cuts(speeds, grid, allowed, may_end, options.further_cut_s);
  }
  ROADBOOK_ASSERT(!cuts.empty());
  std::vector<SpeedPiece> pieces;
  for (std::size_t k = cuts.size() - 1; k > 0; --k) {
    const double from = grid.at(cuts[k]);
    const double to = cuts[k - 1] == steps ? end_m : grid.at(cuts[k - 1]);
    pieces.push_back({from, to, least_speed(from, to)});
  }
  split_until(pieces, least_speed, options.at_least);
  return pieces;
}

}  // namespace roadbook
