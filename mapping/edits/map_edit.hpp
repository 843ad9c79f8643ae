#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace roadbook {

// Corrections that a person makes to a map (docs/guide/map_life.md, "Correct a map by hand"). Edits
// name poses by session and time, so that they stay valid when the map is built again.

enum class EditKind { kLoop, kSamePoints, kNotALoop, kAnchor };

/// A vehicle pose of the map: the keyframe of `session` nearest in time.
struct EditPlace {
  std::string session;
  std::int64_t t_ns = 0;
};

struct MapEdit {
  EditKind kind = EditKind::kLoop;
  EditPlace a;
  EditPlace b;  ///< not of kAnchor
  /// kLoop: pose of b in the vehicle frame of a; kAnchor: pose of a in the map. x, y [m],
  /// heading [rad].
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
  double sigma_m = 0.1;  ///< standard deviations of `motion`
  double sigma_rad = 0.02;
  /// kSamePoints: cameras and pixels (full-size images) that show the same points, in this order.
  std::string camera_a;
  std::string camera_b;
  std::vector<Eigen::Vector2d> pixels_a;
  std::vector<Eigen::Vector2d> pixels_b;
};

/// One line: "loop monday@5.2 s - tuesday@7.0 s".
[[nodiscard]] std::string text_of(const MapEdit& edit);

}  // namespace roadbook
