#include "diagnosis/map_diagnosis.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "diagnosis/brightness_problem.hpp"
#include "diagnosis/brightness_samples.hpp"
#include "diagnosis/drive_streams.hpp"
#include "diagnosis/landmarks_gone.hpp"
#include "diagnosis/moved_landmarks.hpp"
#include "diagnosis/separating_causes.hpp"
#include "diagnosis/stream_checks.hpp"
#include "diagnosis/view_problem.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kFewestKeyframes = 20;
constexpr std::size_t kFewestMapViews = 500;

// The motion of the car against reference poses; a drive that says nothing of it leaves a note.
void add_motion(const MotionStreams& streams,
                const Drive& drive,
                const DiagnosisOptions& options,
                std::vector<Diagnosis>& parts,
                double& length_m) {
  try {
    const PreparedMotion prepared = prepare_motion(streams, drive.folder().string(), options);
    length_m = prepared.length_m;
    parts.push_back(diagnose(*prepared.problem, options.search));
    parts.back().notes.insert(parts.back().notes.begin(), prepared.notes.begin(),
                              prepared.notes.end());
  } catch (const BadInput& bad) {
    parts.emplace_back().notes.push_back(std::string("the car's motion was not looked at: ") +
                                         bad.what());
  }
}

// What a part of the data has answered, one way or the other.
std::vector<std::string> observed(const Diagnosis& part) {
  std::vector<std::string> names;
  for (const std::string& name : part.looked_for)
    if (std::find(part.not_observable.begin(), part.not_observable.end(), name) ==
        part.not_observable.end())
      names.push_back(name);
  return names;
}

bool of_map(const std::string& effect) { return effect.starts_with("map."); }

// Of cameras and gyro alone a delay is that of one against the other.
void join_clocks(Diagnosis& d) {
  for (FoundCause& cause : d.causes)
    for (const auto& [one, other] :
         {std::pair("imu0.latency", "cam.latency"), std::pair("cam.latency", "imu0.latency")})
      if (cause.effect == one && std::find(cause.inseparable.begin(), cause.inseparable.end(),
                                           other) == cause.inseparable.end())
        cause.inseparable.emplace_back(other);
}

// The map that several drives made, as this one's wheels and gyro measure it: the poses that the
// map gives it, with all that `parts` found taken out and not asked again.
void add_map_shape(const Map& map,
                   int session,
                   const Drive& drive,
                   DiagnosisOptions options,
                   std::vector<Diagnosis>& parts) {
  std::vector<TimedPose> poses;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    if (map.keyframes[k].session == session)
      poses.push_back({map.keyframes[k].t_ns, map.T_map_vehicle(static_cast<int>(k))});
  const Diagnosis known = merged(parts);
  for (const auto& [name, size] : known.extended)
    if (!of_map(name)) options.known[name] += size;
  const std::vector<std::string> answered = observed(known);
  options.library.without.insert(options.library.without.end(), answered.begin(), answered.end());
  options.library.grammar = options.library.places = false;
  std::vector<Diagnosis> shape;
  double length_m = 0.0;
  add_motion(motion_streams(drive, poses), drive, options, shape, length_m);
  const Diagnosis& found = shape.front();
  Diagnosis& d = parts.emplace_back();
  for (const FoundCause& cause : found.causes)
    if (of_map(cause.effect) ||
        std::any_of(cause.inseparable.begin(), cause.inseparable.end(), of_map)) {
      d.causes.push_back(cause);
      d.extended[cause.effect] = cause.size;
    }
  std::copy_if(found.looked_for.begin(), found.looked_for.end(), std::back_inserter(d.looked_for),
               of_map);
  std::copy_if(found.not_observable.begin(), found.not_observable.end(),
               std::back_inserter(d.not_observable), of_map);
}

// What stands elsewhere than other drives saw it, and what is gone.
void add_changes(const Map& map,
                 int session,
                 const DiagnosisOptions& options,
                 std::vector<Diagnosis>& parts) {
  LandmarkTwinOptions search;
  search.aligned = false;
  search.max_sigma_m = search.radius_m;  // found, if not where exactly
  const std::vector<LandmarkTwin> twins = landmark_twins(map, session, search);
  const auto& without = options.library.without;
  parts.push_back(diagnose_moved(map, aligned_twins(twins), options.known, without));
  parts.push_back(diagnose_gone(map, session, twins, options.known, without));
}

}  // namespace

Diagnosis diagnose_through_map(const Map& map,
                               int session,
                               const Drive& drive,
                               const DiagnosisOptions& options,
                               const ViewDataOptions& view_options) {
  std::vector<Diagnosis> parts;
  std::vector<TimedPose> reference = drive.truth();
  DiagnosisOptions of_motion = options;
  bool of_map_poses = false;
  ViewData data = view_data(map, session, drive, view_options);
  if (data.keyframe.size() < kFewestKeyframes ||
      data.bundle.observations.size() < kFewestMapViews) {
    parts.emplace_back().notes.push_back(
        "nothing can be said through the map: " + std::to_string(data.keyframe.size()) +
        " keyframes and " + std::to_string(data.bundle.observations.size()) +
        " views of this drive");
  } else if (const ViewProblem views(std::move(data), options.known, options.library);
             !views.usable()) {
    parts.emplace_back().notes.push_back("nothing can be said through the map: " + views.message());
  } else {
    parts.push_back(diagnose(views, options.search));
    if (reference.empty()) {
      EffectSizes known = options.known;
      for (const auto& [name, size] : parts.back().extended) known[name] += size;
      reference = views.poses_with(known);
      of_map_poses = true;
      of_motion.known = std::move(known);
      for (const std::string& name : observed(parts.back()))
        of_motion.library.without.push_back(name);
      parts.back().notes.emplace_back(
          drive.wheel_model()
              ? "reference poses are those of the map; wheels and cameras were judged by its views"
              : "reference poses are those of the map; cameras were judged by its views");
    }
  }
  std::vector<std::string> cameras;
  for (const MountedCamera& camera : map.sessions[static_cast<std::size_t>(session)].rig.cameras)
    cameras.push_back(camera.name);
  const BrightnessProblem brightness(brightness_samples(map, session, drive), cameras,
                                     options.known, options.library);
  if (brightness.usable())
    parts.push_back(diagnose(brightness, options.search));
  else
    parts.emplace_back().notes.emplace_back("nothing can be said about brightness: too few images");
  double length_m = 0.0;
  // Of several drives the map itself is judged by that name; poses of this one alone have its
  // scale.
  if (map.sessions.size() > 1 || of_map_poses) {
    std::erase_if(of_motion.known, [](const auto& effect) { return of_map(effect.first); });
    of_motion.library.without.insert(of_motion.library.without.end(), {"map.scale", "map.bend"});
  }
  MotionStreams motion = motion_streams(drive, reference);
  motion.poses_of_map = of_map_poses;
  add_motion(motion, drive, of_motion, parts, length_m);
  if (drive.truth().empty() && !drive.wheel_model()) join_clocks(parts.back());
  if (map.sessions.size() > 1) {
    add_changes(map, session, options, parts);
    add_map_shape(map, session, drive, options, parts);
  }
  const auto& stated = map.sessions[static_cast<std::size_t>(session)].wheels;
  if (stated && drive.wheel_model())
    for (const std::string& line :
         contradictions(*stated, "in the map", *drive.wheel_model(), "in the drive"))
      parts.emplace_back().notes.push_back(line);
  Diagnosis all = merged(parts);
  name_separating_drives(motion, options, all);
  all.length_m = length_m;
  for (const auto& [effect, size] : options.known) all.extended[effect] += size;
  return all;
}

}  // namespace roadbook
