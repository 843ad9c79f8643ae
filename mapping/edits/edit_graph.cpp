#include "mapping/edits/edit_graph.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/format.hpp"
#include "base/index.hpp"
#include "mapping/edits/edit_motion.hpp"
#include "mapping/loops/loop_misfit.hpp"
#include "mapping/optimisation/graph_relaxation.hpp"
#include "mapping/step_information.hpp"
#include "vo/planar_motion.hpp"

namespace roadbook {
namespace {

constexpr double kLeastJoinM = 0.2;  // odometry that an edit bends by more is contradicted
constexpr double kLeastJoinRad = 0.05;
constexpr double kAroundM = 8.0;  // of a place of kNotALoop
constexpr std::size_t kNamed = 3;

// Steps between successive keyframes. A map that a wrong loop has bent knows them by its wheels.
std::vector<RelativePose> steps_of(const Map& map, bool by_wheels) {
  std::vector<RelativePose> steps;
  for (std::size_t k = 1; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    if (keyframe.after_gap || keyframe.session != map.keyframes[k - 1].session) continue;
    const int to = static_cast<int>(k);
    if (by_wheels && keyframe.wheels) {
      Eigen::Isometry3d T = planar_transform(*keyframe.wheels);
      T.translation() *= map.sessions[at(keyframe.session)].wheel_scale;
      steps.push_back({to - 1, to, T, planar_information(*keyframe.wheels)});
      continue;
    }
    const Eigen::Isometry3d T = map.T_map_vehicle(to - 1).inverse() * map.T_map_vehicle(to);
    steps.push_back({to - 1, to, T, step_information(T)});
  }
  return steps;
}

bool contradicts(const std::vector<Eigen::Isometry3d>& poses, const RelativePose& edge) {
  return loop_misfit(poses[at(edge.from)], poses[at(edge.to)], edge.T_from_to, edge.information) >
         kMostLoopMisfit;
}

std::string name_of(const Map& map, const RelativePose& edge) {
  const auto place = [&](int k) {
    const Keyframe& keyframe = map.keyframes[at(k)];
    return map.sessions[at(keyframe.session)].name + "@" + std::to_string(keyframe.t_ns);
  };
  return place(edge.from) + " - " + place(edge.to);
}

// What the relaxed poses contradict and those of the map did not, named.
std::vector<std::string> contradicted(const Map& map,
                                      const std::vector<Eigen::Isometry3d>& before,
                                      const std::vector<Eigen::Isometry3d>& after,
                                      const std::vector<RelativePose>& steps,
                                      const std::vector<RelativePose>& loops) {
  std::vector<std::string> names;
  for (const RelativePose& loop : loops)
    if (contradicts(after, loop) && !contradicts(before, loop))
      names.push_back("loop " + name_of(map, loop));
  for (const RelativePose& step : steps) {
    const Vector6d e = motion_error(after[at(step.from)], after[at(step.to)], step.T_from_to, 1.0);
    if (e.head<3>().norm() > kLeastJoinM || e.tail<3>().norm() > kLeastJoinRad)
      names.push_back("odometry " + name_of(map, step));
  }
  return names;
}

// Places each piece that an edit joins to an earlier one as the edit says.
void place_pieces(const Map& map,
                  const std::vector<RelativePose>& motions,
                  std::vector<Eigen::Isometry3d>& poses) {
  std::vector<int> piece;
  for (const Keyframe& keyframe : map.keyframes) piece.push_back(keyframe.piece);
  for (const RelativePose& motion : motions) {
    const int stays = piece[at(motion.from)];
    const int moves = piece[at(motion.to)];
    if (stays == moves) continue;
    const Eigen::Isometry3d T =
        poses[at(motion.from)] * motion.T_from_to * poses[at(motion.to)].inverse();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (piece[k] != moves) continue;
      poses[k] = T * poses[k];
      piece[k] = stays;
    }
  }
}

}  // namespace

EditTerms terms_of_edits(const Map& map, const std::vector<MapEdit>& edits) {
  EditTerms terms;
  for (const MapEdit& edit : edits) {
    switch (edit.kind) {
      case EditKind::kLoop:
      case EditKind::kSamePoints:
        terms.motions.push_back(motion_of_edit(map, edit));
        break;
      case EditKind::kNotALoop: {
        const int a = keyframe_of_place(map, edit.a);
        const int b = keyframe_of_place(map, edit.b);
        terms.apart.emplace_back(std::min(a, b), std::max(a, b));
        break;
      }
      case EditKind::kAnchor: {
        PosePrior prior;
        prior.pose = keyframe_of_place(map, edit.a);
        // Height and tilt are those of the map.
        prior.T_map_vehicle = pose_from_planar(edit.motion.x(), edit.motion.y(), edit.motion.z());
        const Eigen::Isometry3d now = map.T_map_vehicle(prior.pose);
        const Eigen::Isometry3d flat =
            pose_from_planar(now.translation().x(), now.translation().y(), heading_of(now));
        prior.T_map_vehicle = prior.T_map_vehicle * (flat.inverse() * now);
        prior.information = information_of_sigmas(edit.sigma_m, edit.sigma_rad);
        terms.anchors.push_back(prior);
        break;
      }
    }
  }
  return terms;
}

bool are_apart(const Map& map, const EditTerms& terms, int from, int to) {
  const auto is_around = [&](int keyframe, int place) {
    const Keyframe& k = map.keyframes[at(keyframe)];
    const Keyframe& p = map.keyframes[at(place)];
    return k.session == p.session && std::abs(k.travelled_m - p.travelled_m) <= kAroundM;
  };
  return std::any_of(terms.apart.begin(), terms.apart.end(), [&](const auto& apart) {
    return (is_around(from, apart.first) && is_around(to, apart.second)) ||
           (is_around(from, apart.second) && is_around(to, apart.first));
  });
}

std::vector<Eigen::Isometry3d> relaxed_with_edits(const Map& map,
                                                  const std::vector<MapEdit>& edits,
                                                  const EditTerms& terms,
                                                  const PoseGraphOptions& options,
                                                  const Progress& progress) {
  std::vector<Eigen::Isometry3d> before;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    before.push_back(map.T_map_vehicle(static_cast<int>(k)));
  const std::vector<RelativePose> steps = steps_of(map, !terms.apart.empty());
  std::vector<RelativePose> loops;
  for (const LoopEdge& loop : map.loops)
    if (loop.accepted && !are_apart(map, terms, loop.from, loop.to))
      loops.push_back({loop.from, loop.to, loop.T_from_to, loop.information});
  PoseGraph graph;
  graph.T_map_vehicle = before;
  place_pieces(map, terms.motions, graph.T_map_vehicle);
  graph.odometry = steps;
  // No accepted loop and no edit may be switched off. `contradicted` finds those that the result
  // contradicts.
  graph.loops = loops;
  graph.loops.insert(graph.loops.end(), terms.motions.begin(), terms.motions.end());
  if (!terms.anchors.empty()) {
    graph.fixed = static_cast<int>(before.size());
    graph.T_map_vehicle.push_back(Eigen::Isometry3d::Identity());
    for (const PosePrior& anchor : terms.anchors)
      graph.loops.push_back({graph.fixed, anchor.pose, anchor.T_map_vehicle, anchor.information});
  }
  PoseGraphOptions known = options;
  known.robust = false;
  known.join_components = false;
  auto relaxed = relax(graph, known, progress);
  if (!relaxed.usable)
    throw Refused("error: pose graph with edits: got " + relaxed.message + ", want a solution");
  std::vector<Eigen::Isometry3d> after = std::move(relaxed.T_map_vehicle);
  after.resize(before.size());

  std::vector<std::string> names = contradicted(map, before, after, steps, loops);
  for (const RelativePose& motion : terms.motions)
    if (contradicts(after, motion)) names.push_back("edit " + name_of(map, motion));
  if (names.empty()) return after;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kNamed; ++i)
    text += (text.empty() ? "" : ", ") + names[i];
  if (names.size() > kNamed) text += " and " + std::to_string(names.size() - kNamed) + " more";
  throw Refused("error: edit " + text_of(edits.back()) + ": got a contradiction to " + text +
                ", want an edit that agrees with them (or not_a_loop for those that are wrong)");
}

}  // namespace roadbook
