#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/evaluation/hidden_drive.hpp"
#include "apps/evaluation/hidden_readings.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;
using test::run_command;

// Checks that a second diagnosis finds no effect when it uses the model that the first one wrote.
void expect_nothing_left(HiddenKind kind, const EffectSizes& effects) {
  const test::ScratchFolder folder;
  write_hidden_readings(folder.path() / "drive", 3, kind, effects);
  const auto first =
      run_command("roadbook diagnose drive --json --write-model model.yaml", folder.path());
  ASSERT_EQ(first.status, 0) << first.err;
  ASSERT_EQ(Json::parse(first.out)["causes"].size(), effects.size()) << first.out;
  const auto second = run_command(
      "roadbook diagnose drive --json --model model.yaml --write-model again.yaml", folder.path());
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(Json::parse(second.out)["causes"].size(), 0U) << second.out;
  EXPECT_EQ(test::read_text(folder.path() / "again.yaml"),
            test::read_text(folder.path() / "model.yaml"));
}

// The cases cover measurement errors and noise: of one stream, of two streams, and of two kinds in
// one stream.
TEST(DiagnosisAgain, OfMotionFindsNeitherEffectsNorNoiseBesideItsOwnModel) {
  const test::ScratchFolder folder;
  write_hidden_drive(folder.path() / "drive", 4, 300.0,
                     {{"imu0.gyro_bias", 0.004},
                      {"imu0.outliers", 0.05},
                      {"imu0.variance(turn)", 6.0},
                      {"wheels0.outliers", 0.06}});
  const auto first =
      run_command("roadbook diagnose drive --json --write-model model.yaml", folder.path());
  ASSERT_EQ(first.status, 0) << first.err;
  ASSERT_EQ(Json::parse(first.out)["causes"].size(), 4U) << first.out;
  // The second diagnosis also finds nothing in a drive that the simulation makes with that model.
  const auto made = run_command(
      "roadbook simulate zurich --size small --no-images --model model.yaml -o simulated",
      folder.path());
  ASSERT_EQ(made.status, 0) << made.err;
  for (const char* drive : {"drive", "simulated"}) {
    const auto second = run_command("roadbook diagnose " + std::string(drive) +
                                        " --json --model model.yaml --write-model again.yaml",
                                    folder.path());
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_EQ(Json::parse(second.out)["causes"].size(), 0U) << drive << second.out;
    EXPECT_EQ(Json::parse(second.out)["unknown"].size(), 0U) << drive << second.out;
    EXPECT_EQ(test::read_text(folder.path() / "again.yaml"),
              test::read_text(folder.path() / "model.yaml"));
  }
}

TEST(DiagnosisAgain, OfFrictionFindsNothingBesideItsOwnModel) {
  expect_nothing_left(HiddenKind::kFriction, {{"friction0.speed_bias", 0.01}});
}

TEST(DiagnosisAgain, OfRangesFindsNothingBesideItsOwnModel) {
  expect_nothing_left(HiddenKind::kRange, {{"range0.short", 0.1}});
  expect_nothing_left(HiddenKind::kRange, {{"range0.outliers", 0.06}, {"range0.correlation", 0.5}});
}

TEST(DiagnosisAgain, OfADetectorFindsNothingBesideItsOwnModel) {
  expect_nothing_left(HiddenKind::kDetector, {{"detector.foot_point", 0.3}});
}

}  // namespace
}  // namespace roadbook
