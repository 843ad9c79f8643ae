#include "mapping/pipeline/bundle_views.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "base/cell_grid.hpp"
#include "base/index.hpp"

namespace roadbook {
namespace {

// A keyframe this many after the previous one belongs to another pass.
constexpr int kPassGapKeyframes = 20;
constexpr double kSamePlaceM = 2.0;

Eigen::Vector3d from_corner(const CornerPass& pass,
                            const Eigen::Vector3d& p_map,
                            const std::vector<Eigen::Isometry3d>& T_map_vehicle) {
  return T_map_vehicle[at(pass.nearest)].translation() - p_map;
}

// Cosine of the angle to the most similar direction among those of `chosen`; -1 without any.
double most_similar_cosine(const std::vector<CornerPass>& passes,
                           std::size_t pass,
                           const std::vector<std::size_t>& chosen,
                           const Eigen::Vector3d& p_map,
                           const std::vector<Eigen::Isometry3d>& T_map_vehicle) {
  const Eigen::Vector3d direction = from_corner(passes[pass], p_map, T_map_vehicle).normalized();
  double cosine = -1.0;
  for (const std::size_t c : chosen)
    cosine =
        std::max(cosine, direction.dot(from_corner(passes[c], p_map, T_map_vehicle).normalized()));
  return cosine;
}

// Number of passes that the ascending keyframes belong to.
int count_passes(std::vector<int>& keyframes) {
  std::sort(keyframes.begin(), keyframes.end());
  int passes = keyframes.empty() ? 0 : 1;
  for (std::size_t i = 1; i < keyframes.size(); ++i)
    passes += keyframes[i] - keyframes[i - 1] > kPassGapKeyframes ? 1 : 0;
  return passes;
}

}  // namespace

std::vector<CornerPass> passes_of(const JoinedTrack& track,
                                  const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                  int reach_keyframes) {
  std::vector<CornerPass> passes;
  const auto& views = track.views;
  for (std::size_t begin = 0, end = 0; begin < views.size(); begin = end) {
    CornerPass pass;
    double least = std::numeric_limits<double>::max();
    for (end = begin;
         end < views.size() &&
         (end == begin || views[end].keyframe - views[end - 1].keyframe <= kPassGapKeyframes);
         ++end) {
      const int k = views[end].keyframe;
      const double distance = (T_map_vehicle[at(k)].translation() - *track.p_map).norm();
      if (distance >= least) continue;
      least = distance;
      pass.nearest = k;
    }
    for (std::size_t i = begin; i < end; ++i)
      if (std::abs(views[i].keyframe - pass.nearest) <= reach_keyframes)
        pass.views.push_back(views[i]);
    passes.push_back(std::move(pass));
  }
  return passes;
}

std::vector<std::uint8_t> find_base_keyframes(const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                              int passes) {
  std::vector<std::uint8_t> is_base(T_map_vehicle.size(), 0);
  CellGrid<int> base(kSamePlaceM);
  std::vector<int> near;
  for (std::size_t k = 0; k < T_map_vehicle.size(); ++k) {
    const Eigen::Vector3d p = T_map_vehicle[k].translation();
    const auto index = static_cast<int>(k);
    near.clear();
    base.visit_near(p.head<2>(), [&](int other) {
      if (index - other > kPassGapKeyframes &&
          (T_map_vehicle[at(other)].translation() - p).norm() < kSamePlaceM)
        near.push_back(other);
    });
    if (count_passes(near) >= passes) continue;
    is_base[k] = 1;
    base.insert(p.head<2>(), index);
  }
  return is_base;
}

std::vector<std::size_t> choose_base_passes(const std::vector<CornerPass>& passes,
                                            const Eigen::Vector3d& p_map,
                                            const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                            const std::vector<std::uint8_t>& is_base,
                                            int most) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < passes.size(); ++i)
    if (is_base[at(passes[i].nearest)] != 0) candidates.push_back(i);
  std::vector<std::size_t> chosen;
  while (static_cast<int>(chosen.size()) < most && !candidates.empty()) {
    // The first: least distance. Then: the smallest cosine to the most similar chosen direction.
    const auto cost = [&](std::size_t i) {
      return chosen.empty() ? from_corner(passes[i], p_map, T_map_vehicle).norm()
                            : most_similar_cosine(passes, i, chosen, p_map, T_map_vehicle);
    };
    const auto best =
        std::min_element(candidates.begin(), candidates.end(),
                         [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
    chosen.push_back(*best);
    candidates.erase(best);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<std::size_t> order_further_passes(const std::vector<CornerPass>& passes,
                                              const std::vector<std::size_t>& chosen,
                                              const Eigen::Vector3d& p_map,
                                              const std::vector<Eigen::Isometry3d>& T_map_vehicle) {
  std::vector<std::pair<double, std::size_t>> further;
  for (std::size_t i = 0; i < passes.size(); ++i)
    if (!std::binary_search(chosen.begin(), chosen.end(), i))
      further.emplace_back(most_similar_cosine(passes, i, chosen, p_map, T_map_vehicle), i);
  std::sort(further.begin(), further.end());
  std::vector<std::size_t> order;
  for (const auto& [cosine, i] : further) order.push_back(i);
  return order;
}

}  // namespace roadbook
