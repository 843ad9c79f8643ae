// Time and memory of the map pipeline by stage: build/.../bench/pipeline_study [DRIVE]
//
// Without a drive, simulates the small zurich in the folder for temporary files first. The
// real-time factor is the build's time over the recorded time: at most 1 keeps up with a driving
// car.

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "mapping/pipeline/build_map.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/simulate.hpp"

namespace {

namespace fs = std::filesystem;

fs::path simulated_drive(const fs::path& folder) {
  roadbook::SimulateOptions options;
  options.overwrite = true;
  const fs::path drive = folder / "drive";
  const auto made =
      roadbook::simulate(roadbook::load_scenario("zurich", {.size = "small"}), drive, options);
  std::printf("simulated %zu frames, %.1f m, %.3f s of CPU time a frame\n", made.frames,
              made.distance_m, made.render_cpu_s / static_cast<double>(made.frames));
  return drive;
}

void print(const roadbook::MapSummary& summary) {
  double total_s = 0.0;
  std::printf("%-24s %10s %14s\n", "stage", "seconds", "peak rss [MB]");
  for (const auto& stage : summary.stages) {
    std::printf("%-24s %10.2f %14.0f\n", stage.name.c_str(), stage.seconds, stage.peak_rss_mb);
    total_s += stage.seconds;
  }
  std::printf("%-24s %10.2f\n\n", "all", total_s);
  std::printf("%zu keyframes, %zu landmarks, loops %zu accepted, %zu rejected\n", summary.keyframes,
              summary.landmarks, summary.loops_accepted, summary.loops_rejected);
  std::printf("recorded %.1f s on %d threads: real-time factor %.2f\n", summary.drive_seconds,
              roadbook::thread_count(0), total_s / summary.drive_seconds);
  if (summary.ate_median_m && summary.ate_p95_m)
    std::printf("against truth: %.3f m median, %.3f m 95 %%\n", *summary.ate_median_m,
                *summary.ate_p95_m);
}

}  // namespace

int main(int count, char** words) {
  const fs::path folder = fs::temp_directory_path() / "roadbook_pipeline_study";
  try {
    fs::create_directories(folder);
    const fs::path drive = count > 1 ? fs::path(words[1]) : simulated_drive(folder);
    roadbook::MapOptions options;
    options.replace = true;
    print(roadbook::build_map({drive}, folder / "map.gpkg", options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    fs::remove_all(folder);
    return EXIT_FAILURE;
  }
  fs::remove_all(folder);
  return EXIT_SUCCESS;
}
