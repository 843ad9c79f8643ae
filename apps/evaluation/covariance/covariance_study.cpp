#include "apps/evaluation/covariance/covariance_study.hpp"

#include "apps/evaluation/robustness/drive_fault.hpp"
#include "base/error.hpp"
#include "base/messages.hpp"
#include "base/temporary_folder.hpp"
#include "mapping/store/map_file.hpp"
#include "sim/simulate.hpp"
#include "workflows/map_drives.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

constexpr double kNoLoopSeconds = 10.0;  // less than a round

struct ImageSize {
  double scale;
  const char* name;
};

void plant_fault(const std::string& name, const fs::path& drive, std::uint64_t seed) {
  for (const auto& faults : {wheel_faults(), camera_faults()})
    for (const DriveFault& fault : faults)
      if (fault.name == name) {
        Random random(seed, name);
        (void)fault.plant(drive, random);
        return;
      }
  throw InvalidOption("fault", "'" + name + "'", "the name of a fault of drives");
}

}  // namespace

std::vector<CoverageKind> coverage_kinds(bool quick) {
  std::vector<ImageSize> sizes = {{0.5, "320x240"}};
  if (!quick) sizes = {{0.25, "160x120"}, {0.5, "320x240"}, {1.0, "640x480"}};
  std::vector<CoverageKind> kinds;
  for (const ImageSize& size : sizes)
    kinds.push_back({std::string("loops ") + size.name, size.scale, 0.0, {}, ""});
  for (const ImageSize& size : sizes)
    kinds.push_back({std::string("no loops ") + size.name, size.scale, kNoLoopSeconds, {}, ""});
  kinds.push_back({"all focal lengths 2 % wrong", 0.5, 0.0, {{"cam.focal", 0.02}}, ""});
  kinds.push_back({"one focal length 2 % wrong", 0.5, 0.0, {{"cam1.focal", 0.02}}, ""});
  kinds.push_back({"wheels stuck for 2 s", 0.5, 0.0, {}, "wheels: stuck 2.0 s, both"});
  return kinds;
}

void CoverageTally::add(const CoverageTally& other) {
  drives += other.drives;
  refused += other.refused;
  coverage.add(other.coverage);
}

CoverageTally coverage_of_drive(const CoverageKind& kind,
                                std::uint64_t seed,
                                int num_threads,
                                const Progress& progress) {
  const TemporaryFolder folder;
  const fs::path drive = folder.path() / "drive";
  Scenario scenario = load_scenario("zurich", {.size = "small", .image_scale = kind.image_scale});
  scenario.seed += 1000 * seed;
  SimulateOptions options;
  options.seed = seed;
  options.effects = kind.effects;
  options.range_images = true;
  options.max_duration_s = kind.seconds;
  options.num_threads = num_threads;
  simulate(scenario, drive, options, progress);
  if (!kind.fault.empty()) plant_fault(kind.fault, drive, seed);
  MapRequest request;
  request.drives = {drive};
  request.map = folder.path() / "place.gpkg";
  request.options.seed = seed;
  request.options.num_threads = request.options.tracking.num_threads = num_threads;
  CoverageTally tally;
  tally.drives = 1;
  try {
    NoMessages messages;
    (void)map_drives(request, messages);
  } catch (const Refused&) {
    tally.refused = 1;
    return tally;
  }
  tally.coverage = coverage_of(load_map(request.map), Drive::open(drive));
  return tally;
}

}  // namespace roadbook
