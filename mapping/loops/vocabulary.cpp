#include "mapping/loops/vocabulary.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace roadbook {
namespace {

// Bitwise majority.
Descriptor majority(const std::vector<Descriptor>& members,
                    const std::vector<std::uint32_t>& owner,
                    std::uint32_t k) {
  std::array<int, 512> ones{};
  int count = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (owner[i] != k) continue;
    ++count;
    for (std::size_t bit = 0; bit < 512; ++bit) ones[bit] += (members[i][bit / 8] >> (bit % 8)) & 1;
  }
  Descriptor centre{};
  for (std::size_t bit = 0; bit < 512; ++bit)
    if (2 * ones[bit] > count)
      centre[bit / 8] = static_cast<std::uint8_t>(centre[bit / 8] | (1U << (bit % 8)));
  return centre;
}

std::uint32_t nearest(const std::vector<Descriptor>& centres, const Descriptor& d) {
  std::uint32_t best = 0;
  int best_distance = 1000;
  for (std::uint32_t k = 0; k < centres.size(); ++k) {
    const int distance = hamming(centres[k], d);
    if (distance < best_distance) {
      best_distance = distance;
      best = k;
    }
  }
  return best;
}

}  // namespace

Vocabulary::Vocabulary(std::span<const Descriptor> descriptors, const VocabularyOptions& options) {
  std::vector<Descriptor> training;
  const std::size_t stride =
      std::max<std::size_t>(1, descriptors.size() / std::max<std::size_t>(1, options.max_training));
  for (std::size_t i = 0; i < descriptors.size(); i += stride) training.push_back(descriptors[i]);
  nodes_.emplace_back();
  grow(0, std::move(training), 0, options);
}

void Vocabulary::grow(std::uint32_t node,
                      std::vector<Descriptor> members,
                      int level,
                      const VocabularyOptions& options) {
  const auto k = static_cast<std::uint32_t>(options.branching);
  if (level == options.depth || members.size() < 2 * k) {
    nodes_[node].word = words_++;
    return;
  }
  // Seeds evenly from the members in order of the drive: they show different places.
  std::vector<Descriptor> centres;
  for (std::uint32_t i = 0; i < k; ++i) centres.push_back(members[i * members.size() / k]);
  std::vector<std::uint32_t> owner(members.size());
  for (int round = 0; round < options.rounds; ++round) {
    bool changed = false;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::uint32_t best = nearest(centres, members[i]);
      changed |= best != owner[i];
      owner[i] = best;
    }
    if (!changed && round > 0) break;
    for (std::uint32_t c = 0; c < k; ++c) centres[c] = majority(members, owner, c);
  }
  for (std::size_t i = 0; i < members.size(); ++i) owner[i] = nearest(centres, members[i]);
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first_child = first;
  nodes_[node].children = k;
  for (std::uint32_t c = 0; c < k; ++c) nodes_.push_back({centres[c], 0, 0, 0});
  std::vector<std::vector<Descriptor>> parts(k);
  for (std::size_t i = 0; i < members.size(); ++i) parts[owner[i]].push_back(members[i]);
  members = {};
  for (std::uint32_t c = 0; c < k; ++c) grow(first + c, std::move(parts[c]), level + 1, options);
}

std::uint32_t Vocabulary::word(const Descriptor& descriptor) const {
  std::uint32_t node = 0;
  while (nodes_[node].children > 0) {
    const Node& parent = nodes_[node];
    int best_distance = 1000;
    for (std::uint32_t c = parent.first_child; c < parent.first_child + parent.children; ++c) {
      const int distance = hamming(nodes_[c].centre, descriptor);
      if (distance < best_distance) {
        best_distance = distance;
        node = c;
      }
    }
  }
  return nodes_[node].word;
}

}  // namespace roadbook
