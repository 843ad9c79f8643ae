#pragma once

#include <vector>

#include "mapping/map.hpp"
#include "tests/diagnosis/hidden_views/view_injector.hpp"
#include "tests/diagnosis/hidden_views/view_world.hpp"

namespace roadbook::test {

/// The views of a landmark in one drive; may be empty.
struct HiddenSight {
  std::vector<Observation> views;
  Eigen::Vector3d rough = Eigen::Vector3d::Zero();  ///< error of its place in the map
};
using HiddenSights = std::vector<HiddenSight>;  ///< of each landmark

/// A landmark of the map with the views of some drives.
void add_landmark(const OwnLandmark& landmark,
                  const std::vector<const HiddenSight*>& sights,
                  Map& map);

/// "map.moved_landmarks": clumps of about 2 m, each moved its own way by 0.2 to 0.6 m, until they
/// are that share of all.
void move_landmarks(const HiddenViewOptions& options, std::vector<OwnLandmark>& landmarks);

/// A clump in which all landmarks are removed.
struct GoneClump {
  double x = 0.0;
  double y = 0.0;
  double radius_m = 0.0;
  std::size_t landmarks = 0;  ///< that the earlier drive saw
  double share = 0.0;         ///< of all that it saw
};

/// The effect "map.landmarks_gone": removes the views of `now` in clumps of 1.2 to 2.2 m until the
/// given share of the views of `then` is reached.
[[nodiscard]] std::vector<GoneClump> remove_landmarks(const HiddenViewOptions& options,
                                                      const std::vector<OwnLandmark>& landmarks,
                                                      const HiddenSights& then,
                                                      HiddenSights& now);
void write_gone(const std::vector<GoneClump>& clumps, const std::filesystem::path& file);
[[nodiscard]] std::vector<GoneClump> read_gone(const std::filesystem::path& file);

/// Joins two drives as mapping does: an unmoved landmark becomes one landmark, except one in five
/// that is not recognised; a moved one becomes two. Unrecognised landmarks get another descriptor.
/// Descriptors of the same landmark differ in a few bits.
void join_visits(const HiddenViewOptions& options,
                 const std::vector<OwnLandmark>& before,
                 const HiddenSights& then,
                 const std::vector<OwnLandmark>& after,
                 const HiddenSights& now,
                 Map& map);

/// "map.scale" and "map.bend" of all that the map holds, about the drive's first keyframe.
void bend_map(const HiddenViewOptions& options, Map& map);

}  // namespace roadbook::test
