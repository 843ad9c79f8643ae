#include "mapping/checks/covariance_check.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "base/median.hpp"
#include "base/se3.hpp"
#include "mapping/checks/finding.hpp"
#include "mapping/inverse_information.hpp"
#include "mapping/landmark_information.hpp"
#include "vo/planar_motion.hpp"

namespace roadbook {
namespace {

// Of the variance that independent errors leave if all other poses are known. A sound map has more:
// its poses are not known, and its covariances count common errors.
constexpr double kLeastShare = 0.5;
// Of landmarks, whose covariance is given the poses, the median of the map gives the usual factor.
constexpr double kLeastOfMedian = 0.05;

// Covariance of each pose if all other poses were known: a block of the diagonal of the reduced
// system (Schur complement), with the wheels' motions from and to the neighbours. The marginal
// covariance is larger.
std::vector<Matrix6d> least_of_poses(const Map& map,
                                     const std::vector<Eigen::Matrix3d>& of_landmark) {
  std::vector<Matrix6d> information(map.keyframes.size(), Matrix6d::Zero());
  std::map<std::pair<int, int>, Eigen::Matrix<double, 6, 3>> coupling;  // keyframe, landmark
  for (const Observation& o : map.observations)
    if (const auto terms = terms_of(map, o)) {
      information[at(o.keyframe)].noalias() += terms->J_pose.transpose() * terms->J_pose;
      auto& W = coupling.try_emplace({o.keyframe, o.landmark}, Eigen::Matrix<double, 6, 3>::Zero())
                    .first->second;
      W.noalias() += terms->J_pose.transpose() * terms->J_point;
    }
  for (const auto& [key, W] : coupling) {
    const Eigen::Matrix3d V = covariance_of_information(of_landmark[at(key.second)]);
    if (is_known(V)) information[at(key.first)].noalias() -= W * V * W.transpose();
  }
  for (std::size_t k = 1; k < map.keyframes.size(); ++k) {
    if (!map.keyframes[k].wheels || map.keyframes[k].session != map.keyframes[k - 1].session)
      continue;
    const Matrix6d wheels = planar_information(*map.keyframes[k].wheels);
    const Matrix6d A = se3_adjoint(planar_transform(*map.keyframes[k].wheels).inverse());
    information[k] += wheels;
    information[k - 1] += A.transpose() * wheels * A;
  }
  std::vector<Matrix6d> covariance;
  for (const Matrix6d& one : information) covariance.push_back(covariance_of_information(one));
  return covariance;
}

// The first pose of each piece is the gauge: its covariance is zero.
std::set<std::size_t> gauge_of_pieces(const Map& map) {
  std::map<int, std::size_t> first;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    first.try_emplace(map.keyframes[k].piece, k);
  std::set<std::size_t> gauge;
  for (const auto& [piece, k] : first) gauge.insert(k);
  return gauge;
}

void find_pose_covariances(const Map& map,
                           const std::vector<Matrix6d>& least,
                           std::vector<Problem>& problems) {
  const std::set<std::size_t> gauge = gauge_of_pieces(map);
  std::map<int, std::vector<int>> too_small;  // by session
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Matrix6d& covariance = map.keyframes[k].covariance;
    if (gauge.contains(k) || !is_known(covariance)) continue;
    const double stored = covariance.topLeftCorner<3, 3>().trace();
    const double smallest =
        is_known(least[k]) ? kLeastShare * least[k].topLeftCorner<3, 3>().trace() : 0.0;
    if (stored <= 0.0 || stored < smallest)
      too_small[map.keyframes[k].session].push_back(static_cast<int>(k));
  }
  for (const auto& [session, keyframes] : too_small)
    problems.push_back(finding("covariances of poses of session " + map.sessions[at(session)].name,
                               std::to_string(keyframes.size()) + " keyframes (" +
                                   first_of(keyframes) +
                                   ") with less than their observations can give",
                               "at least those of independent observations"));
}

void find_landmark_covariances(const Map& map,
                               const std::vector<Eigen::Matrix3d>& information,
                               std::vector<Problem>& problems) {
  std::vector<double> ratios;
  std::vector<int> judged;
  for (std::size_t l = 0; l < map.landmarks.size(); ++l) {
    const Eigen::Matrix3d least = covariance_of_information(information[l]);
    if (!is_known(map.landmarks[l].covariance) || !is_known(least)) continue;
    ratios.push_back(map.landmarks[l].covariance.trace() / least.trace());
    judged.push_back(static_cast<int>(l));
  }
  if (ratios.empty()) return;
  const double usual = std::max(1.0, median(ratios));
  std::vector<int> too_small;
  for (std::size_t i = 0; i < ratios.size(); ++i)
    if (ratios[i] <= 0.0 || ratios[i] < kLeastOfMedian * usual) too_small.push_back(judged[i]);
  if (!too_small.empty())
    problems.push_back(finding("covariances of landmarks",
                               std::to_string(too_small.size()) + " (" + first_of(too_small) +
                                   ") far smaller than their observations give",
                               "covariances that follow from the observations"));
}

}  // namespace

std::vector<Problem> covariance_problems(const Map& map) {
  std::vector<Problem> problems;
  const auto of_landmark = landmark_information(map);
  find_pose_covariances(map, least_of_poses(map, of_landmark), problems);
  find_landmark_covariances(map, of_landmark, problems);
  return problems;
}

}  // namespace roadbook
