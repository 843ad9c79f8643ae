#include "mapping/pipeline/scaled_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.hpp"
#include "mapping/loops/loop_closure.hpp"
#include "mapping/loops/loop_scale.hpp"
#include "mapping/optimisation/graph_relaxation.hpp"
#include "sensors/camera_centre.hpp"

namespace roadbook {
namespace {

constexpr double kScaleStepSigma = 0.01;  // drift of log scale from keyframe to keyframe
constexpr double kUnknownScaleSigma = 1.0;
constexpr int kPriorSpacing = 25;  // keyframes: priors of non-overlapping windows are independent
constexpr double kMaxLoopChi2 = 29.88;  // 7 degrees of freedom, p = 1e-4

std::vector<Eigen::Isometry3d> poses_of_odometry(const MappingInput& input) {
  std::vector<Eigen::Isometry3d> poses;
  for (const auto& k : input.odometry.keyframes) poses.push_back(k.T_odom_vehicle);
  return poses;
}

// The frame whose motions have the odometry's unit: the vehicle frame, moved to the cameras.
Eigen::Isometry3d vehicle_to_centre(const MappingInput& input, int keyframe) {
  const Eigen::Isometry3d T(Eigen::Translation3d{centre_of_cameras(input.rig_of(keyframe))});
  return T;
}

// A measured motion of the vehicle (between `from` and `to`) as a motion of the centres, and back.
void move_to_centres(const MappingInput& input, RelativePose& edge) {
  const Eigen::Isometry3d to = vehicle_to_centre(input, edge.to);
  edge.T_from_to = vehicle_to_centre(input, edge.from).inverse() * edge.T_from_to * to;
  const Matrix6d Ad = se3_adjoint(to);
  edge.information = Ad.transpose() * edge.information * Ad;
}

void move_to_vehicles(const MappingInput& input, RelativePose& edge) {
  const Eigen::Isometry3d to = vehicle_to_centre(input, edge.to);
  edge.T_from_to = vehicle_to_centre(input, edge.from) * edge.T_from_to * to.inverse();
  const Matrix6d Ad = se3_adjoint(to.inverse());
  edge.information = Ad.transpose() * edge.information * Ad;
}

void multiply_lengths(double factor, RelativePose& edge) {
  edge.T_from_to.translation() *= factor;
  edge.information.topLeftCorner<3, 3>() /= factor * factor;
  edge.information.topRightCorner<3, 3>() /= factor;
  edge.information.bottomLeftCorner<3, 3>() /= factor;
}

void rescale_stretches(MappingInput& input,
                       std::size_t begin,
                       std::size_t end,
                       const std::vector<double>& factor) {
  auto& keyframes = input.odometry.keyframes;
  const auto before = poses_of_odometry(input);
  for (std::size_t k = begin + 1; k < end; ++k) {
    RelativePose step{static_cast<int>(k) - 1, static_cast<int>(k),
                      before[k - 1].inverse() * before[k], keyframes[k].information};
    move_to_centres(input, step);
    multiply_lengths(factor[k - 1], step);
    move_to_vehicles(input, step);
    keyframes[k].T_odom_vehicle = keyframes[k - 1].T_odom_vehicle * step.T_from_to;
    keyframes[k].information = step.information;
    if (auto& seen = keyframes[k].ground_log_scale) *seen -= std::log(factor[k - 1]);
    keyframes[k].travelled_m = keyframes[k - 1].travelled_m + step.T_from_to.translation().norm();
  }
}

// Windows that show a wall or a parked car as ground give scales that jump. Keeps, in each stretch,
// the estimates that follow each other without a jump, from the median estimate to both ends.
std::vector<LocalScale> continuous_scales(const MappingInput& input,
                                          const std::vector<LocalScale>& local) {
  constexpr double kJump = 0.3;            // of the logarithm of the scale
  constexpr double kJumpAKeyframe = 0.01;  // more where keyframes without an estimate lie between
  const auto segments = segments_of(input.odometry.keyframes);
  std::vector<LocalScale> kept;
  for (std::size_t begin = 0, end = 0; begin < local.size(); begin = end) {
    const int segment = segments[at(local[begin].keyframe)];
    while (end < local.size() && segments[at(local[end].keyframe)] == segment) ++end;
    std::vector<std::size_t> order;
    for (std::size_t i = begin; i < end; ++i) order.push_back(i);
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
    std::nth_element(order.begin(), middle, order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(local[a].log_scale, a) < std::pair(local[b].log_scale, b);
    });
    const std::size_t seed = *middle;
    const auto follows = [&](const LocalScale& a, const LocalScale& b) {
      return std::abs(a.log_scale - b.log_scale) <=
             kJump + kJumpAKeyframe * std::abs(a.keyframe - b.keyframe);
    };
    std::vector<std::size_t> chain{seed};
    for (std::size_t i = seed, last = seed; i-- > begin;)
      if (follows(local[last], local[i])) chain.push_back(last = i);
    for (std::size_t i = seed + 1, last = seed; i < end; ++i)
      if (follows(local[last], local[i])) chain.push_back(last = i);
    std::sort(chain.begin(), chain.end());
    for (const std::size_t i : chain) kept.push_back(local[i]);
  }
  return kept;
}

// Factor on the motion from each keyframe: between estimates of a stretch the logarithm is linear,
// before and behind them constant. Where no window before or behind has enough ground, `elsewhere`.
std::vector<double> factors_of(const MappingInput& input,
                               const std::vector<LocalScale>& scales,
                               const std::vector<std::optional<double>>& elsewhere) {
  const auto segments = segments_of(input.odometry.keyframes);
  std::vector<double> factors;
  for (const auto& factor : elsewhere) factors.push_back(factor.value_or(1.0));
  std::size_t next = 0;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    while (next < scales.size() && at(scales[next].keyframe) < k) ++next;
    const auto of_segment = [&](std::size_t i) {
      return i < scales.size() && segments[at(scales[i].keyframe)] == segments[k];
    };
    const bool has_after = of_segment(next);
    const bool has_before = next > 0 && of_segment(next - 1);
    if (has_after && has_before) {
      const LocalScale& a = scales[next - 1];
      const LocalScale& b = scales[next];
      const double share = (static_cast<double>(k) - a.keyframe) / (b.keyframe - a.keyframe);
      factors[k] = std::exp(a.log_scale + share * (b.log_scale - a.log_scale));
    } else if (!elsewhere[k] && (has_after || has_before)) {
      factors[k] = std::exp(scales[has_after ? next : next - 1].log_scale);
    }
  }
  return factors;
}

PoseGraph scaled_graph(const MappingInput& input, const std::vector<LocalScale>& heights) {
  const auto& keyframes = input.odometry.keyframes;
  PoseGraph graph;
  graph.pose_scales.resize(keyframes.size());
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const auto index = static_cast<int>(k);
    graph.T_map_vehicle.push_back(keyframes[k].T_odom_vehicle * vehicle_to_centre(input, index));
    graph.pose_scales[k].fixed = input.has_wheels[at(input.session[k])];
    if (k == 0 || keyframes[k].after_gap) {
      // Without any prior, the scale of a stretch would be free.
      graph.pose_scales[k].prior_sigma = kUnknownScaleSigma;
      continue;
    }
    RelativePose step{index - 1, index,
                      keyframes[k - 1].T_odom_vehicle.inverse() * keyframes[k].T_odom_vehicle,
                      keyframes[k].information};
    move_to_centres(input, step);
    step.log_scale_sigma = kScaleStepSigma;
    graph.odometry.push_back(step);
  }
  for (const LocalScale& height : heights) {
    PoseScale& scale = graph.pose_scales[at(height.keyframe)];
    scale.prior = height.log_scale;
    scale.prior_sigma = height.sigma;
  }
  // Start values: scales by the heights, poses chained by the odometry with these scales.
  const auto factors =
      factors_of(input, heights, std::vector<std::optional<double>>(keyframes.size()));
  for (std::size_t k = 0; k < factors.size(); ++k)
    if (!graph.pose_scales[k].fixed) graph.pose_scales[k].log_scale = std::log(factors[k]);
  for (const RelativePose& step : graph.odometry) {
    Eigen::Isometry3d T = step.T_from_to;
    T.translation() *= std::exp(graph.pose_scales[at(step.from)].log_scale);
    graph.T_map_vehicle[at(step.to)] = graph.T_map_vehicle[at(step.from)] * T;
  }
  if (heights.empty()) graph.pose_scales[at(graph.fixed)].fixed = true;
  return graph;
}

}  // namespace

SessionScale scale_session(MappingInput& input, int session, const MapOptions& options) {
  SessionScale scale;
  const auto first = std::find(input.session.begin(), input.session.end(), session);
  const auto begin = static_cast<std::size_t>(first - input.session.begin());
  const auto end = begin + static_cast<std::size_t>(
                               std::count(input.session.begin(), input.session.end(), session));
  if (begin == end || !known_camera_height(input.rig_of(static_cast<int>(begin)))) return scale;
  // Triangulation and the choice of ground points depend on the scale: two rounds, then the windows
  // of the scaled odometry.
  for (int round = 0; round < 3; ++round) {
    const auto poses = poses_of_odometry(input);
    auto tracks = join_tracks(input.odometry, {});
    triangulate_tracks(input, poses, options.triangulation, tracks);
    const auto profile = ground_scale_profile(input, poses, tracks);
    if (!profile.found) break;
    scale.sigma = largest_sigma(profile, begin, end);
    const auto scales = continuous_scales(input, profile.local);
    if (round < 2) {
      std::vector<std::optional<double>> elsewhere(profile.factor.begin(), profile.factor.end());
      for (const LocalScale& window : profile.local) elsewhere[at(window.keyframe)].reset();
      rescale_stretches(input, begin, end, factors_of(input, scales, elsewhere));
      continue;
    }
    int next = 0;
    for (const LocalScale& window : scales) {
      if (window.keyframe < next || input.session[at(window.keyframe)] != session) continue;
      scale.windows.push_back(window);
      next = window.keyframe + kPriorSpacing;
    }
  }
  const auto places =
      triangulate_odometry_tracks(input, poses_of_odometry(input), options.triangulation);
  for (std::size_t t = 0; t < places.size(); ++t) input.odometry.tracks[t].p_odom = places[t];
  return scale;
}

Relaxed relax_scaled_poses(const MappingInput& input,
                           const std::vector<LocalScale>& heights,
                           std::vector<LoopClosure>& loops,
                           const MapOptions& options,
                           const Progress& progress) {
  PoseGraph graph = scaled_graph(input, heights);
  std::vector<std::size_t> in_graph;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!loops[i].edge.accepted) continue;
    const LoopEdge& edge = loops[i].edge;
    RelativePose loop{edge.from, edge.to, edge.T_from_to, edge.information};
    move_to_centres(input, loop);
    loop.log_scale = loops[i].log_scale;
    loop.log_scale_sigma = loops[i].log_scale_sigma;
    in_graph.push_back(i);
    graph.loops.push_back(loop);
  }
  PoseGraphOptions graph_options = options.graph;
  graph_options.max_loop_chi2 = std::max(graph_options.max_loop_chi2, kMaxLoopChi2);
  const auto result = relax(graph, graph_options, progress);
  if (!result.usable)
    throw Refused("error: pose graph: got " + result.message + ", want a solution");
  for (std::size_t i = 0; i < in_graph.size(); ++i) {
    LoopEdge& edge = loops[in_graph[i]].edge;
    RelativePose metric = graph.loops[i];
    multiply_lengths(std::exp(result.log_scales[at(edge.from)]), metric);
    move_to_vehicles(input, metric);
    edge.T_from_to = metric.T_from_to;
    edge.information = metric.information;
    edge.weight = result.loop_weights[i];
    if (result.loop_accepted[i]) continue;
    edge.accepted = false;
    edge.reason = "contradicts odometry and the other loops";
  }
  Relaxed relaxed{{}, result.component, result.components};
  for (std::size_t k = 0; k < result.T_map_vehicle.size(); ++k)
    relaxed.T_map_vehicle.push_back(result.T_map_vehicle[k] *
                                    vehicle_to_centre(input, static_cast<int>(k)).inverse());
  return relaxed;
}

}  // namespace roadbook
