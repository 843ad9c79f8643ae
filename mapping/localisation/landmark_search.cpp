#include "mapping/localisation/landmark_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/index.hpp"

namespace roadbook {
namespace {

/// Where a landmark is expected in one image.
struct Expected {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d information;  // inverse of the ellipse
  double radius_px = 0.0;       // half side of the square around the ellipse
};

// The pose of the rig, and what does not depend on the landmark.
struct View {
  const MountedCamera& mounted;
  Eigen::Isometry3d T_vehicle_map;
  Eigen::Matrix3d R_camera_vehicle;
  const Matrix6d& covariance;
  const LandmarkSearchOptions& options;

  [[nodiscard]] std::optional<Expected> expect(const KnownLandmark& landmark) const {
    const Eigen::Vector3d p_vehicle = T_vehicle_map * landmark.p_map;
    const Eigen::Vector3d p_camera =
        R_camera_vehicle * (p_vehicle - mounted.T_vehicle_camera.translation());
    Matrix23d J_point;
    const auto pixel = mounted.camera.project(p_camera, &J_point);
    if (!pixel || !mounted.camera.contains(*pixel)) return std::nullopt;
    const Matrix23d J_vehicle = J_point * R_camera_vehicle;
    Eigen::Matrix<double, 2, 6> J;
    J.leftCols<3>() = -J_vehicle;
    J.rightCols<3>() = J_vehicle * skew<double>(p_vehicle);
    const Matrix23d J_map = J_vehicle * T_vehicle_map.linear();
    Eigen::Matrix2d S =
        J * covariance * J.transpose() + J_map * landmark.covariance * J_map.transpose();
    S.diagonal().array() += options.sigma_px * options.sigma_px;
    const double largest = options.gate_sigma * std::sqrt(std::max(S(0, 0), S(1, 1)));
    Expected expected;
    expected.pixel = *pixel;
    expected.radius_px = std::clamp(largest, options.min_radius_px, options.max_radius_px);
    // An ellipse that the limits change keeps its shape.
    const double scale = expected.radius_px / largest;
    expected.information = (scale * scale * S).inverse();
    return expected;
  }
};

struct Choice {
  int feature = -1;
  int distance = std::numeric_limits<int>::max();
  double cost = std::numeric_limits<double>::max();
};

Choice choose(const Features& features,
              const FeatureGrid& grid,
              const Descriptor& descriptor,
              const Expected& expected,
              const LandmarkSearchOptions& options) {
  Choice best;
  int second = std::numeric_limits<int>::max();
  const double gate = options.gate_sigma * options.gate_sigma;
  grid.for_each_near(expected.pixel, expected.radius_px, [&](int i) {
    const Eigen::Vector2d off = features.pixels[at(i)].cast<double>() - expected.pixel;
    const double place = off.dot(expected.information * off);
    if (place > gate) return;
    const int distance = hamming(descriptor, features.descriptors[at(i)]);
    const double bits = distance / options.bits_per_sigma;
    const double cost = place + bits * bits;
    if (cost < best.cost) {
      second = std::min(second, best.distance);
      best = {i, distance, cost};
    } else {
      second = std::min(second, distance);
    }
  });
  if (best.distance > options.max_hamming ||
      (second != std::numeric_limits<int>::max() && best.distance >= options.max_ratio * second))
    return {};
  return best;
}

}  // namespace

FrameCorners::FrameCorners(const Rig& half_rig, std::vector<Features> features)
    : features_(std::move(features)) {
  for (std::size_t c = 0; c < features_.size(); ++c)
    grids_.emplace_back(features_[c].pixels, half_rig.cameras[c].camera.width,
                        half_rig.cameras[c].camera.height);
}

Eigen::Vector2d FrameCorners::pixel(const LandmarkView& view) const {
  return features_[at(view.camera)].pixels[at(view.feature)].cast<double>();
}

FoundLandmarks find_landmarks(const Rig& half_rig,
                              const FrameCorners& corners,
                              const LandmarkIndex& index,
                              const std::vector<int>& candidates,
                              const Eigen::Isometry3d& T_map_vehicle,
                              const Matrix6d& covariance,
                              const LandmarkSearchOptions& options) {
  struct Owner {
    LandmarkView view;
    double cost = std::numeric_limits<double>::max();
  };
  FoundLandmarks found;
  const Eigen::Isometry3d T_vehicle_map = T_map_vehicle.inverse();
  for (std::size_t c = 0; c < half_rig.cameras.size(); ++c) {
    const Features& features = corners.features()[c];
    const MountedCamera& mounted = half_rig.cameras[c];
    const View view{mounted, T_vehicle_map, mounted.T_vehicle_camera.linear().transpose(),
                    covariance, options};
    std::vector<Owner> owners(features.size());
    for (const int l : candidates) {
      const auto expected = view.expect(index.landmarks()[at(l)]);
      if (!expected) continue;
      found.in_view.push_back(l);
      const Choice best = choose(features, corners.grid(c), index.map().landmarks[at(l)].descriptor,
                                 *expected, options);
      if (best.feature < 0) continue;
      Owner& owner = owners[at(best.feature)];
      if (best.cost < owner.cost)
        owner = {{l, static_cast<int>(c), best.feature, best.distance}, best.cost};
    }
    const auto first = static_cast<std::ptrdiff_t>(found.views.size());
    for (const Owner& owner : owners)
      if (owner.cost < std::numeric_limits<double>::max()) found.views.push_back(owner.view);
    std::sort(found.views.begin() + first, found.views.end(),
              [](const LandmarkView& a, const LandmarkView& b) { return a.landmark < b.landmark; });
  }
  std::sort(found.in_view.begin(), found.in_view.end());
  found.in_view.erase(std::unique(found.in_view.begin(), found.in_view.end()), found.in_view.end());
  return found;
}

}  // namespace roadbook
