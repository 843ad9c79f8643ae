#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mapping/layers/layer_types.hpp"
#include "mapping/loops/loop_closure.hpp"
#include "mapping/map.hpp"
#include "mapping/optimisation/pose_graph.hpp"
#include "mapping/pipeline/bundle_problem.hpp"
#include "mapping/pipeline/parking_row_prior.hpp"
#include "mapping/pipeline/revisit_matching.hpp"
#include "mapping/store/existing_map.hpp"
#include "sensors/effects.hpp"
#include "vo/track_drive.hpp"

namespace roadbook {

/// The least evidence from which a map is made; with less it is refused.
struct MapGateOptions {
  int min_landmarks = 30;          ///< seen by each drive
  int min_views = 8;               ///< of landmarks, of a keyframe that the images hold
  double min_held_share = 0.5;     ///< of each drive's keyframes that the images hold
  double min_camera_views = 1.5;   ///< mean of a camera in use, by keyframe with its image
  double min_cameras_share = 0.5;  ///< of each drive's cameras that are in use
  int alike_loops = 20;  ///< with fewer pairs of alike places their accepted share is not judged
  double min_alike_share = 0.1;  ///< accepted, of the pairs of places that look alike
  bool apart = false;            ///< parts that nothing joins are kept as pieces
};

/// What moves when a session extends a map.
enum class SessionAdjust {
  kNear,  ///< the session, and the poses of the map that share most landmarks with it
  kAll,   ///< everything
  kNone,  ///< the session alone; the map stays as it is, bit for bit
};

/// How to build a map.
struct MapOptions {
  TrackDriveOptions tracking;
  LoopOptions loops;
  PoseGraphOptions graph;
  TriangulationOptions triangulation;
  RevisitOptions revisits;
  BundleStageOptions bundle;
  int min_views = 3;        ///< key points of a landmark that is stored
  bool covariances = true;  ///< of poses and landmarks, from the normal equations
  int min_keyframes = 3;    ///< a drive with fewer is refused
  MapGateOptions gate;
  /// Measures of the vehicle; they replace vehicle.yaml of the drives.
  std::optional<VehicleMeasures> vehicle;
  EffectSizes model;     ///< known imperfections; corrected in rig and readings before mapping
  bool replace = false;  ///< overwrite a map of other drives
  SessionAdjust adjust = SessionAdjust::kNear;  ///< by `extend_map`
  std::string session_name;                     ///< of a single drive; empty: that of its folder
  /// Tables of the existing map that the new map takes over (MapFinishOptions).
  std::vector<std::string> keep_tables;
  /// Tables taken over only if the new map begins with all drives of the existing map.
  std::vector<std::string> keep_tables_of_drives;
  /// Called before the build if it does not; throws if labels would be lost.
  std::function<void(const ExistingMap&)> check_what_goes;
  /// Makes layers to be stored with the finished map, such as labels moved with its poses.
  std::function<std::vector<VectorLayer>(const Map&)> more_layers;
  /// Rows of equal parking spaces, a prior of the last bundle adjustment; not set: none. Called
  /// with keyframes and map frames before that adjustment.
  std::function<std::vector<EqualRow>(const Map&)> equal_rows;
  EqualRowOptions row_options;
  std::string
      rows_digest;  ///< digest of the labels that `equal_rows` reads; part of the inputs key
  /// Descriptors of so much in all leave the memory where nothing reads them.
  std::size_t descriptors_mb = 128;
  std::uint64_t seed = 1;
  int num_threads = 0;  ///< 0: all cores

  /// Throws InvalidOption.
  void check() const;
};

}  // namespace roadbook
