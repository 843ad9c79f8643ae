#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// Finds the keyframes of a map near a place, with a k-d tree over their positions (FLANN, exact
/// search). Use it to anchor many labels of one map. Safe to use from several threads.
class KeyframeIndex {
 public:
  /// `map` must outlive the index and must not change. Cost: O(n log n) for n keyframes.
  explicit KeyframeIndex(const Map& map);
  ~KeyframeIndex();
  KeyframeIndex(const KeyframeIndex&) = delete;
  KeyframeIndex& operator=(const KeyframeIndex&) = delete;

  [[nodiscard]] const Map& map() const { return *map_; }

  /// Indices of the keyframes whose vehicle is at most `radius_m` from `place` (x and y, map frame
  /// [m]), ascending.
  [[nodiscard]] std::vector<std::size_t> within(const Eigen::Vector2d& place,
                                                double radius_m) const;

 private:
  struct Tree;
  const Map* map_;
  std::unique_ptr<Tree> tree_;  ///< null if the map has no keyframes
};

}  // namespace roadbook
