#include "mapping/localisation/register_drive.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/index.hpp"
#include "base/random.hpp"
#include "mapping/localisation/landmark_matches.hpp"

namespace roadbook {
namespace {

/// The same thing in both maps.
struct Pair {
  Eigen::Vector3d own = Eigen::Vector3d::Zero();
  Eigen::Vector3d frozen = Eigen::Vector3d::Zero();
};

std::vector<Pair> pairs_of(const Map& frozen, const Map& own, const FrozenMapOptions& options) {
  std::vector<Pair> pairs;
  const std::size_t step = std::max<std::size_t>(1, own.landmarks.size() / options.queries);
  for (std::size_t i = 0; i < own.landmarks.size(); i += step) {
    int least = 513;
    int second = 513;
    std::size_t best = 0;
    for (std::size_t j = 0; j < frozen.landmarks.size(); ++j) {
      const int d = hamming(own.landmarks[i].descriptor, frozen.landmarks[j].descriptor);
      if (d < least) {
        second = least;
        least = d;
        best = j;
      } else {
        second = std::min(second, d);
      }
    }
    if (least <= options.max_hamming && least <= options.max_ratio * second)
      pairs.push_back({own.p_map(own.landmarks[i]), frozen.p_map(frozen.landmarks[best])});
  }
  return pairs;
}

// Rigid motion that brings own places to the frozen ones, least squares (Kabsch).
Eigen::Isometry3d rigid(const std::vector<Pair>& pairs, const std::vector<double>& weights) {
  double sum = 0.0;
  Pair middle;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    sum += weights[i];
    middle.own += weights[i] * pairs[i].own;
    middle.frozen += weights[i] * pairs[i].frozen;
  }
  middle.own /= sum;
  middle.frozen /= sum;
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < pairs.size(); ++i)
    H += weights[i] * (pairs[i].frozen - middle.frozen) * (pairs[i].own - middle.own).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1.0, 1.0, (svd.matrixU() * svd.matrixV()).determinant() < 0.0 ? -1.0 : 1.0);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  T.translation() = middle.frozen - T.linear() * middle.own;
  return T;
}

std::vector<Pair> within(const std::vector<Pair>& pairs, const Eigen::Isometry3d& T, double far_m) {
  std::vector<Pair> some;
  for (const Pair& p : pairs)
    if ((T * p.own - p.frozen).norm() < far_m) some.push_back(p);
  return some;
}

// Upright, by two pairs; nothing where they contradict each other.
std::optional<Eigen::Isometry3d> guess(const Pair& a, const Pair& b, double near_m) {
  constexpr double kBaseline = 3.0;  // [m]
  const Eigen::Vector3d own = b.own - a.own;
  const Eigen::Vector3d frozen = b.frozen - a.frozen;
  if (own.head<2>().norm() < kBaseline || std::abs(own.norm() - frozen.norm()) > near_m ||
      std::abs(own.z() - frozen.z()) > near_m)
    return std::nullopt;
  const double yaw = std::atan2(frozen.y(), frozen.x()) - std::atan2(own.y(), own.x());
  Eigen::Isometry3d T(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  T.translation() = 0.5 * (a.frozen + b.frozen) - T.linear() * (0.5 * (a.own + b.own));
  return T;
}

// Frozen map and drive side by side.
LocalisedDrive beside(const Map& frozen, const Map& own, const Eigen::Isometry3d& T_frozen_own) {
  LocalisedDrive all{frozen, static_cast<int>(frozen.sessions.size())};
  Map& map = all.map;
  const int frames = static_cast<int>(map.map_frames.size());
  const int keyframes = static_cast<int>(map.keyframes.size());
  const int landmarks = static_cast<int>(map.landmarks.size());
  map.sessions.insert(map.sessions.end(), own.sessions.begin(), own.sessions.end());
  for (const MapFrame& frame : own.map_frames)
    map.map_frames.push_back({T_frozen_own * frame.T_map_frame});
  for (Keyframe keyframe : own.keyframes) {
    keyframe.session += all.session;
    keyframe.map_frame += frames;
    map.keyframes.push_back(keyframe);
  }
  for (Landmark landmark : own.landmarks) {
    landmark.map_frame += frames;
    map.landmarks.push_back(landmark);
  }
  for (Observation o : own.observations) {
    o.landmark += landmarks;
    o.keyframe += keyframes;
    map.observations.push_back(o);
  }
  return all;
}

// Of the pairs about a place how the drive lies there; outliers count little (Huber).
std::optional<Eigen::Isometry3d> local(const std::vector<Pair>& pairs, std::size_t fewest) {
  if (pairs.size() < fewest) return std::nullopt;
  constexpr double kHuber = 0.1;  // [m]
  std::vector<double> weights(pairs.size(), 1.0);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int round = 0; round < 4; ++round) {
    for (std::size_t i = 0; i < pairs.size(); ++i)
      weights[i] = 1.0 / std::max(1.0, (T * pairs[i].own - pairs[i].frozen).norm() / kHuber);
    T = rigid(pairs, weights);
  }
  return T;
}

void move_poses(const std::vector<Pair>& pairs,
                const FrozenMapOptions& options,
                LocalisedDrive& all) {
  std::vector<Eigen::Isometry3d> moves(all.map.map_frames.size(), Eigen::Isometry3d::Identity());
  for (std::size_t k = 0; k < all.map.keyframes.size(); ++k) {
    const Keyframe& keyframe = all.map.keyframes[k];
    if (keyframe.session != all.session) continue;
    const Eigen::Vector3d place = all.map.T_map_vehicle(static_cast<int>(k)).translation();
    std::vector<Pair> near;
    for (const Pair& p : pairs)
      if ((p.own - place).norm() < options.local_m) near.push_back(p);
    if (const auto T = local(near, options.fewest)) moves[at(keyframe.map_frame)] = *T;
  }
  for (std::size_t f = 0; f < moves.size(); ++f)
    all.map.map_frames[f].T_map_frame = moves[f] * all.map.map_frames[f].T_map_frame;
}

// Where the drive's map lies as a whole: both stand upright, so two pairs make a guess (RANSAC);
// then all that agree.
std::optional<Eigen::Isometry3d> registered(const std::vector<Pair>& pairs,
                                            const FrozenMapOptions& options) {
  if (pairs.size() < options.fewest) return std::nullopt;
  Random random(1, "register map");
  constexpr int kDraws = 3000;
  std::size_t most = 0;
  Eigen::Isometry3d best = Eigen::Isometry3d::Identity();
  for (int draw = 0; draw < kDraws; ++draw) {
    const Pair& a = pairs[random.below(pairs.size())];
    const Pair& b = pairs[random.below(pairs.size())];
    const auto T = guess(a, b, options.near_m);
    if (!T) continue;
    const std::size_t agree = within(pairs, *T, options.near_m).size();
    if (agree <= most) continue;
    most = agree;
    best = *T;
  }
  for (int round = 0; round < 3 && most >= options.fewest; ++round) {
    const std::vector<Pair> agreeing = within(pairs, best, options.near_m);
    most = agreeing.size();
    best = rigid(agreeing, std::vector<double>(agreeing.size(), 1.0));
  }
  return most >= options.fewest ? std::optional(best) : std::nullopt;
}

}  // namespace

std::optional<LocalisedDrive> localise_in(const Map& frozen,
                                          const Map& own,
                                          const FrozenMapOptions& options) {
  std::vector<Pair> pairs = pairs_of(frozen, own, options);
  const auto T_frozen_own = registered(pairs, options);
  if (!T_frozen_own) return std::nullopt;
  LocalisedDrive all = beside(frozen, own, *T_frozen_own);
  // A map that is scaled or bent is off by more far from its middle.
  pairs = within(pairs, *T_frozen_own, options.far_m);
  for (Pair& p : pairs) p.own = *T_frozen_own * p.own;
  move_poses(pairs, options, all);
  LandmarkTwinOptions search;
  search.aligned = false;
  for (int round = 0; round < options.rounds; ++round) {
    pairs.clear();
    for (const LandmarkTwin& twin : landmark_twins(all.map, all.session, search))
      pairs.push_back({twin.then + twin.shift, twin.then});
    move_poses(pairs, options, all);
  }
  return all;
}

}  // namespace roadbook
