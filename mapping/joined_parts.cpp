#include "mapping/joined_parts.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/index.hpp"
#include "mapping/union_find.hpp"

namespace roadbook {

std::vector<int> joined_parts(const Map& map) {
  constexpr int kJoiningLandmarks = 10;
  UnionFind sets(map.keyframes.size());
  for (std::size_t k = 1; k < map.keyframes.size(); ++k)
    if (map.keyframes[k].session == map.keyframes[k - 1].session && !map.keyframes[k].after_gap)
      sets.join(static_cast<int>(k) - 1, static_cast<int>(k));
  for (const LoopEdge& loop : map.loops)
    if (loop.accepted) sets.join(loop.from, loop.to);
  std::vector<std::vector<int>> viewers(map.landmarks.size());
  for (const Observation& o : map.observations) {
    std::vector<int>& of_landmark = viewers[at(o.landmark)];
    if (of_landmark.empty() || of_landmark.back() != o.keyframe) of_landmark.push_back(o.keyframe);
  }
  const std::vector<int> part = sets.numbers();
  std::map<std::pair<int, int>, int> common;  // landmarks of two parts
  for (const std::vector<int>& of_landmark : viewers)
    for (std::size_t i = 1; i < of_landmark.size(); ++i) {
      const int a = part[at(of_landmark[i - 1])];
      const int b = part[at(of_landmark[i])];
      if (a != b && ++common[std::minmax(a, b)] == kJoiningLandmarks)
        sets.join(of_landmark[i - 1], of_landmark[i]);
    }
  return sets.numbers();
}

}  // namespace roadbook
