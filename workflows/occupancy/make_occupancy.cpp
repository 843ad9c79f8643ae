#include "workflows/occupancy/make_occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "base/format.hpp"
#include "exchange/layers/layer_ages.hpp"
#include "mapping/occupancy/reading_dependence.hpp"
#include "mapping/pieces.hpp"
#include "workflows/occupancy/beam_model_file.hpp"
#include "workflows/occupancy/camera_sights.hpp"
#include "workflows/occupancy/drive_poses.hpp"
#include "workflows/occupancy/drive_scans.hpp"

namespace roadbook {
namespace {

constexpr double kMostWithoutPose = 0.2;  // share of the scans

double processor_s() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// The grid that the map has, if new drives may be added to it.
StoredOccupancy stored_or_new(const MapLayers& layers, const OccupancyRequest& request) {
  auto stored = request.replace ? std::nullopt : read_occupancy_layers(layers);
  if (!stored) {
    if (request.drives.empty())
      throw Refused("error: " + request.map.string() +
                    ": occupancy: got no grid to place again, want one (name a DRIVE)");
    StoredOccupancy fresh;
    fresh.cell_m = request.cell_m;
    fresh.update = request.update;
    fresh.surfaces_per_m = 0.0;  // by the first drive
    return fresh;
  }
  if (request.drives.empty()) return std::move(*stored);
  if (stored->cell_m != request.cell_m)
    throw InvalidOption("--cell-m", fixed(request.cell_m, 3),
                        fixed(stored->cell_m, 3) + " as the grid of the map, or --replace");
  if (stored->update != request.update)
    throw InvalidOption(
        "--update", to_text(request.update),
        std::string(to_text(stored->update)) + " as the grid of the map, or --replace");
  return std::move(*stored);
}

void refuse_without_poses(const std::filesystem::path& drive, const DriveScans& read) {
  const std::size_t all = read.scans.size() + read.without_pose;
  if (all == 0) throw Refused("error: " + drive.string() + ": range0: got no readings, want some");
  if (static_cast<double>(read.without_pose) <= kMostWithoutPose * static_cast<double>(all)) return;
  throw Refused("error: " + drive.string() + ": range0: got no pose in the map for " +
                std::to_string(read.without_pose) + " of " + std::to_string(all) +
                " scans, want poses for 80 % of them");
}

// The forward model that the request names.
RangeMixture mixture_for(const OccupancyRequest& request,
                         const DriveScans& read,
                         const std::filesystem::path& drive,
                         Messages& messages,
                         OccupancyOfDrive& added) {
  if (request.model == "nominal") return mixture_of({}, read.model.sigma_m);
  if (request.model != "fitted") return read_beam_model(request.model);
  const FittedBeams fitted = fit_beams(read.scans, read.model.max_m, read.model.sigma_m);
  added.fitted_samples = fitted.samples;
  if (!fitted.enough) {
    messages.warn({{Severity::kWarning, drive.string(), 0, "range0",
                    std::to_string(fitted.samples) + " readings of surfaces that others met too",
                    "500 to fit the beam model; the nominal one is used"}});
    added.drive.model = "nominal";
  }
  return fitted.mixture;
}

void drop_drive(const OccupancyDrive& again, StoredOccupancy& stored) {
  const auto same = [&](const OccupancyDrive& d) {
    return d.digest == again.digest && d.sensor == again.sensor;
  };
  for (const OccupancyDrive& d : stored.drives)
    if (same(d))
      std::erase_if(stored.patches, [&](const OccupancyPatch& p) { return p.drive == d.drive; });
  std::erase_if(stored.drives, same);
}

// A name that no other drive of the grid has.
std::string free_name(const std::string& name, const StoredOccupancy& stored) {
  std::string candidate = name;
  for (int n = 2; std::any_of(stored.drives.begin(), stored.drives.end(),
                              [&](const OccupancyDrive& d) { return d.drive == candidate; });
       ++n)
    candidate = name + " (" + std::to_string(n) + ")";
  return candidate;
}

void begin_drive(const Drive& drive,
                 const std::string& sensor,
                 StoredOccupancy& stored,
                 OccupancyOfDrive& added) {
  added.drive.digest = drive.digest();
  added.drive.sensor = sensor;
  drop_drive(added.drive, stored);
  added.drive.drive = free_name(drive.name(), stored);
}

void end_drive(BuiltPatches built, StoredOccupancy& stored, OccupancyOfDrive& added) {
  added.updates = built.updates;
  added.drive.updates = static_cast<std::int64_t>(built.updates);
  added.patches = built.patches.size();
  std::move(built.patches.begin(), built.patches.end(), std::back_inserter(stored.patches));
  stored.drives.push_back(added.drive);
}

// Cameras do not have a beam, and their sights add up as log odds.
void refuse_options_of_scanners(const OccupancyRequest& request) {
  if (request.model != "fitted")
    throw InvalidOption("--model", request.model, "no beam model with --sensor cameras");
  if (request.wide_beam_rad > 0.0)
    throw InvalidOption("--wide-beam", fixed(request.wide_beam_rad, 3),
                        "no wide beam with --sensor cameras");
  if (request.update != OccupancyUpdate::kLogOdds)
    throw InvalidOption("--update", to_text(request.update), "log-odds with --sensor cameras");
}

int session_of(const Drive& drive, const Map& map, const std::filesystem::path& folder) {
  const std::string digest = drive.digest();
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    if (map.sessions[s].drive_digest == digest) return static_cast<int>(s);
  throw Refused("error: " + folder.string() +
                ": --sensor cameras: got a drive that is no session of the map, want one whose "
                "landmarks the map has (map --extend adds it)");
}

OccupancyOfDrive add_cameras(const OccupancyRequest& request,
                             const std::filesystem::path& folder,
                             const Map& map,
                             StoredOccupancy& stored) {
  const Drive drive = Drive::open(folder);
  OccupancyOfDrive added;
  begin_drive(drive, "cameras", stored, added);
  added.drive.model = "fitted";
  const int session = session_of(drive, map, folder);
  const double before = processor_s();
  const CameraSights seen = camera_sights(map, session);
  added.on_ground = seen.on_ground;
  added.raised = seen.raised;
  BuildPatchesOptions options;
  options.cell_m = request.cell_m;
  options.patch_m = request.patch_m;
  options.num_threads = request.num_threads;
  auto camera =
      build_camera_patches(seen.views, seen.sights, patch_anchors(map), added.drive.drive, options);
  if (!camera)
    throw Refused("error: " + folder.string() + ": --sensor cameras: got " +
                  std::to_string(seen.on_ground) + " landmarks on the ground and " +
                  std::to_string(seen.raised) + " raised ones near the cameras, want both kinds");
  added.seconds = processor_s() - before;
  const SightRates& rates = camera->rates;
  if (!rates.shows_obstacles())
    throw Refused("error: " + folder.string() + ": --sensor cameras: got " +
                  std::to_string(seen.raised) + " raised landmarks, too uncertain for cells of " +
                  fixed(request.cell_m, 2) + " m, want larger cells (--cell-m " +
                  fixed(2.5 * request.cell_m, 2) + ") or a map with more landmarks");
  added.drive.sights_raised = rates.raised_if_occupied;
  added.drive.sights_raised_free = rates.raised_if_free;
  added.drive.scans = static_cast<std::int64_t>(seen.views.size());
  added.drive.begin_ns = seen.views.front().t_ns;
  added.drive.end_ns = seen.views.back().t_ns;
  added.drive.max_m = CameraSightOptions{}.max_range_m;
  added.drive.temper = request.temper.value_or(rates.temper());
  if (stored.drives.empty()) stored.prior = rates.occupied;
  // A scanner that comes later meets as many surfaces as make this share of cells occupied.
  if (stored.surfaces_per_m == 0.0)
    stored.surfaces_per_m = -std::log1p(-rates.occupied * kMetInCell) / request.cell_m;
  end_drive(std::move(camera->built), stored, added);
  return added;
}

OccupancyOfDrive add_drive(const OccupancyRequest& request,
                           const std::filesystem::path& folder,
                           const Map& map,
                           StoredOccupancy& stored,
                           Messages& messages) {
  const Drive drive = Drive::open(folder);
  OccupancyOfDrive added;
  begin_drive(drive, "range0", stored, added);
  added.drive.model = request.model;
  const DrivePoses poses = drive_poses(drive, map, request.map, request.num_threads, messages);
  added.drive.localised = poses.localised;
  const DriveScans read = read_drive_scans(drive, poses.at);
  refuse_without_poses(folder, read);
  added.without_pose = read.without_pose;
  added.drive.scans = static_cast<std::int64_t>(read.scans.size());
  added.drive.begin_ns = read.scans.front().t_ns;
  added.drive.end_ns = read.scans.back().t_ns;
  added.drive.max_m = read.model.max_m;
  added.drive.cone_rad = request.wide_beam_rad;
  added.drive.mixture = mixture_for(request, read, folder, messages, added);
  if (stored.surfaces_per_m == 0.0)
    stored.surfaces_per_m = surfaces_per_m(read.scans, read.model.max_m);
  InverseRangeOptions inverse_options;
  inverse_options.cell_m = request.cell_m;
  inverse_options.surfaces_per_m = stored.surfaces_per_m;
  inverse_options.cone_rad = request.wide_beam_rad;
  const InverseRangeModel inverse(added.drive.mixture, read.model.max_m, inverse_options);
  if (stored.drives.empty()) stored.prior = inverse.prior();
  added.drive.temper = request.temper.value_or(1.0);
  if (!request.temper) {
    const ReadingDependence dependence = reading_dependence(
        read.scans, added.drive.mixture, inverse, request.cell_m, request.wide_beam_rad);
    added.autocorrelation = dependence.autocorrelation;
    added.drive.temper = std::max(dependence.effective_share, 0.001);
  }
  BuildPatchesOptions options;
  options.cell_m = request.cell_m;
  options.patch_m = request.patch_m;
  options.cone_rad = request.wide_beam_rad;
  options.update = request.update;
  options.num_threads = request.num_threads;
  const auto anchors = patch_anchors(map);
  const double before = processor_s();
  BuiltPatches built = build_patches(read.scans, poses.anchors_of(read.scans, map), anchors,
                                     added.drive.drive, inverse, options);
  added.seconds = processor_s() - before;
  end_drive(std::move(built), stored, added);
  return added;
}

}  // namespace

OccupancyResult make_occupancy(const OccupancyRequest& request, Messages& messages) {
  const bool cameras = request.sensor == OccupancySensor::kCameras;
  if (cameras) refuse_options_of_scanners(request);
  MapUpdate update(request.map);  // locks the map between reading and writing
  const Map map = load_joined_map(request.map);
  const MapLayers layers(request.map);
  OccupancyResult result;
  result.stored = stored_or_new(layers, request);
  for (const auto& folder : request.drives)
    result.drives.push_back(cameras ? add_cameras(request, folder, map, result.stored)
                                    : add_drive(request, folder, map, result.stored, messages));
  result.grid =
      place_patches(result.stored.patches, keyframe_poses(map), result.stored.reading_weights());
  if (result.grid.shape.size() == 0)
    throw Refused("error: " + request.map.string() +
                  ": occupancy_patches: got none on poses of this map, want some");
  result.demands = occupancy_demands(result.stored, result.grid, map,
                                     true_place(request.map, map, request.drives));
  write_occupancy_layers(update, result.stored, result.grid);
  std::int64_t newest_ns = 0;
  for (const OccupancyPatch& p : result.stored.patches) newest_ns = std::max(newest_ns, p.end_ns);
  write_raster_age(update, layers, {"occupancy", newest_ns, kOccupancyHalfLife_s}, newest_ns);
  std::string names;
  for (const OccupancyOfDrive& d : result.drives)
    names += (names.empty() ? "" : ", ") + d.drive.drive;
  update.note("occupancy", names.empty() ? "placed again" : names);
  update.commit();
  return result;
}

}  // namespace roadbook
