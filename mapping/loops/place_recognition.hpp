#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "vo/keyframe_track.hpp"

namespace roadbook {

// Place recognition: finds earlier keyframes with similar images, by bags of binary words with
// tf-idf weights.

struct PlaceCandidate {
  int keyframe = 0;
  double score = 0.0;  ///< 0..1: 1 - half the L1 distance of the normalised word histograms
};

class PlaceIndex {
 public:
  /// Indexes the words of all features of all cameras of every keyframe. Deterministic.
  PlaceIndex(const std::vector<VoKeyframe>& keyframes, int num_threads);

  /// Returns up to `count` earlier keyframes (index < query) for which `allowed` is true, best
  /// first. Of several keyframes within `suppress` indices of each other it returns only the best.
  [[nodiscard]] std::vector<PlaceCandidate> similar(int query,
                                                    const std::function<bool(int)>& allowed,
                                                    std::size_t count,
                                                    int suppress) const;

 private:
  struct Entry {
    std::uint32_t word;
    float weight;
  };
  struct Posting {
    int keyframe;
    float weight;
  };
  std::vector<std::vector<Entry>> histograms_;
  std::vector<std::vector<Posting>> postings_;  // by word, ascending keyframes
};

}  // namespace roadbook
