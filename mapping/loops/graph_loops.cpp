#include "mapping/loops/graph_loops.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "base/index.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMany = 2000;
constexpr int kGroups = 1000;
constexpr int kFewBetweenSegments = 100;  // these alone place a segment and need all their votes

}  // namespace

std::vector<std::size_t> loops_of_graph(const std::vector<LoopClosure>& loops,
                                        const std::vector<int>& segment) {
  std::vector<std::size_t> accepted;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (loops[i].edge.accepted) accepted.push_back(i);
  if (accepted.size() <= kMany) return accepted;
  const auto ends = [&](std::size_t i) {
    return std::pair(segment[at(loops[i].edge.to)], segment[at(loops[i].edge.from)]);
  };
  std::map<std::pair<int, int>, int> between;
  for (const std::size_t i : accepted) ++between[ends(i)];
  const int group = 1 + static_cast<int>(segment.size()) / kGroups;  // keyframes
  std::map<std::tuple<int, int, int>, std::size_t> latest;  // by group of later ones and segments
  std::vector<std::size_t> kept;
  for (const std::size_t i : accepted) {
    const LoopEdge& edge = loops[i].edge;
    const auto [to, from] = ends(i);
    if (to != from && between[{to, from}] <= kFewBetweenSegments) {
      kept.push_back(i);
      continue;
    }
    const auto [found, is_new] = latest.try_emplace({edge.to / group, to, from}, i);
    if (!is_new && edge.from > loops[found->second].edge.from) found->second = i;
  }
  for (const auto& [key, i] : latest) kept.push_back(i);
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace roadbook
