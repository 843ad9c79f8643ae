#include "mapping/loops/loop_closure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>

#include "base/parallel.hpp"
#include "mapping/loops/corner_matches.hpp"
#include "mapping/loops/loop_scale.hpp"
#include "mapping/loops/odometry_check.hpp"
#include "mapping/loops/place_recognition.hpp"
#include "mapping/union_find.hpp"
#include "sensors/camera_centre.hpp"
#include "vo/rig_pose.hpp"

namespace roadbook {
namespace {

constexpr double kSameWayRad =
    0.8;  // headings by odometry closer than this: each camera sees what it saw
constexpr double kInformationDiscount = 25.0;  // corners of one view share the errors of its points

std::vector<RigObservation> observations_of(const std::vector<CornerMatch>& matches,
                                            const std::vector<KnownCorner>& corners,
                                            const VoKeyframe& later) {
  std::vector<RigObservation> seen;
  seen.reserve(matches.size());
  for (const auto& m : matches)
    seen.push_back({m.camera,
                    later.features[static_cast<std::size_t>(m.camera)]
                        .pixels[static_cast<std::size_t>(m.feature)]
                        .cast<double>(),
                    corners[static_cast<std::size_t>(m.corner)].p_vehicle});
  return seen;
}

LoopClosure verify(const Rig& rig,
                   const VoResult& odometry,
                   int earlier,
                   int later,
                   bool any_camera,
                   const LoopOptions& options) {
  LoopClosure loop;
  loop.edge.from = earlier;
  loop.edge.to = later;
  const VoKeyframe& later_keyframe = odometry.keyframes[static_cast<std::size_t>(later)];
  const auto corners = known_corners(odometry, earlier);
  auto matches = match_by_descriptor(corners, later_keyframe, any_camera,
                                     {options.max_hamming, options.max_ratio});
  const int min_inliers =
      rig.cameras.size() > 1 ? options.min_inliers : 2 * options.min_inliers / 3;
  RigPoseOptions pose_options;
  pose_options.inlier_px = options.inlier_px;
  pose_options.ransac_iterations = 150;
  if (static_cast<int>(matches.size()) < min_inliers / 2) {
    loop.edge.reason = "only " + std::to_string(matches.size()) + " corners look alike";
    return loop;
  }
  auto pose = find_rig_pose(rig, observations_of(matches, corners, later_keyframe), pose_options);
  if (!pose || pose->inliers < min_inliers / 3) {
    loop.edge.reason = "no pose agrees with the corners that look alike";
    return loop;
  }
  for (const double radius : {6.0, 4.0}) {
    matches = match_by_pose(rig, corners, later_keyframe, pose->T_world_vehicle.inverse(), radius);
    const auto refined = refine_rig_pose(rig, observations_of(matches, corners, later_keyframe),
                                         pose->T_world_vehicle, std::nullopt, pose_options);
    if (!refined) break;
    pose = refined;
  }
  loop.edge.T_from_to = pose->T_world_vehicle;
  loop.edge.inliers = pose->inliers;
  loop.edge.information = pose->information / kInformationDiscount;
  if (pose->inliers < min_inliers) {
    loop.edge.reason = "only " + std::to_string(pose->inliers) + " corners agree on a pose";
    return loop;
  }
  if (pose->inliers < options.min_inlier_share * static_cast<double>(matches.size())) {
    loop.edge.reason = "most corners that look alike disagree with the pose";
    return loop;
  }
  if (pose->T_world_vehicle.translation().norm() > options.max_offset_m) {
    loop.edge.reason = "the two poses lie too far apart";
    return loop;
  }
  loop.edge.accepted = true;
  for (std::size_t i = 0; i < pose->inlier.size() && i < matches.size(); ++i) {
    if (!pose->inlier[i]) continue;
    const KnownCorner& corner = corners[static_cast<std::size_t>(matches[i].corner)];
    loop.matches.push_back({corner.camera, corner.feature, matches[i].camera, matches[i].feature});
  }
  return loop;
}

// The motion between two later ends in the unit of the earlier pass: the cameras' centre moves by
// the measured scale, the vehicle around it by the known lever arm.
Eigen::Isometry3d rescaled(const Eigen::Isometry3d& T_to,
                           const Eigen::Vector3d& centre,
                           double log_scale) {
  const Eigen::Isometry3d T_vehicle_centre(Eigen::Translation3d{centre});
  Eigen::Isometry3d T = T_vehicle_centre.inverse() * T_to * T_vehicle_centre;
  T.translation() *= std::exp(log_scale);
  return T_vehicle_centre * T * T_vehicle_centre.inverse();
}

// Two edges close to each other must tell the same story: the odometry between their ends is good.
// Without wheels, the scale between the two passes must agree too, and is applied first.
bool edges_agree(const MappingInput& input, const LoopClosure& one, const LoopClosure& other) {
  const LoopEdge& a = one.edge;
  const LoopEdge& b = other.edge;
  const auto T = [&](int k) {
    return input.odometry.keyframes[static_cast<std::size_t>(k)].T_odom_vehicle;
  };
  const Eigen::Isometry3d T_from = T(a.from).inverse() * T(b.from);
  Eigen::Isometry3d T_to = T(a.to).inverse() * T(b.to);
  if (one.log_scale_sigma > 0.0 && other.log_scale_sigma > 0.0) {
    constexpr double kSigmas = 3.0;
    constexpr double kDrift = 0.1;  // of the scale between two neighbouring loops
    if (std::abs(one.log_scale - other.log_scale) >
        kDrift + kSigmas * std::hypot(one.log_scale_sigma, other.log_scale_sigma))
      return false;
    T_to = rescaled(T_to, centre_of_cameras(input.rig_of(a.to)), one.log_scale);
  }
  const Eigen::Isometry3d difference = (a.T_from_to * T_to).inverse() * (T_from * b.T_from_to);
  const double path = T_from.translation().norm() + T_to.translation().norm();
  return difference.translation().norm() < 0.15 + 0.1 * path &&
         so3_log(difference.linear()).norm() < 0.05 + 0.02 * path;
}

// Returns the number of each loop's stretch: neighbours that agree, and the neighbours of these.
std::vector<int> require_agreement(const MappingInput& input,
                                   const LoopOptions& options,
                                   std::vector<LoopClosure>& loops) {
  constexpr int kNeighbours = 12;
  UnionFind stretches(loops.size());
  std::vector<std::uint8_t> supported(loops.size(), 0);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!loops[i].edge.accepted) continue;
    for (std::size_t j = i + 1;
         j < loops.size() && loops[j].edge.to - loops[i].edge.to <= kNeighbours; ++j) {
      if (!loops[j].edge.accepted || loops[j].edge.to == loops[i].edge.to ||
          std::abs(loops[j].edge.from - loops[i].edge.from) > 3 * kNeighbours)
        continue;
      if (!edges_agree(input, loops[i], loops[j])) continue;
      supported[i] = supported[j] = 1;
      stretches.join(static_cast<int>(i), static_cast<int>(j));
    }
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    LoopEdge& edge = loops[i].edge;
    if (!edge.accepted) continue;
    edge.accepted = supported[i] || edge.inliers >= 3 * options.min_inliers;
    edge.reason = edge.accepted ? std::to_string(edge.inliers) + " corners agree"
                                : "no neighbouring revisit agrees";
  }
  return stretches.numbers();
}

// Drives without wheels are not judged: their scale may drift.
void reject_by_odometry(const MappingInput& input,
                        const std::vector<int>& stretches,
                        std::vector<LoopClosure>& loops) {
  std::vector<std::size_t> judged;
  std::vector<LoopEdge> edges;
  std::vector<int> stretch;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const LoopEdge& edge = loops[i].edge;
    const int session = input.session[static_cast<std::size_t>(edge.to)];
    if (!edge.accepted || !input.has_wheels[static_cast<std::size_t>(session)]) continue;
    judged.push_back(i);
    edges.push_back(edge);
    stretch.push_back(stretches[i]);
  }
  const auto contradicts = contradict_odometry(input.odometry.keyframes, edges, stretch);
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (contradicts[k] == 0) continue;
    loops[judged[k]].edge.accepted = false;
    loops[judged[k]].edge.reason = "the odometry contradicts its height or tilt (another storey?)";
  }
}

}  // namespace

std::vector<int> segments_of(const std::vector<VoKeyframe>& keyframes) {
  std::vector<int> segments;
  int segment = 0;
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    if (k > 0 && keyframes[k].after_gap) ++segment;
    segments.push_back(segment);
  }
  return segments;
}

std::vector<LoopClosure> verify_loops(const MappingInput& input,
                                      const std::vector<KeyframePair>& pairs,
                                      const LoopOptions& options,
                                      const Progress& progress) {
  const auto& keyframes = input.odometry.keyframes;
  const auto segments = segments_of(keyframes);
  std::vector<LoopClosure> loops(pairs.size());
  const auto verify_pair = [&](std::size_t i) {
    const auto earlier = static_cast<std::size_t>(pairs[i].earlier);
    const auto later = static_cast<std::size_t>(pairs[i].later);
    const Eigen::Isometry3d T =
        keyframes[earlier].T_odom_vehicle.inverse() * keyframes[later].T_odom_vehicle;
    const bool has_wheels = input.has_wheels[static_cast<std::size_t>(input.session[later])];
    const bool same_way =
        segments[earlier] == segments[later] && has_wheels && std::abs(heading_of(T)) < kSameWayRad;
    loops[i] = verify(input.rig_of(pairs[i].later), input.odometry, pairs[i].earlier,
                      pairs[i].later, !same_way, options);
    const bool metric =
        has_wheels && input.has_wheels[static_cast<std::size_t>(input.session[earlier])];
    if (metric || !loops[i].edge.accepted) return;
    const auto scale = scale_of_loop(input.rig_of(pairs[i].later), input.odometry, loops[i].edge,
                                     loops[i].matches);
    if (!scale) return;
    loops[i].log_scale = scale->log_scale;
    loops[i].log_scale_sigma = scale->sigma;
  };
  constexpr std::size_t kBlock = 96;
  for (std::size_t begin = 0; begin < pairs.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, pairs.size() - begin);
    parallel_for(count, options.num_threads, [&](std::size_t i) { verify_pair(begin + i); });
    report(progress, "loops", begin + count, pairs.size());
  }
  const std::vector<int> stretches = require_agreement(input, options, loops);
  reject_by_odometry(input, stretches, loops);
  return loops;
}

std::vector<LoopClosure> find_loops(const MappingInput& input,
                                    const LoopOptions& options,
                                    const Progress& progress) {
  const auto& keyframes = input.odometry.keyframes;
  const auto segments = segments_of(keyframes);
  const PlaceIndex index(keyframes, options.num_threads);
  std::vector<std::vector<PlaceCandidate>> similar(keyframes.size());
  parallel_for(keyframes.size(), options.num_threads, [&](std::size_t k) {
    const bool has_wheels = input.has_wheels[static_cast<std::size_t>(input.session[k])];
    const double drift = has_wheels ? options.drift_fraction : options.drift_fraction_blind;
    const auto allowed = [&](int earlier) {
      const auto& other = keyframes[static_cast<std::size_t>(earlier)];
      if (segments[static_cast<std::size_t>(earlier)] != segments[k]) return true;
      const double travelled = keyframes[k].travelled_m - other.travelled_m;
      if (travelled < options.min_travel_m) return false;
      const double apart =
          (keyframes[k].T_odom_vehicle.translation() - other.T_odom_vehicle.translation()).norm();
      return apart < options.gate_m + drift * travelled;
    };
    similar[k] = index.similar(static_cast<int>(k), allowed, options.candidates, options.suppress);
  });
  std::vector<KeyframePair> pairs;
  for (std::size_t k = 0; k < similar.size(); ++k)
    for (const PlaceCandidate& candidate : similar[k])
      pairs.push_back({candidate.keyframe, static_cast<int>(k)});
  return verify_loops(input, pairs, options, progress);
}

}  // namespace roadbook
