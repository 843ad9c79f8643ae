#include "mapping/localisation/relocaliser.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/localisation/spread_ransac.hpp"

namespace roadbook {
namespace {

std::vector<int> used_landmarks(const LandmarkIndex& index) {
  std::vector<int> used;
  for (std::size_t l = 0; l < index.landmarks().size(); ++l)
    if (index.landmarks()[l].used) used.push_back(static_cast<int>(l));
  return used;
}

std::vector<Descriptor> descriptors_of(const LandmarkIndex& index,
                                       const std::vector<int>& landmarks) {
  std::vector<Descriptor> descriptors;
  for (const int l : landmarks) descriptors.push_back(index.map().landmarks[at(l)].descriptor);
  return descriptors;
}

// Matches of one camera's corners with landmarks by descriptor; one corner a landmark.
void match_camera(const Features& features,
                  int camera,
                  const LandmarkIndex& index,
                  const std::vector<int>& landmarks,
                  const std::vector<Descriptor>& descriptors,
                  const RelocaliseOptions& options,
                  std::vector<RigObservation>& matches) {
  struct Owner {
    int feature = -1;
    int distance = 513;
  };
  std::vector<Owner> owners(landmarks.size());
  for (std::size_t f = 0; f < features.size(); ++f) {
    const auto near = nearest_descriptor(features.descriptors[f], descriptors);
    if (near.index < 0 || near.distance > options.max_hamming ||
        near.distance >= options.max_ratio * near.second)
      continue;
    Owner& owner = owners[at(near.index)];
    if (near.distance < owner.distance) owner = {static_cast<int>(f), near.distance};
  }
  for (std::size_t i = 0; i < owners.size(); ++i)
    if (owners[i].feature >= 0)
      matches.push_back({camera, features.pixels[at(owners[i].feature)].cast<double>(),
                         index.landmarks()[at(landmarks[i])].p_map});
}

}  // namespace

void RelocaliseOptions::check() const {
  descriptors.check();
  if (places < 1) throw InvalidOption("places", std::to_string(places), ">= 1");
  if (min_inliers < 6) throw InvalidOption("min_inliers", std::to_string(min_inliers), ">= 6");
}

Relocaliser::Relocaliser(const LandmarkIndex& index, const RelocaliseOptions& options)
    : index_(index),
      options_(options),
      searched_(used_landmarks(index)),
      search_(descriptors_of(index, searched_), options.descriptors) {
  options.check();
}

// Keyframes of the map with the most votes, best first, apart from each other.
std::vector<int> Relocaliser::voted(const FrameCorners& corners) const {
  std::vector<Descriptor> queries;
  for (const Features& features : corners.features())
    queries.insert(queries.end(), features.descriptors.begin(), features.descriptors.end());
  const auto near = search_.nearest(queries, options_.neighbours, options_.vote_hamming);
  const Map& map = index_.map();
  std::vector<double> votes(map.keyframes.size(), 0.0);
  for (const auto& list : near)
    for (const NearDescriptor& one : list)
      for (const int k : index_.viewers(searched_[at(one.index)]))
        votes[at(k)] += 1.0 / static_cast<double>(list.size());
  std::vector<int> order;
  for (std::size_t k = 0; k < votes.size(); ++k)
    if (votes[k] > 0.0) order.push_back(static_cast<int>(k));
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return votes[at(a)] != votes[at(b)] ? votes[at(a)] > votes[at(b)] : a < b;
  });
  std::vector<int> places;
  for (const int k : order) {
    if (votes[at(k)] < options_.vote_share * votes[at(order.front())]) break;
    const Eigen::Vector3d p = map.T_map_vehicle(k).translation();
    const bool is_taken = std::any_of(places.begin(), places.end(), [&](int other) {
      return (map.T_map_vehicle(other).translation() - p).norm() < options_.apart_m;
    });
    if (!is_taken) places.push_back(k);
    if (places.size() == options_.places) break;
  }
  return places;
}

std::optional<PlaceFound> Relocaliser::verify(const Rig& half_rig,
                                              const FrameCorners& corners,
                                              int keyframe,
                                              const FrameFixOptions& fix_options) const {
  const Eigen::Isometry3d T_place = index_.map().T_map_vehicle(keyframe);
  std::vector<int> landmarks;
  for (const int k : index_.keyframes_near(T_place.translation(), options_.apart_m))
    landmarks.insert(landmarks.end(), index_.seen_from(k).begin(), index_.seen_from(k).end());
  std::sort(landmarks.begin(), landmarks.end());
  landmarks.erase(std::unique(landmarks.begin(), landmarks.end()), landmarks.end());
  const auto descriptors = descriptors_of(index_, landmarks);
  std::vector<RigObservation> matches;
  for (std::size_t c = 0; c < corners.features().size(); ++c)
    match_camera(corners.features()[c], static_cast<int>(c), index_, landmarks, descriptors,
                 options_, matches);
  if (matches.size() < 8) return std::nullopt;
  SpreadRansacOptions ransac;
  ransac.inlier_rad = options_.inlier_rad;
  ransac.iterations = options_.ransac_iterations;
  ransac.seed = options_.seed;
  const auto first = find_spread_rig_pose(half_rig, matches, ransac);
  if (!first) return std::nullopt;
  const auto refined = refine_rig_pose(half_rig, matches, *first, std::nullopt);
  PredictedPose guess;
  guess.T_map_vehicle = refined ? refined->T_world_vehicle : *first;
  const int nearest = index_.nearest_keyframe(guess.T_map_vehicle.translation());
  if (nearest < 0) return std::nullopt;
  const Eigen::Isometry3d T_near_guess =
      index_.map().T_map_vehicle(nearest).inverse() * guess.T_map_vehicle;
  if (std::abs(T_near_guess.translation().z()) > options_.max_height_m ||
      T_near_guess.linear()(2, 2) < std::cos(options_.max_tilt_rad))
    return std::nullopt;
  constexpr double kFirstM = 0.1;
  constexpr double kFirstRad = 0.01;
  guess.covariance.diagonal() << Eigen::Vector3d::Constant(kFirstM * kFirstM),
      Eigen::Vector3d::Constant(kFirstRad * kFirstRad);
  FrameFixOptions alone = fix_options;
  alone.use_prior = false;
  auto fix = fix_frame(half_rig, corners, index_, guess, alone);
  if (!fix || fix->inliers() < options_.min_inliers || !has_enough(*fix, half_rig, alone))
    return std::nullopt;
  PlaceFound found{std::move(*fix), keyframe};
  found.share = found.fix.inliers() / static_cast<double>(matches.size());
  if (found.share < options_.min_share) return std::nullopt;
  return found;
}

std::optional<PlaceFound> Relocaliser::find(const Rig& half_rig,
                                            const FrameCorners& corners,
                                            const FrameFixOptions& fix_options) const {
  std::vector<PlaceFound> all;
  for (const int keyframe : voted(corners)) {
    // Around a place that was found, others give the same pose.
    const Eigen::Vector3d p = index_.map().T_map_vehicle(keyframe).translation();
    const bool is_found = std::any_of(all.begin(), all.end(), [&](const PlaceFound& one) {
      const Eigen::Vector3d off = one.fix.T_map_vehicle.translation() - p;
      return off.head<2>().norm() < options_.same_place_m &&
             std::abs(off.z()) < options_.max_height_m;  // another storey is another place
    });
    if (is_found) continue;
    if (auto found = verify(half_rig, corners, keyframe, fix_options))
      all.push_back(std::move(*found));
  }
  if (all.empty()) return std::nullopt;
  std::stable_sort(all.begin(), all.end(), [](const PlaceFound& a, const PlaceFound& b) {
    return a.fix.inliers() > b.fix.inliers();
  });
  for (std::size_t i = 1; i < all.size(); ++i) {
    const double apart =
        (all[i].fix.T_map_vehicle.translation() - all.front().fix.T_map_vehicle.translation())
            .norm();
    if (apart > 1.0 && all[i].fix.inliers() > options_.ambiguous_share * all.front().fix.inliers())
      all.front().ambiguous = true;
  }
  return std::move(all.front());
}

std::optional<PlaceFound> Relocaliser::find_near(const Rig& half_rig,
                                                 const FrameCorners& corners,
                                                 const Eigen::Vector3d& p_map,
                                                 const FrameFixOptions& fix_options) const {
  const int keyframe = index_.nearest_keyframe(p_map);
  if (keyframe < 0) return std::nullopt;
  return verify(half_rig, corners, keyframe, fix_options);
}

}  // namespace roadbook
