#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "sim/simulate.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {

// Runs `roadbook simulate zurich --no-images --effect ...` for one lap and diagnoses the files.
inline Diagnosis simulated_and_diagnosed(const EffectSizes& secret, std::uint64_t seed) {
  const TemporaryFolder folder;
  Scenario scenario = load_scenario("zurich", {});
  scenario.ground.texel_m = 0.1;  // coarse: no images are rendered
  SimulateOptions options;
  options.effects = secret;
  options.seed = seed;
  options.images = false;
  (void)simulate(scenario, folder.path() / "drive", options);
  std::filesystem::remove_all(folder.path() / "drive" / "truth");
  const Drive drive = Drive::open(folder.path() / "drive");
  return diagnose(motion_streams(drive), "drive");
}

}  // namespace roadbook::test
