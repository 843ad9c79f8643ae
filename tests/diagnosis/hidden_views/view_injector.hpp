#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

// The one who hides, for cameras: a drive through landmarks, seen by a rig of four fisheyes with
// projection, timing and ground of its own; it shares with diagnosis only the declared meaning of
// each effect. What it writes is what mapping would: a drive with wheels and IMU, and a MAP with
// keyframes, landmarks and views by the nominal calibration.

struct HiddenViewOptions {
  std::uint64_t seed = 1;
  double length_m = 300.0;
  Secret secret;           ///< "cam1.focal", "cam.latency", "wheels0.radius", "ground.hinge", ...
  double outliers = 0.02;  ///< share of views
  double landmarks_per_m = 8.0;
  bool wheels = true;      ///< recorded
  bool imu = true;         ///< recorded
  bool reference = false;  ///< poses are recorded, by another clock than any camera's
  bool earlier = false;    ///< the map knows the place from an earlier drive as well
  /// Share of what stands that the drive does not recognise, by 0.1 more or less from place to
  /// place; 0: none anywhere.
  double lost = 0.0;
  /// What nobody listed: each camera's images are shifted by so much (standard deviation of either
  /// component), by 0.9 as the keyframe's before.
  double images_shift_px = 0.0;
  /// In the same way turned about their middle [rad] and stretched from it (part of their size).
  double images_turn = 0.0;
  /// No cause: each landmark's views by one camera err by so much, by 0.9 as the keyframe's before.
  double corners_wander_px = 0.0;
};

/// Writes `folder`/drive and `folder`/map.gpkg; beside them `folder`/gone.csv, the secret of
/// "map.landmarks_gone": see `GoneClump`.
void write_hidden_views(const HiddenViewOptions& options, const std::filesystem::path& folder);

/// Practical ranges of what the views of a map may show.
[[nodiscard]] const std::vector<EffectRange>& practical_view_ranges();
/// The same of what shows against an earlier drive's map.
[[nodiscard]] const std::vector<EffectRange>& practical_map_ranges();

}  // namespace roadbook::test
