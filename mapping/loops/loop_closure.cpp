#include "mapping/loops/loop_closure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>

#include "base/parallel.hpp"
#include "mapping/loops/place_recognition.hpp"
#include "vo/feature_grid.hpp"
#include "vo/rig_pose.hpp"

namespace roadbook {
namespace {

constexpr double kSameWayRad =
    0.8;  // headings by odometry closer than this: each camera sees what it saw
constexpr double kInformationDiscount = 25.0;  // corners of one view share the errors of its points

// A corner of the earlier keyframe with its place in that keyframe's vehicle frame.
struct KnownCorner {
  int camera;
  int feature;
  Eigen::Vector3d p_vehicle;
  const Descriptor* descriptor;
};

std::vector<KnownCorner> known_corners(const VoResult& odometry, int keyframe) {
  std::vector<KnownCorner> corners;
  const VoKeyframe& k = odometry.keyframes[static_cast<std::size_t>(keyframe)];
  const Eigen::Isometry3d T_vehicle_odom = k.T_odom_vehicle.inverse();
  for (std::size_t c = 0; c < k.features.size(); ++c)
    for (std::size_t f = 0; f < k.features[c].size(); ++f) {
      const int id = k.tracks[c][f];
      if (id < 0) continue;
      const auto& p = odometry.tracks[static_cast<std::size_t>(id)].p_odom;
      if (!p) continue;
      const Eigen::Vector3d p_vehicle = T_vehicle_odom * *p;
      if (p_vehicle.norm() > 60.0) continue;  // says nothing about the position
      corners.push_back(
          {static_cast<int>(c), static_cast<int>(f), p_vehicle, &k.features[c].descriptors[f]});
    }
  return corners;
}

struct CornerMatch {
  int corner;
  int camera;  // in the later keyframe
  int feature;
};

// Nearest descriptor; of several corners that choose one feature the nearest. A place may be passed
// the other way round, so that another camera sees it: then all cameras are searched.
std::vector<CornerMatch> match_by_descriptor(const std::vector<KnownCorner>& corners,
                                             const VoKeyframe& later,
                                             bool any_camera,
                                             const LoopOptions& options) {
  struct Owner {
    int corner = -1;
    int distance = std::numeric_limits<int>::max();
  };
  std::vector<std::vector<Owner>> owners(later.features.size());
  for (std::size_t c = 0; c < later.features.size(); ++c)
    owners[c].resize(later.features[c].size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    NearestDescriptor best;
    std::size_t best_camera = 0;
    for (std::size_t c = 0; c < later.features.size(); ++c) {
      if (!any_camera && static_cast<int>(c) != corners[i].camera) continue;
      const auto near = nearest_descriptor(*corners[i].descriptor, later.features[c].descriptors);
      const int second =
          std::min({near.second, std::max(near.distance, best.distance), best.second});
      if (near.distance < best.distance) {
        best = near;
        best_camera = c;
      }
      best.second = second;
    }
    if (best.index < 0 || best.distance > options.max_hamming ||
        best.distance > options.max_ratio * best.second)
      continue;
    Owner& owner = owners[best_camera][static_cast<std::size_t>(best.index)];
    if (best.distance < owner.distance) owner = {static_cast<int>(i), best.distance};
  }
  std::vector<CornerMatch> matches;
  for (std::size_t c = 0; c < owners.size(); ++c)
    for (std::size_t f = 0; f < owners[c].size(); ++f)
      if (owners[c][f].corner >= 0)
        matches.push_back({owners[c][f].corner, static_cast<int>(c), static_cast<int>(f)});
  return matches;
}

// With the pose known, every corner has a place to be looked for.
std::vector<CornerMatch> match_by_pose(const Rig& rig,
                                       const std::vector<KnownCorner>& corners,
                                       const VoKeyframe& later,
                                       const Eigen::Isometry3d& T_later_earlier,
                                       double radius_px) {
  std::vector<CornerMatch> matches;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const auto& mounted = rig.cameras[c];
    const FeatureGrid grid(later.features[c].pixels, mounted.camera.width, mounted.camera.height);
    const Eigen::Isometry3d T_camera_earlier = mounted.T_vehicle_camera.inverse() * T_later_earlier;
    std::vector<int> taken(later.features[c].size(), -1);
    std::vector<int> distance_of(later.features[c].size(), 140);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto pixel = mounted.camera.project(T_camera_earlier * corners[i].p_vehicle);
      if (!pixel || !mounted.camera.contains(*pixel)) continue;
      grid.for_each_near(*pixel, radius_px, [&](int f) {
        const auto feature = static_cast<std::size_t>(f);
        const int distance =
            hamming(*corners[i].descriptor, later.features[c].descriptors[feature]);
        if (distance < distance_of[feature]) {
          distance_of[feature] = distance;
          taken[feature] = static_cast<int>(i);
        }
      });
    }
    for (std::size_t f = 0; f < taken.size(); ++f)
      if (taken[f] >= 0) matches.push_back({taken[f], static_cast<int>(c), static_cast<int>(f)});
  }
  return matches;
}

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
  auto matches = match_by_descriptor(corners, later_keyframe, any_camera, options);
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

// Two edges close to each other must tell the same story: the odometry between their ends is good.
bool edges_agree(const VoResult& odometry, const LoopEdge& a, const LoopEdge& b) {
  const auto T = [&](int k) {
    return odometry.keyframes[static_cast<std::size_t>(k)].T_odom_vehicle;
  };
  const Eigen::Isometry3d T_from = T(a.from).inverse() * T(b.from);
  const Eigen::Isometry3d T_to = T(a.to).inverse() * T(b.to);
  const Eigen::Isometry3d difference = (a.T_from_to * T_to).inverse() * (T_from * b.T_from_to);
  const double path = T_from.translation().norm() + T_to.translation().norm();
  return difference.translation().norm() < 0.15 + 0.1 * path &&
         so3_log(difference.linear()).norm() < 0.05 + 0.02 * path;
}

void require_agreement(const VoResult& odometry,
                       const LoopOptions& options,
                       std::vector<LoopClosure>& loops) {
  constexpr int kNeighbours = 12;
  std::vector<std::uint8_t> supported(loops.size(), 0);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!loops[i].edge.accepted) continue;
    for (std::size_t j = i + 1;
         j < loops.size() && loops[j].edge.to - loops[i].edge.to <= kNeighbours; ++j) {
      if (!loops[j].edge.accepted || loops[j].edge.to == loops[i].edge.to ||
          std::abs(loops[j].edge.from - loops[i].edge.from) > 3 * kNeighbours)
        continue;
      if (edges_agree(odometry, loops[i].edge, loops[j].edge)) supported[i] = supported[j] = 1;
    }
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    LoopEdge& edge = loops[i].edge;
    if (!edge.accepted) continue;
    edge.accepted = supported[i] || edge.inliers >= 3 * options.min_inliers;
    edge.reason = edge.accepted ? std::to_string(edge.inliers) + " corners agree"
                                : "no neighbouring revisit agrees";
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

std::vector<LoopClosure> find_loops(const MappingInput& input,
                                    const LoopOptions& options,
                                    const Progress& progress) {
  const VoResult& odometry = input.odometry;
  const auto& keyframes = odometry.keyframes;
  const auto segments = segments_of(keyframes);
  const PlaceIndex index(keyframes, options.num_threads);
  std::vector<std::vector<LoopClosure>> found(keyframes.size());
  const auto search = [&](std::size_t k) {
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
    for (const auto& candidate :
         index.similar(static_cast<int>(k), allowed, options.candidates, options.suppress)) {
      const auto earlier = static_cast<std::size_t>(candidate.keyframe);
      const Eigen::Isometry3d T =
          keyframes[earlier].T_odom_vehicle.inverse() * keyframes[k].T_odom_vehicle;
      const bool same_way =
          segments[earlier] == segments[k] && has_wheels && std::abs(heading_of(T)) < kSameWayRad;
      found[k].push_back(verify(input.rig_of(static_cast<int>(k)), odometry, candidate.keyframe,
                                static_cast<int>(k), !same_way, options));
    }
  };
  constexpr std::size_t kBlock = 32;
  for (std::size_t begin = 0; begin < keyframes.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, keyframes.size() - begin);
    parallel_for(count, options.num_threads, [&](std::size_t i) { search(begin + i); });
    report(progress, "loops", begin + count, keyframes.size());
  }
  std::vector<LoopClosure> loops;
  for (auto& list : found)
    for (auto& loop : list) loops.push_back(std::move(loop));
  require_agreement(odometry, options, loops);
  return loops;
}

}  // namespace roadbook
