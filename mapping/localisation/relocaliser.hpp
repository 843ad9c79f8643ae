#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/localisation/descriptor_search.hpp"
#include "mapping/localisation/frame_fix.hpp"

namespace roadbook {

struct RelocaliseOptions {
  DescriptorSearchOptions descriptors;
  std::size_t neighbours = 3;  ///< landmarks that a corner votes for
  int vote_hamming = 95;       ///< largest distance of descriptors of a vote, of 512 bits
  std::size_t places = 5;      ///< with the most votes, which are verified
  double vote_share = 0.4;     ///< places with fewer votes, of the best one's, are not verified
  double apart_m = 4.0;        ///< least distance of two places
  double same_place_m = 1.0;   ///< around a found pose, other places are not verified
  int max_hamming = 105;       ///< of a match in a place, of 512 bits
  double max_ratio = 0.88;     ///< nearest over second-nearest descriptor distance
  double inlier_rad = 0.015;   ///< of the first pose, angle between ray and landmark
  int ransac_iterations = 300;
  int min_inliers = 30;    ///< of guided matching
  double min_share = 0.4;  ///< inliers of guided matching, of the matches by descriptor
  double ambiguous_share =
      0.7;                     ///< with more inliers, of the best one's, a second place is a rival
  double max_tilt_rad = 0.26;  ///< of the car against the car that mapped the place
  double max_height_m = 1.0;   ///< the same, of its height
  std::uint64_t seed = 1;

  /// Throws InvalidOption.
  void check() const;
};

/// Where a frame without a predicted pose may be.
struct PlaceFound {
  FrameFix fix;
  int keyframe = 0;        ///< of the map, of the place
  double share = 0.0;      ///< inliers of guided matching, of the matches by descriptor
  bool ambiguous = false;  ///< a second place explains the frame nearly as well
};

/// Finds frames in a map without a guess [metric-semantic maps, section IV-C needs one]. Keeps a
/// reference to the index. Deterministic. Not for concurrent use.
class Relocaliser {
 public:
  Relocaliser(const LandmarkIndex& index, const RelocaliseOptions& options);

  /// Corners vote for the keyframes that saw similar landmarks; the places with the most votes are
  /// verified: matches by descriptor, pose by RANSAC with samples from all cameras, Ceres, guided
  /// matching. Empty if no place has enough inliers.
  [[nodiscard]] std::optional<PlaceFound> find(const Rig& half_rig,
                                               const FrameCorners& corners,
                                               const FrameFixOptions& fix_options) const;
  /// The same for one place alone: around the map's keyframe nearest to `p_map`.
  [[nodiscard]] std::optional<PlaceFound> find_near(const Rig& half_rig,
                                                    const FrameCorners& corners,
                                                    const Eigen::Vector3d& p_map,
                                                    const FrameFixOptions& fix_options) const;

 private:
  [[nodiscard]] std::vector<int> voted(const FrameCorners& corners) const;
  [[nodiscard]] std::optional<PlaceFound> verify(const Rig& half_rig,
                                                 const FrameCorners& corners,
                                                 int keyframe,
                                                 const FrameFixOptions& fix_options) const;

  const LandmarkIndex& index_;
  RelocaliseOptions options_;
  std::vector<int> searched_;  // landmark of each descriptor of the search
  DescriptorSearch search_;
};

}  // namespace roadbook
