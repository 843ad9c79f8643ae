#include "diagnosis/diagnose.hpp"

#include <cmath>

#include "base/error.hpp"
#include "diagnosis/inference/extended_model.hpp"
#include "diagnosis/known_causes.hpp"
#include "diagnosis/motion/grammar.hpp"
#include "diagnosis/reckoning_error.hpp"
#include "diagnosis/simulated_again.hpp"
#include "diagnosis/stream_checks.hpp"
#include "diagnosis/streams/coarse_readings.hpp"
#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/stream_faults.hpp"
#include "diagnosis/tilt/tilt_diagnosis.hpp"

namespace roadbook {
namespace {

double length_of(const Trajectory& t) {
  double length = 0.0;
  for (std::size_t j = 0; j + 1 < t.knots(); ++j)
    length += 0.5 * t.step_s() * std::abs(t.speed[j] + t.speed[j + 1]);
  return length;
}

// Covariates that do not vary: effects that depend on them are not observable, which is reported.
void note_constant(const Trajectory& trajectory, std::vector<std::string>& notes) {
  const Trajectory t = smoothed(trajectory);
  const double least = least_steering_speed(t);
  double n = 0.0, speed = 0.0, square = 0.0, turn = 0.0;
  for (std::size_t j = 0; j < t.knots(); ++j) {
    if (std::abs(t.speed[j]) < least) continue;
    n += 1.0;
    speed += t.speed[j];
    square += t.speed[j] * t.speed[j];
    turn += t.yaw_rate[j] * t.yaw_rate[j];
  }
  if (n < 2.0) return;
  const double scatter = std::sqrt(std::max(0.0, square / n - speed * speed / (n * n)));
  if (scatter < kLeastSpeedChange * std::abs(speed) / n)
    notes.emplace_back("the speed does not vary: effects that depend on speed are not observable");
  constexpr double kNoTurn = 0.01;  // [rad/s]
  if (std::sqrt(turn / n) < kNoTurn)
    notes.emplace_back("the drive has no bends: effects that depend on turning are not observable");
}

}  // namespace

PreparedMotion prepare_motion(const MotionStreams& recorded,
                              const std::string& name,
                              const DiagnosisOptions& options) {
  check_streams(recorded, name, options);
  check_stamps(recorded, name, options.min_duration_s);
  MotionStreams streams = recorded;
  PreparedMotion prepared;
  prepared.notes = drop_stuck(streams);
  if (streams.wheels.empty() && streams.gyro.empty() && streams.steering.empty())
    throw BadInput({Severity::kError, name, 0, "streams", prepared.notes.front(),
                    "poses and one more stream that is not stuck (wheels, steering or gyro)"});
  Observations obs = observe(streams, options.observation);
  for (const std::string& fault : coarse_readings(obs)) prepared.notes.push_back(fault);
  for (const std::string& note : stream_notes(streams, options)) prepared.notes.push_back(note);
  const Trajectory trajectory = trajectory_of_poses(obs);
  prepared.length_m = length_of(trajectory);
  check_length(prepared.length_m, name, options);
  check_offsets(obs, smoothed(trajectory), name);
  note_constant(trajectory, prepared.notes);
  report(options.search.progress, "noise", 0, 0);
  prepared.problem =
      std::make_unique<MotionProblem>(std::move(obs), options.known, options.library);
  return prepared;
}

Diagnosis diagnose(const MotionStreams& streams,
                   const std::string& name,
                   const DiagnosisOptions& options) {
  MotionStreams level = streams;
  const TiltedDrive tilted{"", &level};
  const Diagnosis tilt = diagnose_tilt({&tilted, 1}, options);
  const PreparedMotion prepared = prepare_motion(level, name, options);
  Diagnosis d = diagnose(*prepared.problem, options.search);
  d.notes.insert(d.notes.begin(), prepared.notes.begin(), prepared.notes.end());
  d.length_m = prepared.length_m;
  note_beyond_known(options.known, d);
  add_known(options.known, d);
  const Observations& obs = prepared.problem->observations();
  add_reckoning(obs, options.known, d);
  add_findings(tilt, d);
  if (options.compare)
    d.simulated = compare_with_simulation(obs, options.known, d.extended,
                                          motion_model(prepared.problem->nominal()).noise);
  return d;
}

}  // namespace roadbook
