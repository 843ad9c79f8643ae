#pragma once

#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/optimisation/covariance.hpp"
#include "mapping/pipeline/build_map.hpp"

namespace roadbook {

// The stages of build_map after odometry, without files: what goes in and what comes out.

/// Odometry of several drives one after the other, joined by gaps.
[[nodiscard]] MappingInput join_drives(std::vector<VoResult> odometry,
                                       const std::vector<Rig>& rigs,
                                       const std::vector<bool>& has_wheels);

/// Brings odometry without wheels to metres by the cameras' height over the ground. Changes poses,
/// track places and travelled distances; gives the relative sigma of the scale, or nothing where
/// the ground was not seen.
std::optional<double> scale_by_ground(MappingInput& input, int session, const MapOptions& options);

struct Relaxed {
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<int> piece;
  int pieces = 1;
};

/// Pose graph of odometry and loops; marks the loops it drops, with the reason.
[[nodiscard]] Relaxed relax_poses(const MappingInput& input,
                                  std::vector<LoopClosure>& loops,
                                  const MapOptions& options,
                                  const Progress& progress);

struct Adjusted {
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  std::vector<CornerTrack> tracks;
  BundleStage stage;
  BundleResult result;
  EqualRowsUsed rows;  ///< MapOptions::equal_rows
  BundleCovariance covariance;
};

/// Triangulation, corners found again in other passes, full bundle adjustment.
[[nodiscard]] Adjusted adjust(const MappingInput& input,
                              const std::vector<LoopClosure>& loops,
                              const Relaxed& relaxed,
                              const MapOptions& options,
                              const Progress& progress);

/// Map frames, keyframes, landmarks and observations of the finished map; sessions are the
/// caller's.
[[nodiscard]] Map assemble_map(const MappingInput& input,
                               const std::vector<LoopClosure>& loops,
                               const Adjusted& adjusted,
                               const MapOptions& options);

}  // namespace roadbook
