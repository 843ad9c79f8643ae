#include "mapping/loops/place_recognition.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "base/parallel.hpp"
#include "mapping/loops/vocabulary.hpp"

namespace roadbook {

PlaceIndex::PlaceIndex(const std::vector<VoKeyframe>& keyframes, int num_threads)
    : histograms_(keyframes.size()) {
  std::vector<Descriptor> sample;  // every 8th feature is plenty for growing the tree
  for (const auto& keyframe : keyframes)
    for (const auto& features : keyframe.features)
      for (std::size_t i = 0; i < features.size(); i += 8)
        sample.push_back(features.descriptors[i]);
  const Vocabulary vocabulary(sample);

  parallel_for(keyframes.size(), num_threads, [&](std::size_t k) {
    std::map<std::uint32_t, float> counts;
    for (const auto& features : keyframes[k].features)
      for (const auto& descriptor : features.descriptors)
        counts[vocabulary.word(descriptor)] += 1.0F;
    for (const auto& [word, count] : counts) histograms_[k].push_back({word, count});
  });

  std::vector<float> holders(vocabulary.word_count());
  for (const auto& histogram : histograms_)
    for (const auto& entry : histogram) holders[entry.word] += 1.0F;
  const auto total = static_cast<float>(keyframes.size());
  postings_.resize(vocabulary.word_count());
  for (std::size_t k = 0; k < histograms_.size(); ++k) {
    float sum = 0.0F;
    for (auto& entry : histograms_[k]) sum += entry.weight *= std::log(total / holders[entry.word]);
    for (auto& entry : histograms_[k]) {
      entry.weight /= std::max(sum, 1e-6F);
      postings_[entry.word].push_back({static_cast<int>(k), entry.weight});
    }
  }
}

std::vector<PlaceCandidate> PlaceIndex::similar(int query,
                                                const std::function<bool(int)>& allowed,
                                                std::size_t count,
                                                int suppress) const {
  std::vector<double> scores(static_cast<std::size_t>(query), 0.0);
  for (const auto& entry : histograms_[static_cast<std::size_t>(query)])
    for (const auto& posting : postings_[entry.word]) {
      if (posting.keyframe >= query) break;
      scores[static_cast<std::size_t>(posting.keyframe)] +=
          static_cast<double>(std::min(entry.weight, posting.weight));
    }
  std::vector<PlaceCandidate> ranked;
  for (int k = 0; k < query; ++k)
    if (scores[static_cast<std::size_t>(k)] > 0.0 && allowed(k))
      ranked.push_back({k, scores[static_cast<std::size_t>(k)]});
  std::sort(ranked.begin(), ranked.end(), [](const PlaceCandidate& a, const PlaceCandidate& b) {
    return a.score > b.score || (a.score == b.score && a.keyframe < b.keyframe);
  });
  std::vector<PlaceCandidate> best;
  for (const auto& candidate : ranked) {
    if (best.size() == count) break;
    const bool suppressed = std::any_of(best.begin(), best.end(), [&](const PlaceCandidate& b) {
      return std::abs(b.keyframe - candidate.keyframe) <= suppress;
    });
    if (!suppressed) best.push_back(candidate);
  }
  return best;
}

}  // namespace roadbook
