#include "mapping/sessions/session_value.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/median.hpp"
#include "base/se3.hpp"
#include "mapping/inverse_information.hpp"
#include "mapping/joined_parts.hpp"
#include "mapping/landmark_information.hpp"
#include "mapping/optimisation/covariance.hpp"
#include "mapping/sessions/join_session.hpp"
#include "mapping/sessions/remove_session.hpp"
#include "mapping/sessions/stored_input.hpp"
#include "mapping/sessions/thinned_map.hpp"

namespace roadbook {
namespace {

constexpr int kSharedLandmarks = 10;  // of two images that say more than a loop between them
constexpr int kLeastOtherViews = 3;   // of a landmark, as of those that a build stores
constexpr double kBoundM = 10.0;      // standard deviations that bound those of all poses
constexpr double kBoundRad = 1.0;

// For each keyframe, its landmarks, ascending.
std::vector<std::vector<int>> landmarks_of_keyframes(const Map& map) {
  std::vector<std::vector<int>> seen(map.keyframes.size());
  for (const Observation& o : map.observations) seen[at(o.keyframe)].push_back(o.landmark);
  for (std::vector<int>& list : seen) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return seen;
}

// All terms of the map: observations, wheels and loops.
BundleProblem problem_of_map(const Map& map, const BundleStageOptions& options) {
  const StoredInput stored = stored_input(map);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    poses.push_back(map.T_map_vehicle(static_cast<int>(k)));
  std::vector<JoinedTrack> tracks = join_tracks(stored.input.odometry, stored.same);
  const std::vector<int> landmarks = landmarks_of_tracks(map, tracks);
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (landmarks[t] >= 0) tracks[t].p_map = map.p_map(map.landmarks[at(landmarks[t])]);
  BundleStage stage = make_bundle(stored.input, poses, tracks, options);
  BundleProblem& problem = stage.problem;
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    if (const int scale = stage.scale_of_session[s]; scale >= 0)
      problem.scales[at(scale)].value = map.sessions[s].wheel_scale;

  const auto seen = landmarks_of_keyframes(map);
  for (const LoopEdge& loop : map.loops) {
    if (!loop.accepted) continue;
    std::vector<int> shared;
    std::set_intersection(seen[at(loop.from)].begin(), seen[at(loop.from)].end(),
                          seen[at(loop.to)].begin(), seen[at(loop.to)].end(),
                          std::back_inserter(shared));
    if (static_cast<int>(shared.size()) < kSharedLandmarks)
      problem.motions.push_back({loop.from, loop.to, loop.T_from_to, loop.information});
  }
  Matrix6d bound = Matrix6d::Zero();
  bound.diagonal() << Eigen::Vector3d::Constant(1.0 / (kBoundM * kBoundM)),
      Eigen::Vector3d::Constant(1.0 / (kBoundRad * kBoundRad));
  for (std::size_t k = 0; k < poses.size(); ++k)
    problem.priors.push_back({static_cast<int>(k), poses[k], bound});
  return std::move(problem);
}

// Keyframes whose covariance is zero: the first of each piece that another session drove.
std::set<int> gauge_without(const Map& map, int session) {
  std::map<int, int> first;  // by piece
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    if (map.keyframes[k].session != session)
      first.try_emplace(map.keyframes[k].piece, static_cast<int>(k));
  std::set<int> gauge;
  for (const auto& [piece, k] : first) gauge.insert(k);
  return gauge;
}

// Empty if the terms leave none.
std::vector<Matrix6d> covariances(BundleProblem problem,
                                  const std::set<int>& gauge,
                                  const std::vector<std::uint8_t>& active,
                                  const BundleOptions& options) {
  for (const int k : gauge) problem.poses[at(k)].fixed = true;
  std::erase_if(problem.priors,
                [&](const PosePrior& prior) { return problem.poses[at(prior.pose)].fixed; });
  BundleCovariance covariance = bundle_covariance(problem, active, options);
  if (!covariance.usable) return {};
  return std::move(covariance.poses);
}

// The terms of `session` do not count, and its poses do not take part.
std::vector<Matrix6d> covariances_without(const Map& map,
                                          int session,
                                          BundleProblem problem,
                                          const std::set<int>& gauge,
                                          const BundleOptions& options) {
  const auto goes = [&](int k) { return map.keyframes[at(k)].session == session; };
  std::vector<std::uint8_t> active;
  for (const BundleObservation& o : problem.observations) active.push_back(goes(o.pose) ? 0 : 1);
  for (std::size_t k = 0; k < problem.poses.size(); ++k)
    if (goes(static_cast<int>(k))) problem.poses[k].fixed = true;
  std::erase_if(problem.motions, [&](const MotionConstraint& motion) {
    return goes(motion.from) || goes(motion.to);
  });
  for (BundlePoint& point : problem.points)
    if (point.ground_pose >= 0 && goes(point.ground_pose)) point.ground_pose = -1;
  return covariances(std::move(problem), gauge, active, options);
}

double sigma_of_point(const Matrix6d& covariance, const Eigen::Vector3d& p_vehicle) {
  Eigen::Matrix<double, 3, 6> J;  // by the right perturbation, in the axes of the vehicle
  J << Eigen::Matrix3d::Identity(), -skew(p_vehicle);
  return std::sqrt((J * covariance * J.transpose()).trace());
}

// Means of standard deviations over points of other sessions.
SigmaChange change_of(const Map& map,
                      int session,
                      const std::vector<AnchoredPoint>& points,
                      const std::vector<Matrix6d>& with,
                      const std::vector<Matrix6d>& without) {
  SigmaChange change;
  if (with.empty() || without.empty()) return change;
  for (const AnchoredPoint& point : points) {
    if (map.keyframes[at(point.keyframe)].session == session) continue;
    ++change.count;
    change.with_m += sigma_of_point(with[at(point.keyframe)], point.p_vehicle);
    change.without_m += sigma_of_point(without[at(point.keyframe)], point.p_vehicle);
  }
  if (change.count == 0) return change;
  change.with_m /= static_cast<double>(change.count);
  change.without_m /= static_cast<double>(change.count);
  return change;
}

// Information of landmarks given the poses, by the session whose observations give it.
class LandmarkShares {
 public:
  explicit LandmarkShares(const Map& map)
      : sessions_(map.sessions.size()), of_session_(map.landmarks.size() * sessions_) {
    for (const Observation& o : map.observations) {
      const auto terms = terms_of(map, o);
      if (!terms) continue;
      Share& share =
          of_session_[at(o.landmark) * sessions_ + at(map.keyframes[at(o.keyframe)].session)];
      share.information.noalias() += terms->J_point.transpose() * terms->J_point;
      ++share.views;
    }
  }
  [[nodiscard]] SigmaChange change_of(int session) const {
    std::vector<double> with;
    std::vector<double> without;
    for (std::size_t l = 0; l * sessions_ < of_session_.size(); ++l) {
      Share all;
      for (std::size_t s = 0; s < sessions_; ++s) {
        all.information += of_session_[l * sessions_ + s].information;
        all.views += of_session_[l * sessions_ + s].views;
      }
      const Share& own = of_session_[l * sessions_ + at(session)];
      if (all.views - own.views < kLeastOtherViews) continue;
      const Eigen::Matrix3d now = covariance_of_information(all.information);
      const Eigen::Matrix3d then =
          covariance_of_information(Eigen::Matrix3d(all.information - own.information));
      if (!is_known(now) || !is_known(then)) continue;
      with.push_back(std::sqrt(now.trace()));
      without.push_back(std::sqrt(then.trace()));
    }
    if (with.empty()) return {};
    return {with.size(), median(with), median(without)};
  }

 private:
  struct Share {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    int views = 0;
  };
  std::size_t sessions_;
  std::vector<Share> of_session_;  // landmark by landmark
};

// Each observation counts as `step` observations. The weights of the robust loss stay.
BundleStageOptions options_of_thinned(BundleStageOptions options, int step) {
  const double root = std::sqrt(static_cast<double>(step));
  options.feature_sigma_px /= root;
  options.bundle.loss_width *= root;
  options.reach_keyframes = std::max(1, options.reach_keyframes / step);
  options.passes_together = 0;  // no session may be the only tie of others
  return options;
}

}  // namespace

void SessionValueOptions::check() const {
  if (most_keyframes < 2)
    throw InvalidOption("most_keyframes", std::to_string(most_keyframes), ">= 2");
}

std::vector<SessionValue> session_values(const Map& whole,
                                         const std::vector<AnchoredPoint>& points,
                                         const SessionValueOptions& options) {
  options.check();
  std::vector<SessionValue> values;
  if (whole.sessions.size() < 2) return values;
  const std::size_t step =
      (whole.keyframes.size() + options.most_keyframes - 1) / options.most_keyframes;
  const ThinnedMap thinned = thinned_map(whole, step);
  const Map& map = thinned.map;
  const BundleStageOptions stage = options_of_thinned(options.bundle, static_cast<int>(step));
  const BundleProblem problem = problem_of_map(map, stage);
  const LandmarkShares landmarks(whole);
  std::vector<AnchoredPoint> poses;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    poses.push_back({static_cast<int>(k), Eigen::Vector3d::Zero()});
  std::vector<AnchoredPoint> anchored;
  for (const AnchoredPoint& point : points) {
    const int now = thinned.now[at(point.keyframe)];
    anchored.push_back({now, map.T_map_vehicle(now).inverse() *
                                 whole.T_map_vehicle(point.keyframe) * point.p_vehicle});
  }
  std::map<std::set<int>, std::vector<Matrix6d>> with;  // by gauge: most sessions share it
  for (int s = 0; s < static_cast<int>(map.sessions.size()); ++s) {
    const std::set<int> gauge = gauge_without(map, s);
    auto known = with.find(gauge);
    if (known == with.end())
      known = with.emplace(gauge, covariances(problem, gauge, {}, stage.bundle)).first;
    const auto without = covariances_without(map, s, problem, gauge, stage.bundle);
    SessionValue value;
    value.session = s;
    value.poses = change_of(map, s, poses, known->second, without);
    value.points = change_of(map, s, anchored, known->second, without);
    value.landmarks = landmarks.change_of(s);
    const RemovedSession removed = without_session(whole, s);
    value.pieces_more = removed.pieces - removed.pieces_before;
    values.push_back(value);
  }
  return values;
}

}  // namespace roadbook
