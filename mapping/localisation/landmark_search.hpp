#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "base/se3.hpp"
#include "mapping/localisation/landmark_index.hpp"
#include "sensors/rig.hpp"
#include "vo/feature_grid.hpp"
#include "vo/features.hpp"

namespace roadbook {

/// A landmark and the key point of the new images that shows it.
struct LandmarkView {
  int landmark = 0;  ///< index in `Map::landmarks`
  int camera = 0;
  int feature = 0;   ///< index in the features of the camera
  int distance = 0;  ///< of the descriptors, of 512 bits
};

struct LandmarkSearchOptions {
  double sigma_px = 0.6;         ///< of a corner, half-size image
  double gate_sigma = 3.0;       ///< half axis of the search ellipse in standard deviations
  double min_radius_px = 2.0;    ///< the ellipse is never smaller, half-size image
  double max_radius_px = 20.0;   ///< and never larger
  int max_hamming = 105;         ///< largest distance of descriptors, of 512 bits
  double max_ratio = 0.85;       ///< nearest over second-nearest descriptor in the ellipse
  double bits_per_sigma = 25.0;  ///< descriptor distance that costs as much as one sigma of place
};

/// The features of one frame of all cameras, with a grid over each.
class FrameCorners {
 public:
  /// `half_rig`: cameras of the half-size images.
  FrameCorners(const Rig& half_rig, std::vector<Features> features);
  FrameCorners(const FrameCorners&) = delete;
  FrameCorners& operator=(const FrameCorners&) = delete;

  [[nodiscard]] const std::vector<Features>& features() const { return features_; }
  [[nodiscard]] const FeatureGrid& grid(std::size_t camera) const { return grids_[camera]; }
  [[nodiscard]] Eigen::Vector2d pixel(const LandmarkView& view) const;

 private:
  std::vector<Features> features_;
  std::vector<FeatureGrid> grids_;
};

struct FoundLandmarks {
  std::vector<LandmarkView> views;  ///< ascending camera, then landmark; one a feature
  std::vector<int> in_view;         ///< landmarks that project into an image, ascending
};

/// Projects the landmarks `candidates` with the predicted pose and searches the features for them
/// [metric-semantic maps, section IV-C: "taking both the image space and descriptor distance into
/// account"]. The search ellipse is the sum of the covariances of the pose, of the landmark and of
/// a corner. Cost of a pair: the squared distance in the ellipse plus the squared descriptor
/// distance over `bits_per_sigma`. Each landmark and each feature of a camera goes to one partner.
/// `covariance`: of the right perturbation of the pose. Deterministic.
[[nodiscard]] FoundLandmarks find_landmarks(const Rig& half_rig,
                                            const FrameCorners& corners,
                                            const LandmarkIndex& index,
                                            const std::vector<int>& candidates,
                                            const Eigen::Isometry3d& T_map_vehicle,
                                            const Matrix6d& covariance,
                                            const LandmarkSearchOptions& options = {});

}  // namespace roadbook
