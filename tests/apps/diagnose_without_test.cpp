#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

using test::run_command;
using test::ScratchFolder;

TEST(DiagnoseWithout, ANameThatIsNoEffectIsRefusedWithTheNearestOne) {
  const ScratchFolder folder;
  const auto refused = [&](const std::string& options, const std::string& line) {
    const auto result = run_command("roadbook diagnose drive " + options, folder.path());
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.err, line);
    EXPECT_EQ(result.out, "");
  };
  refused("--without imu0.gyro_scal",
          "error: --without: got imu0.gyro_scal, want a known effect; did you mean "
          "imu0.gyro_scale?\n");
  refused("--without imu0.gyro_bias --without wheel",
          "error: --without: got wheel, want an effect listed in docs/reference/effects.md\n");
  refused(
      "--without STREAM.outliers",
      "error: --without: got STREAM.outliers, want the noise of one stream: wheels0.outliers\n");
}

// The names are an effect of one camera, an effect of all cameras, and a stream's noise. The
// command accepts each name and then fails because the drive does not exist.
TEST(DiagnoseWithout, EveryKindOfNameThatEffectsHaveIsTaken) {
  const ScratchFolder folder;
  for (const char* name : {"imu0.gyro_scale", "cam2.focal", "cam.focal", "imu0.outliers",
                           "wheels0.variance(speed)", "map.landmarks_gone"}) {
    const auto result =
        run_command("roadbook diagnose drive --without '" + std::string(name) + "'", folder.path());
    EXPECT_NE(result.err.find("no such folder"), std::string::npos) << name << result.err;
  }
}

TEST(ListEffects, TheJsonHoldsTheBoundsOfEverySize) {
  const ScratchFolder folder;
  const auto result = run_command("roadbook diagnose --list-effects --json", folder.path());
  const auto effects = nlohmann::json::parse(result.out).at("effects");
  ASSERT_GT(effects.size(), 40U);
  for (const auto& e : effects)
    EXPECT_LT(e.at("lowest").get<double>(), e.at("highest").get<double>()) << e;
}

TEST(ListEffects, TheTextTellsPlausibleSizeBoundsAndCovariate) {
  const ScratchFolder folder;
  const std::string text = run_command("roadbook diagnose --list-effects", folder.path()).out;
  for (const char* line :
       {"wheels0.track_width [1]: plausible 0.05, bounds -0.5 to 1, grows with turn rate: ",
        "ground.height [m]: plausible 0.05, bounds -2 to 2, constant: "})
    EXPECT_NE(text.find(line), std::string::npos) << text;
}

}  // namespace
}  // namespace roadbook
