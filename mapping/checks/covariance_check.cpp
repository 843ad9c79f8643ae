#include "mapping/checks/covariance_check.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "base/se3.hpp"
#include "mapping/checks/finding.hpp"
#include "vo/planar_motion.hpp"

namespace roadbook {
namespace {

// Of the variance that independent errors leave if all other poses are known. A sound map has more:
// its poses are not known, and its covariances count common errors.
constexpr double kLeastShare = 0.5;
// Of landmarks, whose covariance is given the poses, the median of the map says what is usual.
constexpr double kLeastOfMedian = 0.05;

// What an observation says of the pose (right perturbation) and the landmark (map axes).
struct Terms {
  Eigen::Matrix<double, 2, 6> J_pose;
  Matrix23d J_point;
};

std::optional<Terms> terms_of(const Map& map, const Observation& o) {
  const Keyframe& keyframe = map.keyframes[at(o.keyframe)];
  const MountedCamera& mounted = map.sessions[at(keyframe.session)].rig.cameras[at(o.camera)];
  const Eigen::Isometry3d T_vehicle_map = map.T_map_vehicle(o.keyframe).inverse();
  const Eigen::Vector3d p_vehicle = T_vehicle_map * map.p_map(map.landmarks[at(o.landmark)]);
  const Eigen::Isometry3d T_camera_vehicle = mounted.T_vehicle_camera.inverse();
  Matrix23d J;
  if (!mounted.camera.project(T_camera_vehicle * p_vehicle, &J) || !J.allFinite())
    return std::nullopt;
  J /= static_cast<double>(o.sigma_px);
  const Matrix23d J_vehicle = J * T_camera_vehicle.linear();
  Terms terms;
  terms.J_point = J_vehicle * T_vehicle_map.linear();
  terms.J_pose.leftCols<3>() = -J_vehicle;
  terms.J_pose.rightCols<3>() = J_vehicle * skew(p_vehicle);
  return terms;
}

// Information of each landmark given the poses, if observations are independent.
std::vector<Eigen::Matrix3d> information_of_landmarks(const Map& map) {
  std::vector<Eigen::Matrix3d> information(map.landmarks.size(), Eigen::Matrix3d::Zero());
  for (const Observation& o : map.observations)
    if (const auto terms = terms_of(map, o))
      information[at(o.landmark)].noalias() += terms->J_point.transpose() * terms->J_point;
  return information;
}

// Inverse; unknown where there is none.
template <int N>
Eigen::Matrix<double, N, N> covariance_of(const Eigen::Matrix<double, N, N>& information) {
  Eigen::FullPivLU<Eigen::Matrix<double, N, N>> lu(information);
  lu.setThreshold(1e-12);
  if (!lu.isInvertible()) return unknown_covariance<Eigen::Matrix<double, N, N>>();
  return lu.inverse();
}

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
    const Eigen::Matrix3d V = covariance_of<3>(of_landmark[at(key.second)]);
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
  for (const Matrix6d& one : information) covariance.push_back(covariance_of<6>(one));
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
    const Eigen::Matrix3d least = covariance_of<3>(information[l]);
    if (!is_known(map.landmarks[l].covariance) || !is_known(least)) continue;
    ratios.push_back(map.landmarks[l].covariance.trace() / least.trace());
    judged.push_back(static_cast<int>(l));
  }
  if (ratios.empty()) return;
  std::vector<double> sorted = ratios;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[sorted.size() / 2];
  std::vector<int> too_small;
  for (std::size_t i = 0; i < ratios.size(); ++i)
    if (ratios[i] <= 0.0 || ratios[i] < kLeastOfMedian * std::max(1.0, median))
      too_small.push_back(judged[i]);
  if (!too_small.empty())
    problems.push_back(finding("covariances of landmarks",
                               std::to_string(too_small.size()) + " (" + first_of(too_small) +
                                   ") far smaller than their observations give",
                               "covariances that follow from the observations"));
}

}  // namespace

std::vector<Problem> covariance_problems(const Map& map) {
  std::vector<Problem> problems;
  const auto of_landmark = information_of_landmarks(map);
  find_pose_covariances(map, least_of_poses(map, of_landmark), problems);
  find_landmark_covariances(map, of_landmark, problems);
  return problems;
}

}  // namespace roadbook
