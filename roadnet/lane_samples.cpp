#include "roadnet/lane_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadnet/floor_height.hpp"
#include "roadnet/samples.hpp"
#include "roadnet/spatial_hash.hpp"

namespace roadbook {
namespace {

// A piece of a lane's polyline.
struct Chord {
  std::size_t lane;
  Eigen::Vector3d begin;
  Eigen::Vector3d along;
  double s_begin_m;
};

class Finder {
 public:
  Finder(const RoadNetwork& network, double reach_m) : reach_m_(reach_m), hash_(2.0 * reach_m) {
    for (std::size_t l = 0; l < network.lanes.size(); ++l) {
      const auto& line = network.lanes[l].centre;
      double s = 0.0;
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        // Long chords are cut, so that their middles find them.
        const Eigen::Vector3d d = line[i + 1] - line[i];
        const int parts = std::max(1, static_cast<int>(std::ceil(d.norm() / reach_m)));
        for (int k = 0; k < parts; ++k) {
          chords_.push_back({l, line[i] + d * k / parts, d / parts, s + d.norm() * k / parts});
          hash_.insert(flat(chords_.back().begin + 0.5 * chords_.back().along));
        }
        s += d.norm();
      }
    }
  }

  // Nearest chord and place on it; null where no chord is within reach.
  const Chord* nearest(const Eigen::Vector3d& p, double& s_m) const {
    const Chord* best = nullptr;
    double best2 = reach_m_ * reach_m_;
    hash_.visit_near(flat(p), 1.5 * reach_m_, [&](int index, double) {
      const Chord& chord = chords_[static_cast<std::size_t>(index)];
      const double length2 = chord.along.head<2>().squaredNorm();
      if (length2 == 0.0) return;
      const double share =
          std::clamp((p - chord.begin).head<2>().dot(chord.along.head<2>()) / length2, 0.0, 1.0);
      const Eigen::Vector3d d = chord.begin + share * chord.along - p;
      const double d2 = d.head<2>().squaredNorm();
      if (std::abs(d.z()) > kFloorHeight_m || d2 > best2) return;
      if (d2 == best2 && best != nullptr && best < &chord) return;
      best = &chord;
      best2 = d2;
      s_m = chord.s_begin_m + share * chord.along.norm();
    });
    return best;
  }

 private:
  static Eigen::Vector3d flat(const Eigen::Vector3d& p) { return {p.x(), p.y(), 0.0}; }

  double reach_m_;
  SpatialHash hash_;
  std::vector<Chord> chords_;
};

}  // namespace

std::vector<LaneSamples> samples_by_lane(const RoadNetwork& network,
                                         const std::vector<DrivenPass>& passes,
                                         double step_m,
                                         double reach_m,
                                         double junction_m) {
  std::vector<LaneSamples> samples(network.lanes.size());
  const Finder finder(network, reach_m);
  for (const DrivenPass& pass : passes) {
    for (const Eigen::Vector3d& p : resample(pass, step_m).points) {
      double s = 0.0;
      const Chord* chord = finder.nearest(p, s);
      if (chord == nullptr) continue;
      const Lane& lane = network.lanes[chord->lane];
      const double left_out = std::min(junction_m, lane.length_m / 3.0);
      if (lane.from_intersection >= 0 && s < left_out) continue;
      if (lane.to_intersection >= 0 && s > lane.length_m - left_out) continue;
      samples[chord->lane].points.push_back(p);
      samples[chord->lane].share.push_back(std::clamp(s / lane.length_m, 0.0, 1.0));
    }
  }
  return samples;
}

}  // namespace roadbook
