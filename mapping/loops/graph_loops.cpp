#include "mapping/loops/graph_loops.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/index.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMany = 2000;
constexpr int kGroups = 1000;

}  // namespace

std::vector<std::size_t> loops_of_graph(const std::vector<LoopClosure>& loops,
                                        const std::vector<int>& segment) {
  std::vector<std::size_t> accepted;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (loops[i].edge.accepted) accepted.push_back(i);
  if (accepted.size() <= kMany) return accepted;
  const int group = 1 + static_cast<int>(segment.size()) / kGroups;  // keyframes
  std::map<std::pair<int, int>, std::size_t> latest;  // by group of later ones and segment
  for (const std::size_t i : accepted) {
    const LoopEdge& edge = loops[i].edge;
    const auto [found, is_new] = latest.try_emplace({edge.to / group, segment[at(edge.from)]}, i);
    if (!is_new && edge.from > loops[found->second].edge.from) found->second = i;
  }
  std::vector<std::size_t> kept;
  for (const auto& [key, i] : latest) kept.push_back(i);
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace roadbook
