#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sensors/rig.hpp"

namespace roadbook {

// Bundle adjustment of the newest keyframes of odometry without wheels. Poses that were found one
// after the other, each with points of the poses before it, drift: an error of one motion changes
// the points, and these the next motion. Poses and points of a window together drift far less
// (Mur-Artal, Montiel, Tardos 2015, section VI-D: local bundle adjustment).

/// A pixel in which a pose of the window saw a point.
struct WindowView {
  int pose = 0;
  int point = 0;
  int camera = 0;
  Eigen::Vector2d pixel;
};

struct VoWindow {
  std::vector<Eigen::Isometry3d> T_odom_vehicle;
  int fixed = 1;                        ///< number of first poses that stay; at least 1
  std::vector<Eigen::Vector3d> points;  ///< odometry frame
  std::vector<WindowView> views;        ///< ascending points
};

struct WindowOptions {
  double sigma_px = 0.6;
  /// Width of the robust (Cauchy) cost. Wide ones let slightly wrong corners shorten the way: with
  /// 2.5 px, a camera of 320x240 that sees little ground lost up to 40 % of its scale in a
  /// straight.
  double width_px = 0.5;
  int iterations = 10;
  int least_views = 20;  ///< of a pose; one with fewer stays, with all before it
};

/// Sum of the robust costs of all views. A view that does not project counts more than any other.
[[nodiscard]] double window_cost(const Rig& rig,
                                 const VoWindow& window,
                                 const WindowOptions& options);

/// Minimises the cost of a car's motion and `window_cost` by Levenberg-Marquardt over free poses
/// and points; points are eliminated (Schur complement). A car neither slides sideways nor hops:
/// motions between successive free poses have the prior `driving_information`. Never raises the
/// cost. Raises `window.fixed` where a pose has fewer than `least_views`.
void adjust_window(const Rig& rig, const WindowOptions& options, VoWindow& window);

}  // namespace roadbook
