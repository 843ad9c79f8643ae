#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.hpp"
#include "sim/simulate.hpp"
#include "tests/support/expect_words.hpp"

// The simulation refuses effects that would not change a drive: its truth would list an effect that
// the data does not contain.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// A place with a coarse texture, so that the simulation is fast.
Scenario quick_place(const std::string& name) {
  ScenarioOptions options;
  options.size = "small";
  Scenario scenario = load_scenario(name, options);
  scenario.ground.texel_m = 2.0;
  return scenario;
}

fs::path drive_of_test() {
  const char* test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  return fs::path(::testing::TempDir()) / (std::string("roadbook_useful_") + test);
}

// Returns the bytes that a drive without images records. An empty result means a refusal, with the
// reason in `why`.
std::string recorded_bytes(const Scenario& scenario, SimulateOptions how, std::string& why) {
  how.images = false;
  how.overwrite = true;
  if (how.max_duration_s == 0.0) how.max_duration_s = 10.0;
  const fs::path folder = drive_of_test();
  try {
    simulate(scenario, folder, how);
  } catch (const BadInput& refused) {
    why = refused.what();
    return {};
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != "effects.json")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string bytes;
  for (const fs::path& file : files) {
    std::ifstream in(file, std::ios::binary);
    bytes += file.filename().string() + "\n";
    bytes.append(std::istreambuf_iterator<char>(in), {});
  }
  return bytes;
}

std::string refusal_of(const std::string& place, const std::string& effect, double size) {
  SimulateOptions how;
  how.effects = {{effect, size}};
  std::string why = "accepted";
  static_cast<void>(recorded_bytes(quick_place(place), how, why));
  return why;
}

double size_to_try(const EffectInfo& e) { return std::min(e.plausible, e.highest); }

TEST(UsefulEffects, OfTheWholeCatalogueNoneIsAcceptedThatChangesNothing) {
  const Scenario road = quick_place("road");
  std::string why;
  const std::string nominal = recorded_bytes(road, {}, why);
  ASSERT_FALSE(nominal.empty()) << why;
  int accepted = 0;
  for (const EffectInfo& e : all_effects()) {
    std::string name(e.name);
    if (name.starts_with("STREAM")) name = "imu0" + name.substr(6);
    // A scanner and a detector record only on request. For sensors that always record, one effect
    // each is enough.
    const bool asked_for = name.starts_with("range0") || name.starts_with("detector");
    const bool shown =
        name.starts_with("wheels0") || name.starts_with("imu0") || name.starts_with("steering0");
    if (asked_for || (shown && name != "wheels0.wet_patch" && name != "imu0.outliers")) continue;
    SimulateOptions how;
    how.effects = {{name, size_to_try(e)}};
    const std::string bytes = recorded_bytes(road, how, why);
    if (bytes.empty()) continue;
    ++accepted;
    EXPECT_NE(bytes, nominal) << name;
  }
  EXPECT_GT(accepted, 8);
}

TEST(UsefulEffects, WithoutImagesThoseOfImagesAreRefused) {
  for (const char* effect : {"cam.focal", "cam2.rotation", "cam.exposure", "cam.latency",
                             "ground.height", "map.moved_landmarks", "map.landmarks_gone"})
    test::expect_words(refusal_of("stuttgart", effect, 0.1),
                       "effects: got " + std::string(effect) + ", want images");
  EXPECT_EQ(refusal_of("stuttgart", "ground.slope", 0.02), "accepted");
  EXPECT_EQ(refusal_of("stuttgart", "map.scale", 0.01), "accepted");
  EXPECT_EQ(refusal_of("stuttgart", "cam.focal", 0.0), "accepted");
}

TEST(UsefulEffects, APuddleThatNobodyMeetsChangesNothing) {
  test::expect_words(refusal_of("stuttgart", "wheels0.wet_patch", 0.05),
                     "effects: got wheels0.wet_patch, want an effect that changes a reading");
}

// A range scanner measures objects that moved, so the simulation accepts the effect without images.
TEST(UsefulEffects, AScannerShowsWhatMovedWithoutImages) {
  const Scenario place = quick_place("stuttgart");
  SimulateOptions how;
  how.ranges = true;
  std::string why;
  const std::string nominal = recorded_bytes(place, how, why);
  how.effects = {{"map.moved_landmarks", 0.5}};
  const std::string moved = recorded_bytes(place, how, why);
  EXPECT_FALSE(moved.empty()) << why;
  EXPECT_NE(moved, nominal);
}

}  // namespace
}  // namespace roadbook
