#include "mapping/corner_tracks.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "base/parallel.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMaxRays = 16;

class UnionFind {
 public:
  explicit UnionFind(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) {
      int& p = parent_[static_cast<std::size_t>(i)];
      p = parent_[static_cast<std::size_t>(p)];
      i = p;
    }
    return i;
  }
  // The smaller index stays root: independent of the order of the pairs.
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

std::vector<CornerTrack> join_tracks(const VoResult& odometry,
                                     const std::vector<std::pair<int, int>>& same) {
  UnionFind sets(odometry.tracks.size());
  for (const auto& [a, b] : same) sets.join(a, b);
  std::vector<int> place(odometry.tracks.size(), -1);
  std::vector<CornerTrack> joined;
  for (std::size_t t = 0; t < odometry.tracks.size(); ++t) {
    const Track& track = odometry.tracks[t];
    const int root = sets.find(static_cast<int>(t));
    int& index = place[static_cast<std::size_t>(root)];
    if (index < 0) {
      index = static_cast<int>(joined.size());
      joined.emplace_back();
    }
    CornerTrack& corner = joined[static_cast<std::size_t>(index)];
    corner.revisited |= !corner.views.empty();
    for (const auto& o : track.observations)
      corner.views.push_back({o.keyframe, track.camera, o.feature});
  }
  for (auto& corner : joined) {
    const auto image = [](const CornerView& v) { return std::tuple(v.keyframe, v.camera); };
    std::stable_sort(corner.views.begin(), corner.views.end(),
                     [&](const CornerView& a, const CornerView& b) { return image(a) < image(b); });
    const auto last =
        std::unique(corner.views.begin(), corner.views.end(),
                    [&](const CornerView& a, const CornerView& b) { return image(a) == image(b); });
    corner.views.erase(last, corner.views.end());
  }
  std::erase_if(joined, [](const CornerTrack& c) { return c.views.size() < 2; });
  return joined;
}

void triangulate_corners(const MappingInput& input,
                         const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                         const TriangulationOptions& options,
                         std::vector<CornerTrack>& tracks) {
  constexpr std::size_t kBlock = 512;
  const auto solve = [&](CornerTrack& track) {
    track.p_map.reset();
    if (track.views.size() < 2) return;
    std::vector<Ray> rays;
    double focal = 1.0;
    const std::size_t used = std::min(track.views.size(), kMaxRays);
    for (std::size_t r = 0; r < used; ++r) {
      const CornerView& view = track.views[r * (track.views.size() - 1) / (used - 1)];
      const auto& mounted =
          input.rig_of(view.keyframe).cameras[static_cast<std::size_t>(view.camera)];
      const auto bearing = mounted.camera.bearing(input.pixel(view));
      if (!bearing) continue;
      focal = mounted.camera.focal_px();
      const Eigen::Isometry3d T =
          T_map_vehicle[static_cast<std::size_t>(view.keyframe)] * mounted.T_vehicle_camera;
      rays.push_back({T.translation(), T.linear() * *bearing});
    }
    const auto point = triangulate(rays, options.min_parallax_rad);
    if (!point || !(point->max_error_rad * focal <= options.max_error_px)) return;
    if (!((point->p_world - rays.front().origin).norm() <= options.max_range_m)) return;
    track.p_map = point->p_world;
  };
  parallel_for((tracks.size() + kBlock - 1) / kBlock, options.num_threads, [&](std::size_t block) {
    const std::size_t end = std::min(tracks.size(), (block + 1) * kBlock);
    for (std::size_t i = block * kBlock; i < end; ++i) solve(tracks[i]);
  });
}

}  // namespace roadbook
