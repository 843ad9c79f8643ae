#include "semantics/overhead/overhead.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <string>
#include <system_error>

#include "base/error.hpp"
#include "semantics/overhead/ground_camera.hpp"
#include "semantics/overhead/overhead_files.hpp"
#include "semantics/overhead/overhead_passes.hpp"
#include "semantics/overhead/tile_store.hpp"

namespace roadbook {
namespace {

void check_views(const OverheadInput& input) {
  for (std::size_t i = 0; i < input.views.size(); ++i) {
    const int rig = input.views[i].rig;
    if (rig < 0 || static_cast<std::size_t>(rig) >= input.rigs.size())
      throw BadInput({Severity::kError, "overhead view " + std::to_string(i), 0, "rig",
                      std::to_string(rig), "less than " + std::to_string(input.rigs.size())});
    if (!input.views[i].T_map_vehicle.matrix().allFinite())
      throw BadInput({Severity::kError, "overhead view " + std::to_string(i), 0, "pose",
                      "not finite", "a pose"});
  }
}

OverheadExposure exposure_of(const std::vector<std::vector<double>>& gains,
                             const OverheadOptions& options) {
  OverheadExposure exposure;
  exposure.balanced = options.balance_exposure;
  for (const auto& of_view : gains)
    for (const double gain : of_view) {
      exposure.least_gain = std::min(exposure.least_gain, gain);
      exposure.most_gain = std::max(exposure.most_gain, gain);
    }
  return exposure;
}

// What `memory_mb` leaves beside the tiles, for images between the two passes [bytes].
std::size_t room_for_images(const PlacedViews& placed, std::size_t max_resident, int memory_mb) {
  std::set<TileIndex> tiles;
  for (const auto& of_view : placed.tiles) tiles.insert(of_view.begin(), of_view.end());
  const std::size_t taken = std::min(tiles.size(), max_resident) * MosaicTile::bytes();
  return static_cast<std::size_t>(memory_mb) * 1'000'000 - taken;
}

class Clock {
 public:
  // Seconds since construction or the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

double range_of_rigs(const std::vector<Rig>& rigs) {
  constexpr double kLeastM = 8.0;
  constexpr double kBeyondNearest = 1.5;
  double range = kLeastM;
  for (const Rig& rig : rigs)
    for (const MountedCamera& mounted : rig.cameras)
      if (const auto nearest = nearest_ground_m(mounted))
        range = std::max(range, kBeyondNearest * *nearest);
  return std::min(range, 100.0);
}

OverheadSummary make_overhead(const OverheadInput& input,
                              const std::filesystem::path& out,
                              const OverheadOptions& given,
                              const Progress& progress) {
  given.check();
  OverheadOptions options = given;
  if (!options.max_range_m) options.max_range_m = range_of_rigs(input.rigs);
  check_views(input);
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error)
    throw StorageError("error: " + out.string() + ": folder: got " + error.message() +
                       ", want one to write to");

  OverheadSummary summary;
  summary.views = input.views.size();
  summary.max_range_m = *options.max_range_m;
  summary.vehicles = input.vehicles;
  Clock clock;
  const PlacedViews placed = place_views(input, options);
  const std::size_t max_resident =
      static_cast<std::size_t>(options.memory_mb) * 1'000'000 / MosaicTile::bytes();
  ViewImages images(input, room_for_images(placed, max_resident, options.memory_mb));
  const auto gains = balance_exposure(input, placed, options, progress, &images);
  summary.exposure = exposure_of(gains, options);
  summary.exposure_seconds = clock.lap();

  TileStore store(out / ".overhead_scratch", max_resident, options.resolution_m, input.ground);
  const MosaicCounts counts = add_views(input, placed, gains, options, progress, &images, &store);
  summary.images_used = counts.images_used;
  summary.images_missing = counts.images_missing;
  summary.mosaic_seconds = clock.lap();

  write_overhead(input, out, options, progress, &store, &summary);
  summary.tiles_spilled = store.spilled();
  summary.write_seconds = clock.lap();
  return summary;
}

}  // namespace roadbook
