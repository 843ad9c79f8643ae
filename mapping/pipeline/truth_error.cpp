#include "mapping/pipeline/truth_error.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "base/se3.hpp"
#include "drive/true_poses.hpp"
#include "mapping/pieces.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kTruthToleranceNs = 5'000'000;
constexpr std::size_t kLeastKeyframes = 3;

bool has_free_scale(const Session& session) { return session.scale_source == ScaleSource::kFree; }

SessionTruthError session_error(const Map& map, int session, const std::vector<TimedPose>& truth) {
  std::vector<std::int64_t> truth_ns;
  std::vector<std::int64_t> map_ns;
  std::vector<int> keyframes;
  for (const TimedPose& pose : truth) truth_ns.push_back(pose.t_ns);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    if (map.keyframes[k].session == session) {
      map_ns.push_back(map.keyframes[k].t_ns);
      keyframes.push_back(static_cast<int>(k));
    }
  SessionTruthError result;
  result.session = session;
  for (const auto& [a, b] : associate_stamps(truth_ns, map_ns, kTruthToleranceNs)) {
    result.keyframes.push_back(keyframes[b]);
    result.truth_m.push_back(truth[a].T_world_vehicle.translation());
    result.position_m.push_back(map.T_map_vehicle(keyframes[b]).translation());
  }
  result.error = trajectory_error(result.truth_m, result.position_m,
                                  has_free_scale(map.sessions[static_cast<std::size_t>(session)]));
  return result;
}

bool is_in_one_piece(const Map& map, const std::vector<int>& keyframes) {
  const auto piece = [&](int k) { return map.keyframes[static_cast<std::size_t>(k)].piece; };
  return std::all_of(keyframes.begin(), keyframes.end(),
                     [&](int k) { return piece(k) == piece(keyframes.front()); });
}

// Returns why one alignment of all sessions means nothing; empty if it does.
std::string why_apart(const Map& map,
                      const std::vector<DriveTruth>& truths,
                      const std::vector<SessionTruthError>& sessions) {
  if (piece_count(map) > 1) return "the map has pieces that nothing joins";
  if (truths.size() == 1) return {};
  if (sessions.size() < truths.size()) return "not all sessions have truth";
  for (const DriveTruth& truth : truths) {
    if (!truth.world) return "recorded references have no common world";
    if (*truth.world != *truths.front().world)
      return "the drives are of different worlds (" + *truths.front().world + "; " + *truth.world +
             ")";
  }
  return {};
}

Eigen::Vector3d mean_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

SessionOffset offset_of(const SessionTruthError& session, const Similarity& T_world_map) {
  SessionOffset offset;
  const Eigen::Vector3d truth_in_map =
      T_world_map.R.transpose() * (mean_of(session.truth_m) - T_world_map.t) / T_world_map.scale;
  offset.shift_m = mean_of(session.position_m) - truth_in_map;
  const Similarity& own = session.error.T_reference_estimate;
  if (!own.unique) return offset;
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = own.R.transpose() * T_world_map.R;
  offset.heading_rad = heading_of(turn);
  return offset;
}

}  // namespace

DriveTruth truth_of_drive(const Drive& drive) { return {true_poses(drive), true_world(drive)}; }

const SessionTruthError* TruthErrors::of_session(int session) const {
  const auto found = std::find_if(sessions.begin(), sessions.end(),
                                  [&](const auto& s) { return s.session == session; });
  return found == sessions.end() ? nullptr : &*found;
}

TruthErrors truth_errors(const Map& map, const std::vector<DriveTruth>& truths) {
  ROADBOOK_ASSERT(truths.size() == map.sessions.size());
  TruthErrors result;
  bool has_truth = false;
  for (std::size_t s = 0; s < truths.size(); ++s) {
    SessionTruthError session = session_error(map, static_cast<int>(s), truths[s].poses);
    if (session.keyframes.size() < kLeastKeyframes) continue;
    has_truth = true;
    if (is_in_one_piece(map, session.keyframes)) result.sessions.push_back(std::move(session));
  }
  if (!has_truth) return result;
  result.apart = why_apart(map, truths, result.sessions);
  if (!result.apart.empty()) return result;
  std::vector<Eigen::Vector3d> truth;
  std::vector<Eigen::Vector3d> positions;
  for (const SessionTruthError& session : result.sessions) {
    truth.insert(truth.end(), session.truth_m.begin(), session.truth_m.end());
    positions.insert(positions.end(), session.position_m.begin(), session.position_m.end());
  }
  result.together = trajectory_error(
      truth, positions, std::all_of(map.sessions.begin(), map.sessions.end(), has_free_scale));
  if (result.sessions.size() == 1) return result;
  for (SessionTruthError& session : result.sessions)
    session.offset = offset_of(session, result.together->T_reference_estimate);
  return result;
}

}  // namespace roadbook
