#include "diagnosis/sessions_diagnosis.hpp"

#include <algorithm>

#include "diagnosis/inference/extended_model.hpp"
#include "diagnosis/known_causes.hpp"
#include "diagnosis/stream_checks.hpp"
#include "diagnosis/tilt/tilt_diagnosis.hpp"

namespace roadbook {
namespace {

constexpr double kShortestRun_m = 1.0;
constexpr double kShortestRun_s = 2.0;

const std::string& source_of(const SessionStreams& drive) {
  return drive.source.empty() ? drive.name : drive.source;
}

}  // namespace

void mark_session(const std::string& session, Diagnosis& d) {
  for (FoundCause& c : d.causes) c.session = session;
  for (UnknownCause& u : d.unknown) u.hook += " in " + session;
  for (std::string& u : d.unexplained) u = session + ": " + u;
  for (std::string& n : d.notes) n = session + ": " + n;
  for (auto* checks : {&d.before, &d.after})
    for (ChannelCheck& c : *checks) c.channel += " in " + session;
  d.extended.clear();
}

Diagnosis diagnose_sessions(std::span<const SessionStreams> drives,
                            const DiagnosisOptions& options) {
  if (drives.size() == 1) return diagnose(drives[0].streams, source_of(drives[0]), options);
  std::vector<PreparedMotion> prepared;
  std::vector<SessionProblem> problems;
  std::vector<std::string> notes;
  double length_m = 0.0;
  double duration_s = 0.0;
  // What one drive must show alone, all must show together: runs in a laboratory are short.
  DiagnosisOptions of_one = options;
  of_one.min_length_m = std::min(options.min_length_m, kShortestRun_m);
  of_one.min_duration_s = std::min(options.min_duration_s, kShortestRun_s);
  std::vector<SessionStreams> level(drives.begin(), drives.end());
  std::vector<TiltedDrive> tilted;
  for (SessionStreams& drive : level) tilted.push_back({drive.name, &drive.streams});
  const Diagnosis tilt = diagnose_tilt(tilted, options);
  for (const SessionStreams& drive : level) {
    prepared.push_back(prepare_motion(drive.streams, source_of(drive), of_one));
    problems.push_back({drive.name, prepared.back().problem.get()});
    for (const std::string& note : prepared.back().notes) notes.push_back(drive.name + ": " + note);
    length_m += prepared.back().length_m;
    duration_s += drive.streams.poses.back().t_s - drive.streams.poses.front().t_s;
  }
  const std::string together = std::to_string(drives.size()) + " drives together";
  check_length(length_m, together, options);
  check_duration(duration_s, together, options);
  Diagnosis d = diagnose_together(problems, options.search);
  d.notes.insert(d.notes.begin(), notes.begin(), notes.end());
  d.length_m = length_m;
  note_beyond_known(options.known, d);
  add_known(options.known, d);
  add_findings(tilt, d);
  return d;
}

}  // namespace roadbook
