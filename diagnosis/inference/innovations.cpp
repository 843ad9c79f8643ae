#include "diagnosis/inference/innovations.hpp"

#include <algorithm>
#include <utility>

namespace roadbook {

Innovations rows_in_both(const Innovations& all, const Innovations& others) {
  using Key = std::pair<std::size_t, std::size_t>;
  std::vector<Key> known;
  known.reserve(others.of.size());
  for (const Innovation& i : others.of) known.emplace_back(i.drive, i.row);
  std::sort(known.begin(), known.end());
  Innovations both{all.sides, {}, {}, all.whiteness_p};
  for (std::size_t i = 0; i < all.of.size(); ++i) {
    if (!std::binary_search(known.begin(), known.end(), Key{all.of[i].drive, all.of[i].row}))
      continue;
    both.of.push_back(all.of[i]);
    both.values.insert(both.values.end(), all.row(i), all.row(i) + all.sides);
  }
  return both;
}

}  // namespace roadbook
