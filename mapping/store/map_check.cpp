#include "mapping/store/map_check.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "mapping/store/file_digest.hpp"
#include "mapping/store/map_event_log.hpp"
#include "mapping/store/map_file_digest.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_tables.hpp"
#include "mapping/store/rtree_check.hpp"

namespace roadbook {
namespace {

// How far from orthonormal a rotation may be: long products of estimated ones lose some digits,
// calibrations are written with a few digits only.
constexpr double kEstimated = 1e-6;
constexpr double kCalibrated = 1e-3;

/// Gathers problems up to a limit.
class Findings {
 public:
  explicit Findings(std::size_t limit) : limit_(limit) {}

  void add(const std::string& what,
           std::size_t index,
           const char* field,
           const std::string& got,
           const std::string& want) {
    if (full()) return;
    const std::string place = what + "[" + std::to_string(index) + "]." + field;
    problems_.push_back({Severity::kError, "", 0, place, got, want});
  }
  /// `id` is an index into something of `size` elements.
  bool index(const std::string& what, std::size_t i, const char* field, int id, std::size_t size) {
    if (id >= 0 && static_cast<std::size_t>(id) < size) return true;
    add(what, i, field, std::to_string(id), "an index below " + std::to_string(size));
    return false;
  }
  template <typename Derived>
  void finite(const std::string& what,
              std::size_t i,
              const char* field,
              const Eigen::MatrixBase<Derived>& m) {
    if (!m.allFinite()) add(what, i, field, "a value that is not finite", "finite numbers");
  }
  void finite(const std::string& what, std::size_t i, const char* field, double value) {
    if (!std::isfinite(value)) add(what, i, field, std::to_string(value), "a finite number");
  }
  /// From 0, or NaN: unknown.
  void sigma(const std::string& what, std::size_t i, const char* field, double value) {
    if (value < 0.0 || std::isinf(value)) add(what, i, field, std::to_string(value), "at least 0");
  }
  /// All numbers are finite, or all are NaN: unknown.
  template <typename Derived>
  void covariance(const std::string& what, std::size_t i, const Eigen::MatrixBase<Derived>& m) {
    if (m.array().isNaN().all()) return;
    finite(what, i, "covariance", m);
    if (!(m.diagonal().minCoeff() >= 0.0))
      add(what, i, "covariance", "a negative variance", "variances from 0");
  }
  void pose(const std::string& what,
            std::size_t i,
            const char* field,
            const Eigen::Isometry3d& T,
            double tolerance = kEstimated) {
    const Eigen::Matrix3d error = T.linear().transpose() * T.linear() - Eigen::Matrix3d::Identity();
    const bool rotation =
        error.cwiseAbs().maxCoeff() <= tolerance && T.linear().determinant() > 0.0;
    if (!T.matrix().allFinite() || !rotation)
      add(what, i, field, "a matrix that is no rigid motion", "a finite, orthonormal pose");
  }
  [[nodiscard]] bool full() const { return problems_.size() >= limit_; }
  std::vector<Problem> take() { return std::move(problems_); }

 private:
  std::size_t limit_;
  std::vector<Problem> problems_;
};

void check_sessions(const Map& map, Findings& findings) {
  for (std::size_t i = 0; i < map.sessions.size() && !findings.full(); ++i) {
    const Session& s = map.sessions[i];
    findings.finite("sessions", i, "wheel_scale", s.wheel_scale);
    findings.sigma("sessions", i, "wheel_scale_sigma", s.wheel_scale_sigma);
    findings.sigma("sessions", i, "scale_sigma", s.scale_sigma);
    if (s.t_end_ns < s.t_begin_ns)
      findings.add("sessions", i, "t_end_ns", std::to_string(s.t_end_ns), "at least t_begin_ns");
    for (const MountedCamera& camera : s.rig.cameras) {
      findings.pose("sessions", i, "T_vehicle_camera", camera.T_vehicle_camera, kCalibrated);
      findings.finite("sessions", i, "exposed_after_s", camera.exposed_after_s);
      findings.finite("sessions", i, "rolling_shutter_s", camera.rolling_shutter_s);
      for (const double p : camera.camera.parameters)
        findings.finite("sessions", i, "camera parameters", p);
    }
  }
}

void check_keyframes(const Map& map, Findings& findings) {
  std::vector<bool> used(map.map_frames.size(), false);
  for (std::size_t i = 0; i < map.keyframes.size() && !findings.full(); ++i) {
    const Keyframe& k = map.keyframes[i];
    findings.index("keyframes", i, "session", k.session, map.sessions.size());
    if (findings.index("keyframes", i, "map_frame", k.map_frame, map.map_frames.size()))
      used[static_cast<std::size_t>(k.map_frame)] = true;
    findings.pose("keyframes", i, "T_frame_vehicle", k.T_frame_vehicle);
    findings.finite("keyframes", i, "travelled_m", k.travelled_m);
    findings.covariance("keyframes", i, k.covariance);
    if (i == 0) continue;
    const Keyframe& before = map.keyframes[i - 1];
    if (k.session < before.session || (k.session == before.session && k.t_ns <= before.t_ns))
      findings.add("keyframes", i, "t_ns", std::to_string(k.t_ns),
                   "sessions in order, ascending in time");
  }
  for (const Landmark& l : map.landmarks)
    if (l.map_frame >= 0 && static_cast<std::size_t>(l.map_frame) < used.size())
      used[static_cast<std::size_t>(l.map_frame)] = true;
  for (std::size_t i = 0; i < used.size() && !findings.full(); ++i) {
    findings.pose("map_frames", i, "T_map_frame", map.map_frames[i].T_map_frame);
    if (!used[i])
      findings.add("map_frames", i, "id", "a frame that nothing refers to",
                   "a keyframe or landmark in it");
  }
}

void check_landmarks(const Map& map, Findings& findings) {
  for (std::size_t i = 0; i < map.landmarks.size() && !findings.full(); ++i) {
    const Landmark& l = map.landmarks[i];
    findings.index("landmarks", i, "map_frame", l.map_frame, map.map_frames.size());
    findings.finite("landmarks", i, "p_frame", l.p_frame);
    findings.covariance("landmarks", i, l.covariance);
  }
}

void check_observations(const Map& map, Findings& findings) {
  for (std::size_t i = 0; i < map.observations.size() && !findings.full(); ++i) {
    const Observation& o = map.observations[i];
    findings.index("observations", i, "landmark", o.landmark, map.landmarks.size());
    findings.finite("observations", i, "pixel", o.pixel);
    if (!(o.sigma_px > 0.0F) || !std::isfinite(o.sigma_px))
      findings.add("observations", i, "sigma_px", std::to_string(o.sigma_px), "above 0");
    if (!findings.index("observations", i, "keyframe", o.keyframe, map.keyframes.size())) continue;
    const int session = map.keyframes[static_cast<std::size_t>(o.keyframe)].session;
    if (session < 0 || static_cast<std::size_t>(session) >= map.sessions.size()) continue;
    const auto& cameras = map.sessions[static_cast<std::size_t>(session)].rig.cameras;
    findings.index("observations", i, "camera", o.camera, cameras.size());
  }
}

void check_corners(const Map& map, Findings& findings) {
  for (std::size_t i = 0; i < map.corners.size() && !findings.full(); ++i) {
    const LoneCorner& corner = map.corners[i];
    findings.index("keyframe_corners", i, "keyframe", corner.keyframe, map.keyframes.size());
    findings.finite("keyframe_corners", i, "pixel", corner.pixel);
  }
}

void check_landmark_sessions(const Map& map, Findings& findings) {
  for (std::size_t i = 0; i < map.landmark_sessions.size() && !findings.full(); ++i) {
    const LandmarkSession& s = map.landmark_sessions[i];
    findings.index("landmark_sessions", i, "landmark", s.landmark, map.landmarks.size());
    findings.index("landmark_sessions", i, "session", s.session, map.sessions.size());
    if (s.seen < 0 || s.expected < s.seen)
      findings.add("landmark_sessions", i, "seen", std::to_string(s.seen),
                   "0 to the " + std::to_string(s.expected) + " expected");
  }
}

void check_motions(const Map& map, Findings& findings) {
  for (std::size_t i = 0; i < map.keyframes.size() && !findings.full(); ++i) {
    if (!map.keyframes[i].wheels) continue;
    findings.finite("keyframe_motions", i, "motion", map.keyframes[i].wheels->motion);
    findings.finite("keyframe_motions", i, "covariance", map.keyframes[i].wheels->covariance);
  }
}

void check_loops(const Map& map, Findings& findings) {
  for (std::size_t i = 0; i < map.loops.size() && !findings.full(); ++i) {
    const LoopEdge& loop = map.loops[i];
    findings.index("loops", i, "from", loop.from, map.keyframes.size());
    findings.index("loops", i, "to", loop.to, map.keyframes.size());
    findings.pose("loops", i, "T_from_to", loop.T_from_to);
    findings.finite("loops", i, "information", loop.information);
    findings.finite("loops", i, "weight", loop.weight);
  }
}

void count_rows(const SqlDatabase& database, const MapDigests& digests, MapReport& report) {
  for (const auto& [table, digest] : digests.tables)
    report.rows[table] = static_cast<std::size_t>(
        std::stoull(database.value("SELECT count(*) FROM " + sql_name(table))));
}

}  // namespace

std::vector<Problem> map_problems(const Map& map, std::size_t limit) {
  Findings findings(limit);
  check_sessions(map, findings);
  check_keyframes(map, findings);
  check_landmarks(map, findings);
  check_observations(map, findings);
  check_motions(map, findings);
  check_corners(map, findings);
  check_landmark_sessions(map, findings);
  check_loops(map, findings);
  return findings.take();
}

MapReport check_map(const std::filesystem::path& path) {
  MapReport report;
  try {
    const SqlDatabase database = open_map_file(path);
    const std::string fault = database.value("PRAGMA integrity_check(1)");
    if (fault != "ok") refuse_file(path, "integrity_check", fault, "ok");
    const MapDigests digests = verified_digests(database);
    if (!has_sealed_bytes(path, meta_value(database, kFileDigestKey)))
      refuse_file(path, kFileDigestKey, "other bytes between the rows",
                  "the bytes that were sealed");
    count_rows(database, digests, report);
    for (Problem& problem : event_log_problems(database))
      report.problems.push_back(std::move(problem));
    for (Problem& problem : rtree_problems(database)) report.problems.push_back(std::move(problem));
    for (Problem& problem : map_problems(read_map_tables(database))) {
      problem.file = path.string();
      report.problems.push_back(std::move(problem));
    }
    report.digest = digests.content;
  } catch (const BadInput& bad) {
    for (const Problem& problem : bad.problems()) report.problems.push_back(problem);
  }
  return report;
}

}  // namespace roadbook
