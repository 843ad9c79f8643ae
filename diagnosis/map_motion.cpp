#include "diagnosis/map_motion.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "diagnosis/inference/search.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "diagnosis/tilt/tilt_diagnosis.hpp"
#include "sensors/imu_imperfections.hpp"

namespace roadbook {
namespace {

void add_sizes(const EffectSizes& more, EffectSizes& all) {
  for (const auto& [name, size] : more) all[name] += size;
}

}  // namespace

std::string MapMotion::witness() const {
  return has_reference() ? "the reference poses" : "the gyro";
}

MapMotion::Question MapMotion::question(const ViewProblem* views,
                                        const EffectSizes& found,
                                        const std::vector<std::string>& answered) const {
  Question q{{}, options_};
  EffectSizes& known = q.options.known;
  std::vector<std::string>& without = q.options.library.without;
  std::vector<TimedPose> poses = reference_;
  const bool of_map = poses.empty() && views != nullptr;
  if (of_map) {
    add_sizes(found, known);
    poses = views->poses_with(known);
    without.insert(without.end(), answered.begin(), answered.end());
  }
  // Effects of the cameras are no errors of a reference; they are removed from the poses of the
  // observations.
  if (views != nullptr)
    std::erase_if(known, [](const auto& effect) { return is_camera_effect(effect.first); });
  // Of several drives the map itself is judged by that name; poses of this one alone have its
  // scale.
  if (!one_session_ || of_map) {
    std::erase_if(known, [](const auto& effect) { return effect.first.starts_with("map."); });
    without.insert(without.end(), {"map.scale", "map.bend"});
  }
  q.streams = motion_streams(drive_, poses);
  q.streams.poses_of_map = of_map;
  return q;
}

std::optional<double> MapMotion::wants(const ViewProblem& views,
                                       const EffectSizes& found,
                                       const std::vector<std::string>& answered) const {
  Question q = question(&views, found, answered);
  q.options.library.grammar = q.options.library.places = false;
  if (has_reference())
    for (const auto& [name, size] : found)
      if (!is_camera_effect(name) && !name.starts_with("map.")) q.options.known[name] += size;
  const ImuImperfections<double> imu = imu_imperfections(q.options.known);
  remove_tilt(imu.tilt_roll, imu.tilt_pitch, q.streams);
  try {
    const PreparedMotion prepared = prepare_motion(q.streams, drive_.folder().string(), q.options);
    double evidence = 0.0;
    for (const AcceptedEffect& v : search_causes(*prepared.problem, q.options.search).verdicts)
      evidence += std::max(0.0, v.evidence);
    return evidence;
  } catch (const BadInput&) {
    return std::nullopt;
  }
}

}  // namespace roadbook
