#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"
#include "sim/simulate.hpp"
#include "tests/pipeline/map_judge.hpp"

namespace roadbook::test {

/// Three visits of the small car park, with other parked cars and other drivers, rendered once for
/// all tests of the suite.
class Visits : public ::testing::Test {
 protected:
  static const std::filesystem::path& folder() {
    static const std::filesystem::path folder = fresh_folder("visits");
    return folder;
  }
  static const std::vector<std::filesystem::path>& drives() {
    static const std::vector<std::filesystem::path> drives = render();
    return drives;
  }
  /// The map `together.gpkg` of all visits, built from their recordings at once.
  static const MapSummary& together() {
    static const MapSummary summary = build_map(drives(), folder() / "together.gpkg", {});
    return summary;
  }
  /// A copy of the map of the first visit alone, which is built once.
  static std::filesystem::path map_of_first(const std::string& name) {
    static const std::filesystem::path first = [] {
      const auto file = folder() / "first.gpkg";
      static_cast<void>(build_map({drives()[0]}, file, {}));
      return file;
    }();
    const auto copy = folder() / name;
    std::filesystem::copy_file(first, copy, std::filesystem::copy_options::overwrite_existing);
    return copy;
  }

 private:
  static std::vector<std::filesystem::path> render() {
    std::vector<std::filesystem::path> drives;
    for (int visit = 0; visit < 3; ++visit) {
      ScenarioOptions options;
      options.size = "small";
      options.visit = visit;
      options.image_scale = 0.5;
      drives.push_back(folder() / ("visit" + std::to_string(visit)));
      SimulateOptions drive;
      // The first one passes a place twice, and the others stay within what it saw.
      drive.max_duration_s = visit == 0 ? 18.0 : 12.0;
      simulate(load_scenario("zurich", options), drives.back(), drive);
    }
    return drives;
  }
};

}  // namespace roadbook::test
