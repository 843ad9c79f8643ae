#include "diagnosis/tilt/tilt_diagnosis.hpp"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "base/format.hpp"
#include "diagnosis/diagnose_together.hpp"
#include "diagnosis/streams/level_motion.hpp"
#include "diagnosis/tilt/tilt_problem.hpp"
#include "sensors/imu_imperfections.hpp"

namespace roadbook {
namespace {

// The tilt of one drive: common to all, and of this one alone.
EffectSizes tilt_in(const Diagnosis& found, const std::string& drive) {
  EffectSizes sizes = found.extended;
  for (const FoundCause& c : found.causes)
    if (!c.session.empty() && c.session == drive) sizes[c.effect] += c.size;
  return sizes;
}

// A tilt that turns do not confirm may show in gravity alone. Beyond the bias of any accelerometer
// of a car it is said, but not named: one number has no other that agrees with it.
std::vector<std::string> notes_of_gravity(const TiltProblem& problem,
                                          const Diagnosis& found,
                                          const std::vector<std::string>& without) {
  constexpr double kBeyondBias = 0.1;  // [rad], 1 m/s^2
  std::vector<std::string> notes;
  const auto tilt = problem.tilt_by_gravity();
  if (!tilt) return notes;
  const auto add = [&](const std::string& effect, double size) {
    if (std::abs(size) < kBeyondBias || shows(found, effect) || holds(without, effect)) return;
    notes.push_back(
        "gravity resembles " + effect + " = " + fixed(size, 2) +
        " rad; turns do not confirm it, and a bias of the accelerometer looks the same");
  };
  add("imu0.tilt_roll", (*tilt)[0]);
  add("imu0.tilt_pitch", (*tilt)[1]);
  return notes;
}

double known_size(const EffectSizes& known, const std::string& effect) {
  const auto found = known.find(effect);
  return found == known.end() ? 0.0 : found->second;
}

// Takes tilts away whose held-out gain is not significant. The poses of a map, for one, have errors
// of attitude that part of a drive shows and part does not.
void keep_confirmed(Diagnosis& found) {
  std::erase_if(found.causes, [&](const FoundCause& c) {
    if (c.gain.low > 0.0) return false;
    found.unexplained.push_back("resembles " + c.effect + " = " + fixed(c.size, 4) + " rad" +
                                (c.session.empty() ? "" : " in " + c.session) +
                                ", but its held-out gain is not significant");
    if (!c.session.empty()) return true;
    found.extended.erase(c.effect);
    std::erase(found.looked_for, c.effect);  // neither found nor fine
    return true;
  });
}

void remove_tilt(const EffectSizes& sizes, MotionStreams& streams) {
  const auto off = imu_imperfections(sizes);
  roadbook::remove_tilt(off.tilt_roll, off.tilt_pitch, streams);
}

}  // namespace

void remove_tilt(double roll_rad, double pitch_rad, MotionStreams& streams) {
  if (streams.imu.size() != streams.gyro.size()) return;
  if (roll_rad == 0.0 && pitch_rad == 0.0) return;
  const Eigen::Matrix3d tilt = tilt_rotation(roll_rad, pitch_rad);
  PitchRates pitch_rates;
  for (std::size_t i = 0; i < streams.imu.size(); ++i) {
    ImuSample& s = streams.imu[i];
    s.rate_rad_s = tilt * s.rate_rad_s;
    s.force_m_s2 = tilt * s.force_m_s2;
    streams.gyro[i].rate_rad_s = s.rate_rad_s.z();
    pitch_rates.push_back({s.t_s, s.rate_rad_s.y()});
  }
  level_motion({}, streams.body, pitch_rates, streams);
}

Diagnosis diagnose_tilt(std::span<const TiltedDrive> drives, const DiagnosisOptions& options) {
  std::vector<std::unique_ptr<TiltProblem>> problems;
  std::vector<SessionProblem> sessions;
  for (const TiltedDrive& drive : drives) {
    remove_tilt(options.known, *drive.streams);
    auto problem = std::make_unique<TiltProblem>(
        tilt_windows(*drive.streams, options.observation.step_s), tilt_axes(drive.streams->imu),
        drive.streams->bank_is_known, options.library);
    if (!problem->usable()) continue;
    problems.push_back(std::move(problem));
    sessions.push_back({drive.name, problems.back().get()});
  }
  Diagnosis all;
  if (sessions.empty()) return all;
  Diagnosis found = diagnose_together(sessions, options.search);
  keep_confirmed(found);
  for (const TiltedDrive& drive : drives) remove_tilt(tilt_in(found, drive.name), *drive.streams);
  all.causes = std::move(found.causes);
  all.looked_for = std::move(found.looked_for);
  all.not_observable = std::move(found.not_observable);
  all.unexplained = std::move(found.unexplained);
  for (const auto& [effect, size] : found.extended)
    all.extended[effect] = size + known_size(options.known, effect);
  all.fit_gain = found.fit_gain;
  for (const auto& problem : problems)
    for (std::string& note : notes_of_gravity(*problem, all, options.library.without))
      all.notes.push_back(std::move(note));
  return all;
}

}  // namespace roadbook
