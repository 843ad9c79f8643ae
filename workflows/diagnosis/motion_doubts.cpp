#include "workflows/diagnosis/motion_doubts.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "workflows/diagnosis/advice.hpp"

namespace roadbook {
namespace {

// Way that is compared: the cost of a diagnosis grows faster than the way. A reading that is wrong
// for a time only is found where wheels and cameras doubt each other.
constexpr double kCompared_m = 400.0;

// Of the keyframes of the session's first piece, up to kCompared_m after its start.
std::vector<TimedPose> poses_of_session(const Map& map, int session) {
  std::vector<TimedPose> poses;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    if (keyframe.session == session && keyframe.piece == 0 && keyframe.travelled_m <= kCompared_m)
      poses.push_back({keyframe.t_ns, map.T_map_vehicle(static_cast<int>(k))});
  }
  std::sort(poses.begin(), poses.end(),
            [](const TimedPose& a, const TimedPose& b) { return a.t_ns < b.t_ns; });
  return poses;
}

// Drops what was read after the last pose, but for the time that a late stream needs.
void end_with_poses(MotionStreams& streams) {
  constexpr double kLate_s = 1.0;
  const double end_s = streams.poses.back().t_s + kLate_s;
  const auto is_later = [&](const auto& sample) { return sample.t_s > end_s; };
  std::erase_if(streams.wheels, is_later);
  std::erase_if(streams.steering, is_later);
  std::erase_if(streams.gyro, is_later);
  std::erase_if(streams.imu, is_later);
}

// The radius of both wheels is the map's scale. An effect that the map or several other names
// explain as well is a question for a diagnosis, not for one line.
bool is_sure(const FoundCause& c) {
  constexpr double kLeastNats = 50.0;
  constexpr double kMostP = 1e-4;
  const bool of_motion = c.effect.starts_with("wheels0.") || c.effect.starts_with("steering0.") ||
                         c.effect.starts_with("imu0.");
  return of_motion && c.effect != "wheels0.radius" && !c.noise && !c.in_place && c.p <= kMostP &&
         c.evidence >= kLeastNats && c.inseparable.size() < 2 &&
         std::none_of(c.inseparable.begin(), c.inseparable.end(),
                      [](const std::string& other) { return other.starts_with("map."); });
}

Problem doubt(const Drive& drive,
              const FoundCause& cause,
              const Advice& words,
              const EffectSizes& known,
              bool has_gyro) {
  const std::size_t point = cause.effect.find('.');
  const std::string stream = cause.effect.substr(0, point);
  std::string fault = words.fault;
  if (!fault.empty()) fault[0] = static_cast<char>(std::tolower(fault[0]));
  std::string size = words.size;
  if (known.contains(cause.effect)) size += " in addition to the model";
  if (!cause.inseparable.empty())
    size += "; " + words.certainty;
  else if (stream == "wheels0" && cause.effect.ends_with(".latency") && !has_gyro)
    size += "; without a gyro, an error of the time stamps of the images looks the same";
  return {Severity::kWarning,
          (drive.folder() / (stream == "steering0" ? "wheels0" : stream)).string(),
          0,
          cause.effect.substr(point + 1),
          "readings that contradict the images: " + fault + ", " + size,
          "the values of its sensor.yaml; `roadbook diagnose` with this map shows the evidence"};
}

}  // namespace

std::vector<Problem> motion_doubts(const Map& map, const Drive& drive, const EffectSizes& model) {
  const std::string digest = drive.digest();
  const auto session = std::find_if(map.sessions.begin(), map.sessions.end(),
                                    [&](const Session& s) { return s.drive_digest == digest; });
  if (session == map.sessions.end()) return {};
  const auto poses = poses_of_session(map, static_cast<int>(session - map.sessions.begin()));
  MotionStreams streams = motion_streams(drive, poses);
  if (streams.poses.empty()) return {};
  end_with_poses(streams);
  if (!records_motion(streams)) return {};
  streams.poses_of_map = true;
  DiagnosisOptions options;
  options.library.grammar = options.library.places = false;
  options.library.without = {"map.scale", "map.bend"};
  options.known = model;
  std::erase_if(options.known, [](const auto& effect) {
    const bool of_images = is_camera_effect(effect.first) && effect.first != "cam.latency";
    return of_images || effect.first.starts_with("map.");
  });
  Diagnosis d;
  try {
    d = diagnose(streams, drive.folder().string(), options);
  } catch (const BadInput&) {
    return {};
  }
  std::vector<Problem> doubts;
  const std::vector<Advice> words = advice_of(d, std::nullopt);
  for (const FoundCause& c : d.causes) {
    if (!is_sure(c)) continue;
    const auto of_cause = std::find_if(words.begin(), words.end(),
                                       [&](const Advice& a) { return a.effect == c.effect; });
    if (of_cause != words.end())
      doubts.push_back(doubt(drive, c, *of_cause, options.known, !streams.gyro.empty()));
  }
  return doubts;
}

}  // namespace roadbook
