#include "mapping/checks/join_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/format.hpp"
#include "base/index.hpp"
#include "mapping/checks/finding.hpp"
#include "mapping/joined_parts.hpp"
#include "mapping/loops/loop_misfit.hpp"

namespace roadbook {
namespace {

constexpr double kLeastStepM = 0.1;  // of a motion whose length says something
constexpr std::size_t kLeastSteps = 10;
constexpr double kWheelSlack = 0.015;  // of the scale: slip and curves

void find_wrong_pieces(const Map& map, std::vector<Problem>& problems) {
  const std::vector<int> parts = joined_parts(map);
  std::map<int, std::set<int>> pieces_of_part;
  std::map<int, std::set<int>> parts_of_piece;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    pieces_of_part[parts[k]].insert(map.keyframes[k].piece);
    parts_of_piece[map.keyframes[k].piece].insert(parts[k]);
  }
  const auto sessions_in = [&](auto&& is_in) {
    std::set<int> found;
    for (std::size_t k = 0; k < parts.size(); ++k)
      if (is_in(k)) found.insert(map.keyframes[k].session);
    std::string names;
    for (const int s : found) names += (names.empty() ? "" : ", ") + map.sessions[at(s)].name;
    return names;
  };
  for (const auto& [part, pieces] : pieces_of_part)
    if (pieces.size() > 1)
      problems.push_back(
          finding("sessions " + sessions_in([&, p = part](std::size_t k) { return parts[k] == p; }),
                  std::to_string(pieces.size()) + " pieces of the map",
                  "one piece: odometry, loops or landmarks join these poses"));
  for (const auto& [piece, of_piece] : parts_of_piece)
    if (of_piece.size() > 1)
      problems.push_back(finding(
          "piece " + std::to_string(piece) + " of sessions " +
              sessions_in([&, p = piece](std::size_t k) { return map.keyframes[k].piece == p; }),
          std::to_string(of_piece.size()) + " parts that nothing joins",
          "poses joined by odometry, loops or landmarks"));
}

void find_wrong_loops(const Map& map, std::vector<Problem>& problems) {
  std::vector<int> wrong;
  double worst_m = 0.0;
  for (std::size_t i = 0; i < map.loops.size(); ++i) {
    const LoopEdge& loop = map.loops[i];
    if (!loop.accepted || map.keyframes[at(loop.from)].piece != map.keyframes[at(loop.to)].piece)
      continue;
    const Eigen::Isometry3d T_map_from = map.T_map_vehicle(loop.from);
    const Eigen::Isometry3d T_map_to = map.T_map_vehicle(loop.to);
    if (loop_misfit(T_map_from, T_map_to, loop.T_from_to, loop.information) <= kMostLoopMisfit)
      continue;
    wrong.push_back(static_cast<int>(i));
    worst_m = std::max(worst_m,
                       ((T_map_from * loop.T_from_to).inverse() * T_map_to).translation().norm());
  }
  if (!wrong.empty())
    problems.push_back(
        finding("loops " + first_of(wrong),
                "accepted, but up to " + fixed(worst_m, 2) + " m from what the poses say",
                "loops that agree with the poses"));
}

void find_wrong_wheels(const Map& map, std::vector<Problem>& problems) {
  std::vector<std::vector<double>> ratios(map.sessions.size());
  for (std::size_t k = 1; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    if (!keyframe.wheels || keyframe.session != map.keyframes[k - 1].session) continue;
    const double measured = keyframe.wheels->motion.head<2>().norm();
    if (measured < kLeastStepM) continue;
    const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(k) - 1).inverse() *
                                map.T_map_vehicle(static_cast<int>(k));
    ratios[at(keyframe.session)].push_back(T.translation().norm() / measured);
  }
  for (std::size_t s = 0; s < ratios.size(); ++s) {
    std::vector<double>& list = ratios[s];
    if (list.size() < kLeastSteps) continue;
    std::sort(list.begin(), list.end());
    const double scale = list[list.size() / 2];
    const double spread = 0.74 * (list[list.size() * 3 / 4] - list[list.size() / 4]);
    const double sigma = 1.25 * spread / std::sqrt(static_cast<double>(list.size()));
    const double stored = map.sessions[s].wheel_scale;
    if (std::abs(scale / stored - 1.0) <= kWheelSlack + 5.0 * sigma) continue;
    problems.push_back(finding(
        "wheels of session " + map.sessions[s].name,
        "a factor of " + fixed(stored, 4) + " on their distances",
        fixed(scale, 4) + " +- " + fixed(sigma, 4) + ", as the poses of the session have it"));
  }
}

void find_strange_frames(const Map& map, std::vector<Problem>& problems) {
  std::vector<std::set<int>> pieces(map.map_frames.size());
  for (const Keyframe& keyframe : map.keyframes)
    pieces[at(keyframe.map_frame)].insert(keyframe.piece);
  std::vector<int> split;
  for (std::size_t f = 0; f < pieces.size(); ++f)
    if (pieces[f].size() > 1) split.push_back(static_cast<int>(f));
  if (!split.empty())
    problems.push_back(finding("map frames " + first_of(split), "poses of several pieces",
                               "poses of one piece: nothing holds the frame otherwise"));
}

}  // namespace

std::vector<Problem> join_problems(const Map& map) {
  std::vector<Problem> problems;
  find_wrong_pieces(map, problems);
  find_strange_frames(map, problems);
  find_wrong_loops(map, problems);
  find_wrong_wheels(map, problems);
  return problems;
}

}  // namespace roadbook
