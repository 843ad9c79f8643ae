#include "diagnosis/map_diagnosis.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "diagnosis/brightness/brightness_problem.hpp"
#include "diagnosis/brightness/brightness_samples.hpp"
#include "diagnosis/inference/extended_model.hpp"
#include "diagnosis/map_changes/moved_landmarks.hpp"
#include "diagnosis/map_changes/removed_landmarks.hpp"
#include "diagnosis/map_motion.hpp"
#include "diagnosis/separating_causes.hpp"
#include "diagnosis/stream_checks.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "diagnosis/tilt/tilt_diagnosis.hpp"
#include "diagnosis/views/view_alternatives.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kFewestKeyframes = 20;
constexpr std::size_t kFewestMapViews = 500;

// The motion of the car against reference poses; a drive that says nothing of it leaves a note.
void add_motion(MotionStreams streams,
                const Drive& drive,
                const DiagnosisOptions& options,
                std::vector<Diagnosis>& parts,
                double& length_m) {
  const TiltedDrive tilted{"", &streams};
  const Diagnosis tilt = diagnose_tilt({&tilted, 1}, options);
  try {
    const PreparedMotion prepared = prepare_motion(streams, drive.folder().string(), options);
    length_m = prepared.length_m;
    parts.push_back(diagnose(*prepared.problem, options.search));
    add_findings(tilt, parts.back());
    parts.back().notes.insert(parts.back().notes.begin(), prepared.notes.begin(),
                              prepared.notes.end());
  } catch (const BadInput& bad) {
    add_findings(tilt, parts.emplace_back());
    parts.back().notes.push_back(std::string("motion not diagnosed: ") + bad.what());
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

// Landmarks that moved since other drives saw them, and removed ones.
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

// No manoeuvre separates two clocks that share no third clock with the drive.
void ask_for_third_clock(Diagnosis& found) {
  const auto is_delay = [](const std::string& name) { return name.ends_with(".latency"); };
  for (FoundCause& cause : found.causes)
    if (is_delay(cause.effect) &&
        std::any_of(cause.inseparable.begin(), cause.inseparable.end(), is_delay))
      cause.separating = "a drive with a gyro or reference poses would separate them";
}

// Diagnosis of the camera observations; returns the streams that remain for the motion.
MapMotion::Question add_views(ViewData data,
                              const Drive& drive,
                              const MapMotion& motion,
                              const DiagnosisOptions& options,
                              std::vector<Diagnosis>& parts) {
  const auto nothing = [&](const std::string& why) {
    parts.emplace_back().notes.push_back("camera observations in the map not diagnosed: " + why);
    return motion.question(nullptr, {}, {});
  };
  if (data.keyframe.size() < kFewestKeyframes || data.bundle.observations.size() < kFewestMapViews)
    return nothing(std::to_string(data.keyframe.size()) + " keyframes and " +
                   std::to_string(data.bundle.observations.size()) +
                   " camera observations of this drive");
  const ViewProblem views(std::move(data), options.known, options.library, options.num_threads);
  if (!views.usable()) return nothing(views.message());
  const auto wants = [&](const Diagnosis& found, const EffectSizes& effects) {
    return motion.wants(views, effects, observed(found));
  };
  auto [found, contradicted] = diagnose_views(views, options.search, wants, motion.witness());
  if (!motion.has_reference())
    found.notes.emplace_back(drive.wheel_model()
                                 ? "the map gives the reference poses; wheels and cameras were "
                                   "diagnosed by its camera observations"
                                 : "the map gives the reference poses; cameras were diagnosed by "
                                   "its camera observations");
  parts.push_back(std::move(found));
  MapMotion::Question left = motion.question(&views, parts.back().extended, observed(parts.back()));
  if (!motion.has_reference() && left.streams.gyro.empty()) ask_for_third_clock(parts.back());
  // Effects that the cameras exclude must not return as effects of the reference.
  for (const std::string& name : contradicted)
    if (is_camera_effect(name)) left.options.library.without.push_back(name);
  return left;
}

}  // namespace

Diagnosis diagnose_through_map(const Map& map,
                               int session,
                               const Drive& drive,
                               const DiagnosisOptions& options,
                               const ViewDataOptions& view_options) {
  std::vector<Diagnosis> parts;
  const MapMotion motion(drive, options, map.sessions.size() == 1);
  const MapMotion::Question asked =
      add_views(view_data(map, session, drive, view_options), drive, motion, options, parts);
  std::vector<std::string> cameras;
  for (const MountedCamera& camera : map.sessions[static_cast<std::size_t>(session)].rig.cameras)
    cameras.push_back(camera.name);
  BrightnessOptions images;
  images.num_threads = options.num_threads;
  const BrightnessProblem brightness(brightness_samples(map, session, drive, images), cameras,
                                     options.known, options.library);
  if (brightness.usable())
    parts.push_back(diagnose(brightness, options.search));
  else
    parts.emplace_back().notes.emplace_back("brightness not diagnosed: too few images");
  double length_m = 0.0;
  add_motion(asked.streams, drive, asked.options, parts, length_m);
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
  name_separating_drives(asked.streams, options, all);
  all.length_m = length_m;
  add_known(options.known, all);
  return all;
}

}  // namespace roadbook
