#include "diagnosis/diagnose.hpp"

#include <cmath>

#include "diagnosis/stream_checks.hpp"

namespace roadbook {
namespace {

double length_of(const Trajectory& t) {
  double length = 0.0;
  for (std::size_t j = 0; j + 1 < t.knots(); ++j)
    length += 0.5 * t.step_s() * std::abs(t.speed[j] + t.speed[j + 1]);
  return length;
}

}  // namespace

PreparedMotion prepare_motion(const MotionStreams& streams,
                              const std::string& name,
                              const DiagnosisOptions& options) {
  check_streams(streams, name, options);
  PreparedMotion prepared;
  prepared.notes = stream_notes(streams, options);
  Observations obs = observe(streams, options.observation);
  prepared.length_m = length_of(trajectory_of_poses(obs));
  check_length(prepared.length_m, name, options);
  prepared.problem =
      std::make_unique<MotionProblem>(std::move(obs), options.known, options.library);
  return prepared;
}

Diagnosis diagnose(const MotionStreams& streams,
                   const std::string& name,
                   const DiagnosisOptions& options) {
  const PreparedMotion prepared = prepare_motion(streams, name, options);
  Diagnosis d = diagnose(*prepared.problem, options.search);
  d.notes.insert(d.notes.begin(), prepared.notes.begin(), prepared.notes.end());
  d.length_m = prepared.length_m;
  for (const auto& [effect, size] : options.known) d.extended[effect] += size;
  return d;
}

}  // namespace roadbook
