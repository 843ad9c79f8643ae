#include "workflows/compare/landmark_matches.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace roadbook {
namespace {

struct CommonViews {
  int count = 0;
  int keyframe = 0;  // the first in A
};

using ViewsOfPair = std::map<std::pair<int, int>, CommonViews>;

using ImageKey = std::pair<int, int>;  // keyframe, camera

std::map<ImageKey, std::vector<const Observation*>> by_image(const Map& map) {
  std::map<ImageKey, std::vector<const Observation*>> images;
  for (const Observation& o : map.observations) images[{o.keyframe, o.camera}].push_back(&o);
  return images;
}

// An image has a few hundred observations: all pairs are compared.
ViewsOfPair common_views(const Map& a, const Map& b, const std::vector<int>& same) {
  ViewsOfPair pairs;
  const auto images_of_b = by_image(b);
  for (const auto& [image, in_a] : by_image(a)) {
    const int keyframe_of_b = same[static_cast<std::size_t>(image.first)];
    const auto in_b = images_of_b.find({keyframe_of_b, image.second});
    if (keyframe_of_b < 0 || in_b == images_of_b.end()) continue;
    for (const Observation* o : in_a)
      for (const Observation* p : in_b->second) {
        if (!((o->pixel - p->pixel).norm() <= kSameCornerPx)) continue;
        CommonViews& views = pairs[{o->landmark, p->landmark}];
        if (views.count++ == 0) views.keyframe = image.first;
      }
  }
  return pairs;
}

}  // namespace

std::vector<LandmarkMatch> landmark_matches(const Map& a,
                                            const Map& b,
                                            const std::vector<int>& same) {
  const ViewsOfPair views = common_views(a, b, same);
  std::vector<const ViewsOfPair::value_type*> pairs;
  for (const auto& pair : views) pairs.push_back(&pair);
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto* one, const auto* other) {
    return one->second.count > other->second.count;
  });
  std::vector<bool> taken_a(a.landmarks.size());
  std::vector<bool> taken_b(b.landmarks.size());
  std::vector<LandmarkMatch> matches;
  for (const auto* pair : pairs) {
    const auto [in_a, in_b] = pair->first;
    if (taken_a[static_cast<std::size_t>(in_a)] || taken_b[static_cast<std::size_t>(in_b)])
      continue;
    taken_a[static_cast<std::size_t>(in_a)] = true;
    taken_b[static_cast<std::size_t>(in_b)] = true;
    matches.push_back({in_a, in_b, pair->second.keyframe});
  }
  return matches;
}

}  // namespace roadbook
