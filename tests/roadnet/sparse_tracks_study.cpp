#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "tests/roadnet/chicago.hpp"

// The Chicago tracks thinned to one position in 10, 20 and 30 s, from every fifth second on:
// sparse_tracks_study FOLDER, the folder with tracks_chicago.zip and maps_chicago.zip.
// Prints a row a network (docs/guide/roads.md).

namespace {

using namespace roadbook;

std::vector<test::Track> lines_of(const RoadNetwork& network) {
  std::vector<test::Track> lines;
  for (const Lane& lane : network.lanes) {
    lines.emplace_back();
    for (const Eigen::Vector3d& p : lane.centre) lines.back().push_back(p.head<2>());
  }
  return lines;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: sparse_tracks_study FOLDER\n");
    return EXIT_FAILURE;
  }
  constexpr double kNear_m = 20.0;
  constexpr int kTimes = 3;
  const std::filesystem::path folder = argv[1];
  const auto trips = test::chicago_trips(folder);
  const test::StreetMap map = test::chicago_streets(folder);
  const auto driven = driven_times(map, test::positions_of(trips));
  std::printf(
      "interval_s phase_s precision precision_driven recall found_km wanted_km coverage s\n");
  for (const double interval_s : {10.0, 20.0, 30.0})
    for (double phase_s = 0.0; phase_s < interval_s; phase_s += 5.0) {
      const auto passes = test::passes_of(test::thinned(trips, interval_s, phase_s));
      const auto begin = std::chrono::steady_clock::now();
      const RoadNetwork network = build_road_network(passes, RoadNetworkOptions::for_gps());
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      const auto score = score_streets(lines_of(network), map, driven, kTimes, kNear_m);
      std::printf("%.0f %.0f %.3f %.3f %.3f %.1f %.1f %.3f %.1f\n", interval_s, phase_s,
                  score.precision, score.precision_driven, score.recall, score.found_km,
                  score.wanted_km, network.coverage, took.count());
      std::fflush(stdout);
    }
  return EXIT_SUCCESS;
}
