#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/median.hpp"
#include "mapping/known_covariance.hpp"
#include "mapping/similarity.hpp"
#include "workflows/compare/landmark_matches.hpp"
#include "workflows/compare/map_comparison.hpp"
#include "workflows/report/map_quality.hpp"

namespace roadbook {
namespace {

constexpr double kStillSigmas = 3.0;
constexpr double kStillM = 0.05;

// Index in B of each session of A, -1 where B lacks its drive. A drive is in a map once.
std::vector<int> sessions_in_other(const Map& a, const Map& b) {
  std::map<std::string, int> by_digest;
  for (std::size_t i = 0; i < b.sessions.size(); ++i)
    by_digest.emplace(b.sessions[i].drive_digest, static_cast<int>(i));
  std::vector<int> other;
  for (const Session& session : a.sessions) {
    const auto found = by_digest.find(session.drive_digest);
    other.push_back(found == by_digest.end() ? -1 : found->second);
  }
  return other;
}

void name_sessions(const Map& a, const Map& b, const std::vector<int>& other, MapComparison& c) {
  std::set<int> taken;
  for (std::size_t i = 0; i < other.size(); ++i) {
    (other[i] < 0 ? c.sessions_only_a : c.common_sessions).push_back(a.sessions[i].name);
    taken.insert(other[i]);
  }
  for (std::size_t i = 0; i < b.sessions.size(); ++i)
    if (!taken.contains(static_cast<int>(i))) c.sessions_only_b.push_back(b.sessions[i].name);
}

// Keyframe of B for each of A, -1 where B lacks it.
std::vector<int> keyframes_in_other(const Map& a, const Map& b, const std::vector<int>& other) {
  std::map<std::pair<int, std::int64_t>, int> by_stamp;
  for (std::size_t i = 0; i < b.keyframes.size(); ++i)
    by_stamp.emplace(std::pair(b.keyframes[i].session, b.keyframes[i].t_ns), static_cast<int>(i));
  std::vector<int> same;
  for (const Keyframe& keyframe : a.keyframes) {
    const auto found =
        by_stamp.find({other[static_cast<std::size_t>(keyframe.session)], keyframe.t_ns});
    same.push_back(found == by_stamp.end() ? -1 : found->second);
  }
  return same;
}

int piece_of(const Map& map, int keyframe) {
  return map.keyframes[static_cast<std::size_t>(keyframe)].piece;
}

// Keeps the common poses of the pair of pieces that has the most; the first pair of equal ones.
void choose_pieces(const Map& a, const Map& b, const std::vector<int>& same, MapComparison& c) {
  std::map<std::pair<int, int>, std::vector<ComparedPose>> groups;
  std::size_t all = 0;
  for (std::size_t i = 0; i < same.size(); ++i) {
    if (same[i] < 0) continue;
    const int k = static_cast<int>(i);
    groups[{piece_of(a, k), piece_of(b, same[i])}].push_back({k, same[i], 0.0, 0.0});
    ++all;
  }
  for (auto& [pieces, poses] : groups)
    if (poses.size() > c.poses.size()) c.poses = std::move(poses);
  c.poses_of_other_pieces = all - c.poses.size();
}

Eigen::Isometry3d motion_between(const Map& a, const Map& b, const MapComparison& c) {
  std::vector<Eigen::Vector3d> in_a;
  std::vector<Eigen::Vector3d> in_b;
  for (const ComparedPose& pose : c.poses)
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector3d p = side * Eigen::Vector3d::Unit(axis);
        in_a.emplace_back(a.T_map_vehicle(pose.a) * p);
        in_b.emplace_back(b.T_map_vehicle(pose.b) * p);
      }
  const Similarity motion = align(in_a, in_b, false);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = motion.R;
  T.translation() = motion.t;
  return T;
}

void compare_poses(const Map& a, const Map& b, MapComparison& c) {
  if (c.poses.empty()) return;
  c.T_a_b = motion_between(a, b, c);
  std::vector<double> distances;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < c.poses.size(); ++i) {
    ComparedPose& pose = c.poses[i];
    const Eigen::Isometry3d in_a = a.T_map_vehicle(pose.a);
    const Eigen::Isometry3d in_b = *c.T_a_b * b.T_map_vehicle(pose.b);
    pose.distance_m = (in_a.translation() - in_b.translation()).norm();
    pose.angle_rad =
        Eigen::Quaterniond(in_a.linear()).angularDistance(Eigen::Quaterniond(in_b.linear()));
    if (pose.distance_m > c.poses[worst].distance_m) worst = i;
    distances.push_back(pose.distance_m);
  }
  c.median_m = median(distances);
  c.p95_m = sample_quantile(distances, 0.95);
  c.worst = worst;
}

// Standard deviation of `difference` along itself; `covariance` is that of the difference.
double sigma_along(const Eigen::Vector3d& difference, const Eigen::Matrix3d& covariance) {
  const double square = difference.squaredNorm();
  return square > 0.0 ? std::sqrt(difference.dot(covariance * difference) / square) : 0.0;
}

std::vector<int> unmarked(const std::vector<char>& marks) {
  std::vector<int> list;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i] == 0) list.push_back(static_cast<int>(i));
  return list;
}

void compare_landmarks(const Map& a, const Map& b, const std::vector<int>& same, MapComparison& c) {
  std::set<int> joined;  // keyframes of A whose places can be compared
  for (const ComparedPose& pose : c.poses) joined.insert(pose.a);
  LandmarkComparison& counts = c.landmarks;
  std::vector<char> in_both_a(a.landmarks.size(), 0);
  std::vector<char> in_both_b(b.landmarks.size(), 0);
  std::vector<double> distances;
  for (const LandmarkMatch& match : landmark_matches(a, b, same)) {
    ++counts.both;
    in_both_a[static_cast<std::size_t>(match.a)] = 1;
    in_both_b[static_cast<std::size_t>(match.b)] = 1;
    if (!joined.contains(match.keyframe)) continue;
    ++counts.compared;
    const Landmark& in_a = a.landmarks[static_cast<std::size_t>(match.a)];
    const Landmark& in_b = b.landmarks[static_cast<std::size_t>(match.b)];
    const Eigen::Vector3d difference = a.p_map(in_a) - *c.T_a_b * b.p_map(in_b);
    distances.push_back(difference.norm());
    if (!is_known(in_a.covariance) || !is_known(in_b.covariance)) continue;
    ++counts.judged;
    const Eigen::Matrix3d R = c.T_a_b->linear();
    const Eigen::Matrix3d covariance = in_a.covariance + R * in_b.covariance * R.transpose();
    if (difference.norm() <= kStillSigmas * sigma_along(difference, covariance) + kStillM) continue;
    ++counts.moved;
    counts.moved_ids.emplace_back(match.a, match.b);
  }
  counts.ids_only_a = unmarked(in_both_a);
  counts.ids_only_b = unmarked(in_both_b);
  counts.only_a = a.landmarks.size() - counts.both;
  counts.only_b = b.landmarks.size() - counts.both;
  if (!distances.empty()) counts.median_m = median(distances);
}

// A loop, whichever of its ends comes first; keyframes that A lacks have negative numbers.
using LoopEnds = std::pair<int, int>;

std::set<LoopEnds> accepted_loops(const Map& map, const std::vector<int>& name) {
  std::set<LoopEnds> loops;
  for (const LoopEdge& loop : map.loops) {
    if (!loop.accepted) continue;
    loops.insert(std::minmax(
        {name[static_cast<std::size_t>(loop.from)], name[static_cast<std::size_t>(loop.to)]}));
  }
  return loops;
}

void compare_loops(const Map& a, const Map& b, const std::vector<int>& same, MapComparison& c) {
  std::vector<int> names_a(a.keyframes.size());
  std::vector<int> names_b(b.keyframes.size());
  for (std::size_t i = 0; i < names_b.size(); ++i) names_b[i] = -1 - static_cast<int>(i);
  for (std::size_t i = 0; i < names_a.size(); ++i) {
    names_a[i] = static_cast<int>(i);
    if (same[i] >= 0) names_b[static_cast<std::size_t>(same[i])] = static_cast<int>(i);
  }
  const std::set<LoopEnds> in_a = accepted_loops(a, names_a);
  const std::set<LoopEnds> in_b = accepted_loops(b, names_b);
  for (const LoopEnds& loop : in_a) ++(in_b.contains(loop) ? c.loops.both : c.loops.only_a);
  c.loops.only_b = in_b.size() - c.loops.both;
}

}  // namespace

MapComparison compare_maps(const Map& a, const Map& b) {
  MapComparison comparison;
  const std::vector<int> other = sessions_in_other(a, b);
  name_sessions(a, b, other, comparison);
  const std::vector<int> same = keyframes_in_other(a, b, other);
  choose_pieces(a, b, same, comparison);
  compare_poses(a, b, comparison);
  compare_landmarks(a, b, same, comparison);
  compare_loops(a, b, same, comparison);
  return comparison;
}

}  // namespace roadbook
