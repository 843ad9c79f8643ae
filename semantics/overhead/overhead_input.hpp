#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "semantics/overhead/ground_model.hpp"
#include "sensors/rig.hpp"
#include "sensors/vehicle.hpp"

namespace roadbook {

/// Knowledge of the own vehicle used for a rig: its source, and the share of each camera's image
/// that the vehicle covers.
struct VehicleUse {
  VehicleSource source = VehicleSource::kNone;
  std::vector<double> masked_share;  ///< by camera, 0 to 1
};

/// One instant: vehicle pose and camera images.
struct OverheadView {
  /// One function per camera of the rig; returns the grey 8-bit image, empty if it is missing.
  /// Called at most twice (again for the mosaic if memory is short), from any thread.
  std::vector<std::function<cv::Mat()>> images;
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  int rig = 0;            ///< index in OverheadInput::rigs
  int session = 0;        ///< for the table of frames
  int keyframe = 0;       ///< for the table of frames
  std::int64_t t_ns = 0;  ///< for the table of frames; since 1970
};

struct OverheadInput {
  std::vector<Rig> rigs;
  /// masks[rig][camera]: 0 where the own vehicle is visible; any size; empty: no mask. May be
  /// shorter than `rigs`.
  std::vector<std::vector<cv::Mat>> masks;
  /// bodies[rig]: box of the own vehicle, vehicle frame. Ground that it covers or hides is left out
  /// (`is_hidden_by_body`). An empty box hides nothing. May be shorter than `rigs`.
  std::vector<Eigen::AlignedBox3d> bodies;
  std::vector<VehicleUse> vehicles;  ///< by rig, for the summary
  std::vector<OverheadView> views;   ///< in driving order
  GroundModel ground = GroundModel::plane();
};

}  // namespace roadbook
