#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "base/index.hpp"

namespace roadbook {

/// Disjoint sets of 0 ... count - 1. The lowest member of a set is its root, whatever the order of
/// the joins.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[at(std::max(a, b))] = std::min(a, b);
  }
  /// Consecutive numbers of the sets, by their lowest member.
  std::vector<int> numbers() {
    std::vector<int> number(parent_.size(), -1);
    int next = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      const std::size_t root = at(find(static_cast<int>(i)));
      if (number[root] < 0) number[root] = next++;
      number[i] = number[root];
    }
    return number;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace roadbook
