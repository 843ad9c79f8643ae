#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

// Independent simulation that hides effects of cameras: a drive through landmarks with four fisheye
// cameras. Projection, timing and ground are its own; it shares only the declared meaning of
// effects with diagnosis.

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
  /// Share of present landmarks that the drive does not redetect, varying by 0.1 from place to
  /// place; 0: none anywhere.
  double lost = 0.0;
  /// Effect outside the catalogue: a common shift of all views of an image, standard deviation of
  /// each component [px]; first-order process with 0.9 from keyframe to keyframe.
  double images_shift_px = 0.0;
  /// In the same way: rotation about the image's middle [rad] and relative stretch.
  double images_turn = 0.0;
  /// No effect: corner errors of each landmark in one camera [px], with 0.9 from keyframe to
  /// keyframe.
  double corners_wander_px = 0.0;
};

/// Writes `folder`/drive, `folder`/map.gpkg and `folder`/gone.csv, which holds the true removed
/// clumps (`GoneClump`).
void write_hidden_views(const HiddenViewOptions& options, const std::filesystem::path& folder);

/// Practical ranges of effects that the views of a map can show.
[[nodiscard]] const std::vector<EffectRange>& practical_view_ranges();
/// Practical ranges of effects that show against the map of an earlier drive.
[[nodiscard]] const std::vector<EffectRange>& practical_map_ranges();

}  // namespace roadbook::test
