#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vo/descriptor.hpp"

namespace roadbook {

// A tree of binary words (Galvez-Lopez and Tardos 2012). It is trained on the descriptors of the
// drives themselves by k-majority clustering, so it needs no file and fits the place.

struct VocabularyOptions {
  int branching = 10;                 ///< children of a node
  int depth = 4;                      ///< levels below the root
  std::size_t max_training = 60'000;  ///< descriptors used for training, evenly chosen
  int rounds = 6;                     ///< of k-majority at each node
};

class Vocabulary {
 public:
  /// Trains the tree. Deterministic.
  Vocabulary(std::span<const Descriptor> descriptors, const VocabularyOptions& options = {});

  /// Leaf of a descriptor: 0 .. word_count()-1.
  [[nodiscard]] std::uint32_t word(const Descriptor& descriptor) const;
  [[nodiscard]] std::uint32_t word_count() const { return words_; }

 private:
  struct Node {
    Descriptor centre{};
    std::uint32_t first_child = 0;
    std::uint32_t children = 0;  ///< 0: leaf
    std::uint32_t word = 0;
  };
  void grow(std::uint32_t node,
            std::vector<Descriptor> members,
            int level,
            const VocabularyOptions& options);

  std::vector<Node> nodes_;
  std::uint32_t words_ = 0;
};

}  // namespace roadbook
