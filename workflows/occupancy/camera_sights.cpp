#include "workflows/occupancy/camera_sights.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "semantics/overhead/ground_model.hpp"

namespace roadbook {
namespace {

enum class LandmarkPlace { kElsewhere, kGround, kRaised };

// Turns the observations of one session into sights.
class SightCollector {
 public:
  SightCollector(const Map& map, const GroundModel& ground, const CameraSightOptions& options)
      : map_(map), ground_(ground), options_(options) {}

  [[nodiscard]] LandmarkPlace place_of(const Landmark& landmark) const {
    if (!is_known(landmark.covariance) ||
        landmark.covariance.trace() > options_.max_sigma_m * options_.max_sigma_m)
      return LandmarkPlace::kElsewhere;
    const Eigen::Vector3d p = map_.p_map(landmark);
    const auto z = ground_.height(p.x(), p.y());
    if (!z) return LandmarkPlace::kElsewhere;
    const double height = p.z() - *z;
    if (landmark.ground && std::abs(height) < 0.5 * options_.lowest_m)
      return LandmarkPlace::kGround;
    const bool raised =
        !landmark.ground && height >= options_.lowest_m && height <= options_.highest_m;
    return raised ? LandmarkPlace::kRaised : LandmarkPlace::kElsewhere;
  }

  /// The line of sight of an observation of a landmark on the ground.
  [[nodiscard]] std::optional<CameraSight> low_sight(const Observation& seen) const {
    const Eigen::Vector3d p = map_.p_map(map_.landmarks[static_cast<std::size_t>(seen.landmark)]);
    const Eigen::Vector3d eye = eye_of(seen);
    const auto z = ground_.height(eye.x(), eye.y());
    if (!z || (eye - p).head<2>().norm() > options_.max_range_m) return std::nullopt;
    const double height = eye.z() - *z;
    if (height <= 0.0) return std::nullopt;
    CameraSight sight;
    sight.landmark = seen.landmark;
    sight.p = p.head<2>();
    sight.low = sight.p + std::min(1.0, options_.lowest_m / height) * (eye - p).head<2>();
    return sight;
  }

  [[nodiscard]] std::optional<CameraSight> raised_sight(const Observation& seen) const {
    const Landmark& landmark = map_.landmarks[static_cast<std::size_t>(seen.landmark)];
    const Eigen::Vector3d p = map_.p_map(landmark);
    if ((eye_of(seen) - p).head<2>().norm() > options_.max_range_m) return std::nullopt;
    const Eigen::Matrix3d turn =
        map_.map_frames[static_cast<std::size_t>(landmark.map_frame)].T_map_frame.linear();
    CameraSight sight;
    sight.landmark = seen.landmark;
    sight.raised = true;
    sight.p = p.head<2>();
    sight.low = sight.p;
    sight.covariance = (turn * landmark.covariance * turn.transpose()).topLeftCorner<2, 2>();
    return sight;
  }

 private:
  [[nodiscard]] Eigen::Vector3d eye_of(const Observation& seen) const {
    const auto session =
        static_cast<std::size_t>(map_.keyframes[static_cast<std::size_t>(seen.keyframe)].session);
    const auto& camera = map_.sessions[session].rig.cameras[static_cast<std::size_t>(seen.camera)];
    return map_.T_map_vehicle(seen.keyframe) * camera.T_vehicle_camera.translation();
  }

  const Map& map_;
  const GroundModel& ground_;
  const CameraSightOptions& options_;
};

}  // namespace

CameraSights camera_sights(const Map& map, int session, const CameraSightOptions& options) {
  GroundModelOptions surface;
  surface.reach_m = options.max_range_m + 5.0;
  const GroundModel ground = estimate_ground(map, surface);
  const SightCollector collector(map, ground, options);
  CameraSights out;
  std::vector<std::size_t> view_of(map.keyframes.size(), 0);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (map.keyframes[k].session != session) continue;
    view_of[k] = out.views.size();
    out.views.push_back(
        {map.keyframes[k].t_ns, map.T_map_vehicle(static_cast<int>(k)).translation().head<2>(), k});
  }
  std::vector<Observation> own;
  for (const Observation& o : map.observations)
    if (map.keyframes[static_cast<std::size_t>(o.keyframe)].session == session) own.push_back(o);
  std::stable_sort(own.begin(), own.end(), [](const Observation& a, const Observation& b) {
    return std::pair(a.landmark, a.keyframe) < std::pair(b.landmark, b.keyframe);
  });
  for (std::size_t first = 0, last = 0; first < own.size(); first = last) {
    const int landmark = own[first].landmark;
    while (last < own.size() && own[last].landmark == landmark) ++last;
    const auto place = collector.place_of(map.landmarks[static_cast<std::size_t>(landmark)]);
    const auto add = [&](const Observation& seen, std::optional<CameraSight> sight) {
      if (!sight) return;
      sight->view = view_of[static_cast<std::size_t>(seen.keyframe)];
      out.sights.push_back(*sight);
    };
    const std::size_t before = out.sights.size();
    if (place == LandmarkPlace::kRaised) {
      const Observation& middle = own[first + (last - first) / 2];
      add(middle, collector.raised_sight(middle));
    } else if (place == LandmarkPlace::kGround) {
      for (std::size_t i = first; i < last; ++i) add(own[i], collector.low_sight(own[i]));
    }
    if (out.sights.size() == before) continue;
    ++(place == LandmarkPlace::kRaised ? out.raised : out.on_ground);
  }
  return out;
}

}  // namespace roadbook
