// Road network from the Chicago tracks, compared with OpenStreetMap: see bench/README.md.
//   road_network_study ROAD_TRACKS_FOLDER [REACH_M [MIN_PASSES [PICTURE.svg]]]

#include <chrono>
#include <cstdlib>
#include <iostream>

#include "bench/road_network_svg.hpp"
#include "tests/roadnet/chicago.hpp"

int main(int argc, char** argv) {
  using namespace roadbook;
  if (argc < 2) {
    std::cerr
        << "usage: road_network_study ROAD_TRACKS_FOLDER [REACH_M [MIN_PASSES [PICTURE.svg]]]\n";
    return 1;
  }
  const std::filesystem::path folder = argv[1];
  const auto passes = test::chicago_passes(folder);
  const auto reference = test::chicago_reference(folder);
  RoadNetworkOptions options = RoadNetworkOptions::for_gps();
  if (argc > 2) options.reach_m = std::atof(argv[2]);
  if (argc > 3) options.min_passes = std::atoi(argv[3]);
  const auto begin = std::chrono::steady_clock::now();
  const RoadNetwork network = build_road_network(passes, options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::cout << "passes " << passes.size() << ", lanes " << network.lanes.size()
            << ", intersections " << network.intersections.size() << ", length "
            << network.length_m / 1000.0 << " km, coverage " << network.coverage << ", loops "
            << network.cycle_rank << ", parts " << network.components << ", " << seconds.count()
            << " s\n";
  for (const std::size_t driven : {std::size_t{1}, std::size_t{3}, std::size_t{6}}) {
    const auto score = test::compare_by_length(network, reference, passes, 15.0, driven);
    std::cout << "streets driven at least " << driven << " times: " << score.reference_km
              << " km, precision " << score.precision << ", recall " << score.recall << "\n";
  }
  if (argc > 4) test::write_network_svg(argv[4], network, reference, 15.0, 4.0);
  return 0;
}
