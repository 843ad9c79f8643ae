#include "mapping/pipeline/map_gate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/format.hpp"
#include "sensors/camera_centre.hpp"

namespace roadbook {
namespace {

[[noreturn]] void refuse(const std::string& file,
                         const std::string& field,
                         const std::string& got,
                         const std::string& want) {
  throw Refused(to_line({Severity::kError, file, 0, field, got, want}));
}

std::string count_text(std::size_t count, const std::string& of) {
  return std::to_string(count) + " " + of;
}

// Number of keyframes of a session, and of those in the parts that the sessions before it are in.
struct Joined {
  std::size_t keyframes = 0;
  std::size_t joined = 0;
};

Joined joined_to_earlier(const MappingInput& input, const Relaxed& relaxed, int session) {
  std::set<int> earlier;
  Joined found;
  for (std::size_t k = 0; k < input.session.size(); ++k) {
    if (input.session[k] < session) earlier.insert(relaxed.component[k]);
    if (input.session[k] != session) continue;
    ++found.keyframes;
    found.joined += earlier.contains(relaxed.component[k]) ? 1 : 0;
  }
  return found;
}

// Sizes of a session's parts, largest first: "45 and 31".
std::string sizes_of_parts(const MappingInput& input, const Relaxed& relaxed, int session) {
  std::map<int, std::size_t> sizes;
  for (std::size_t k = 0; k < input.session.size(); ++k)
    if (input.session[k] == session) ++sizes[relaxed.component[k]];
  std::vector<std::size_t> list;
  for (const auto& [part, size] : sizes) list.push_back(size);
  std::sort(list.rbegin(), list.rend());
  std::string text;
  for (std::size_t i = 0; i < list.size(); ++i)
    text += (i == 0 ? "" : i + 1 == list.size() ? " and " : ", ") + std::to_string(list[i]);
  return text;
}

// Whether enough corners looked alike that a pose was worth checking.
bool looks_alike(const LoopClosure& loop) {
  return loop.edge.accepted || loop.edge.reason.find("look alike") == std::string::npos ||
         loop.edge.reason.find("most corners") != std::string::npos;
}

// Fitting key points of each keyframe, and the landmarks of each session.
struct Evidence {
  std::vector<int> views;
  std::vector<std::set<int>> landmarks;
};

Evidence evidence_of(const MappingInput& input, const Adjusted& adjusted) {
  Evidence evidence;
  evidence.views.assign(input.session.size(), 0);
  evidence.landmarks.resize(input.half_rigs.size());
  const auto& observations = adjusted.stage.problem.observations;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!adjusted.result.inlier[i]) continue;
    const auto k = static_cast<std::size_t>(observations[i].pose);
    ++evidence.views[k];
    const int point = observations[i].point;
    const int corner = adjusted.stage.problem.points[static_cast<std::size_t>(point)].corner;
    evidence.landmarks[static_cast<std::size_t>(input.session[k])].insert(corner < 0 ? point
                                                                                     : corner);
  }
  return evidence;
}

bool is_in_use(const CameraFigures& camera, const MapGateOptions& options) {
  return camera.views && *camera.views >= options.min_camera_views;
}

std::string why(const std::vector<Problem>& doubts) {
  if (doubts.empty()) return " (dark or covered images, a wrong calibration?)";
  const Problem& first = doubts.front();
  return " (" + first.file + ": " + first.field + ": " + first.got + ")";
}

std::string lateness_text(const CameraFigures& camera) {
  if (!camera.late_s) return "";
  const double ms = 1e3 * std::abs(*camera.late_s);
  return ", stamped " + fixed(ms, ms < 1.0 ? 3 : 0) +
         (*camera.late_s > 0.0 ? " ms after them" : " ms before them");
}

void require_cameras(const std::vector<CameraFigures>& cameras,
                     std::size_t begin,
                     std::size_t count,
                     const std::string& drive,
                     const std::vector<Problem>& doubts,
                     const MapGateOptions& options) {
  std::size_t used = 0;
  std::string idle;
  for (std::size_t c = begin; c < begin + count; ++c) {
    if (is_in_use(cameras[c], options))
      ++used;
    else
      idle += (idle.empty() ? "" : ", ") + cameras[c].camera;
  }
  if (static_cast<double>(used) >= options.min_cameras_share * static_cast<double>(count)) return;
  refuse(drive, "cameras",
         std::to_string(used) + " of " + std::to_string(count) + " in use, hardly a landmark in " +
             idle,
         "at least half of them" + why(doubts));
}

}  // namespace

GateInputs gate_inputs(const std::vector<std::filesystem::path>& drives,
                       const std::filesystem::path& map) {
  GateInputs inputs;
  for (const auto& drive : drives) inputs.drives.push_back(drive.string());
  inputs.map = map.string();
  return inputs;
}

void require_joined(const MappingInput& input,
                    const Relaxed& relaxed,
                    const GateInputs& inputs,
                    const MapGateOptions& options) {
  if (options.apart || relaxed.components < 2) return;
  for (std::size_t s = 1; s < inputs.drives.size(); ++s) {
    const Joined found = joined_to_earlier(input, relaxed, static_cast<int>(s));
    if (found.joined == found.keyframes) continue;
    refuse(inputs.map, "sessions",
           inputs.drives[s] + " with " + std::to_string(found.joined) + " of " +
               std::to_string(found.keyframes) + " keyframes in the map",
           "a drive of its place (--apart keeps " +
               std::string(found.joined == 0 ? "it as a map of its own)" : "the parts apart)"));
  }
  refuse(inputs.drives.front(), "parts",
         count_text(static_cast<std::size_t>(relaxed.components), "that no loop joins, of ") +
             sizes_of_parts(input, relaxed, 0) + " keyframes",
         "one (drive through places that two parts share; --apart keeps the parts apart)");
}

void require_loops(const std::vector<LoopClosure>& loops,
                   const GateInputs& inputs,
                   const MapGateOptions& options) {
  const auto alike = std::count_if(loops.begin(), loops.end(), looks_alike);
  const auto accepted = std::count_if(loops.begin(), loops.end(),
                                      [](const LoopClosure& loop) { return loop.edge.accepted; });
  if (alike < options.alike_loops ||
      static_cast<double>(accepted) >= options.min_alike_share * static_cast<double>(alike))
    return;
  refuse(inputs.drives.front(), "loops",
         std::to_string(accepted) + " accepted of " + std::to_string(alike) +
             " pairs of places that look alike",
         "at least " + fixed(100.0 * options.min_alike_share, 0) +
             " % (a wrong calibration of wheels or cameras?)");
}

void require_possible_motions(const MappingInput& input,
                              const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                              const GateInputs& inputs) {
  constexpr double kFastestMps = 140.0;  // twice the fastest car of a recording
  constexpr double kPoseErrorM = 3.0;
  const auto& keyframes = input.odometry.keyframes;
  std::int64_t start_ns = keyframes.empty() ? 0 : keyframes.front().t_ns;
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    if (input.session[k] != input.session[k - 1]) start_ns = keyframes[k].t_ns;
    if (input.session[k] != input.session[k - 1] || keyframes[k].after_gap) continue;
    const auto session = static_cast<std::size_t>(input.session[k]);
    // Of a free scale, a unit is no metre.
    if (!input.has_wheels[session] && !known_camera_height(input.half_rigs[session])) continue;
    const double dt = 1e-9 * static_cast<double>(keyframes[k].t_ns - keyframes[k - 1].t_ns);
    const double way_m =
        (T_map_vehicle[k].translation() - T_map_vehicle[k - 1].translation()).norm();
    if (way_m <= kPoseErrorM + kFastestMps * dt) continue;
    const double begin_s = 1e-9 * static_cast<double>(keyframes[k - 1].t_ns - start_ns);
    refuse(inputs.drives[session], "poses",
           fixed(way_m, 0) + " m in " + fixed(dt, 2) + " s, " + fixed(begin_s, 1) +
               " s after the start",
           std::string("a way that a car can drive") +
               (keyframes[k].wheels ? ""
                                    : " (the cameras lost their scale there: map it with wheels, "
                                      "or with a camera that sees the ground)"));
  }
}

void require_evidence(const MappingInput& input,
                      const Adjusted& adjusted,
                      const std::vector<CameraFigures>& cameras,
                      const std::vector<Problem>& doubts,
                      const GateInputs& inputs,
                      const MapGateOptions& options) {
  const Evidence evidence = evidence_of(input, adjusted);
  for (std::size_t s = 0; s < inputs.drives.size(); ++s) {
    const std::size_t landmarks = evidence.landmarks[s].size();
    if (landmarks < static_cast<std::size_t>(options.min_landmarks))
      refuse(inputs.drives[s], "landmarks", std::to_string(landmarks),
             "at least " + std::to_string(options.min_landmarks) + why(doubts));
    const auto base = static_cast<std::size_t>(adjusted.stage.camera_base[s]);
    require_cameras(cameras, base, input.half_rigs[s].cameras.size(), inputs.drives[s], doubts,
                    options);
    std::size_t keyframes = 0;
    std::size_t held = 0;
    for (std::size_t k = 0; k < input.session.size(); ++k) {
      if (input.session[k] != static_cast<int>(s)) continue;
      ++keyframes;
      held += evidence.views[k] >= options.min_views ? 1 : 0;
    }
    if (static_cast<double>(held) < options.min_held_share * static_cast<double>(keyframes))
      refuse(inputs.drives[s], "views",
             std::to_string(held) + " of " + std::to_string(keyframes) + " keyframes with " +
                 std::to_string(options.min_views) + " landmarks or more in view",
             "at least half of them" + why(doubts));
  }
}

Refused with_warnings(const Refused& refusal, const std::vector<Problem>& warnings) {
  std::string lines = refusal.what();
  for (const Problem& warning : warnings) lines += "\n" + to_line(warning);
  return Refused(lines);
}

std::vector<Problem> warnings_of_idle_cameras(const std::vector<CameraFigures>& cameras,
                                              const MappingInput& input,
                                              const GateInputs& inputs,
                                              const MapGateOptions& options) {
  constexpr double kPaired = 0.5;
  std::vector<Problem> warnings;
  std::size_t next = 0;
  for (std::size_t s = 0; s < inputs.drives.size(); ++s)
    for (std::size_t c = 0; c < input.half_rigs[s].cameras.size(); ++c, ++next) {
      const CameraFigures& camera = cameras[next];
      const std::string folder = (std::filesystem::path(inputs.drives[s]) / camera.camera).string();
      if (camera.paired_share && *camera.paired_share < kPaired)
        warnings.push_back({Severity::kWarning, folder, 0, "timestamp",
                            fixed(100.0 * *camera.paired_share, 0) +
                                " % of its images at the time of another camera's" +
                                lateness_text(camera),
                            "nearly all (a clock of its own, or a time_offset?)"});
      else if (!is_in_use(camera, options))
        warnings.push_back({Severity::kWarning, folder, 0, "landmarks",
                            camera.views ? fixed(*camera.views, 1) + " in view at a keyframe"
                                         : std::string("no images at keyframes"),
                            "at least " + fixed(options.min_camera_views, 1) +
                                " (covered, dark, or of another calibration?)"});
    }
  return warnings;
}

}  // namespace roadbook
