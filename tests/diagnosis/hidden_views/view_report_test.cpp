#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/run_command.hpp"
#include "tests/diagnosis/hidden_effects/seed_of_today.hpp"
#include "tests/diagnosis/hidden_views/view_injector.hpp"

// Report texts about the views of a map.

namespace roadbook::test {
namespace {

TEST(ViewReport, ImagesThatAreShiftedAreSaidInTextJsonAndPage) {
  HiddenViewOptions hidden;
  hidden.seed = seed_of_today();
  hidden.length_m = 120.0;
  hidden.images_shift_px = 1.0;
  const ScratchFolder folder;
  write_hidden_views(hidden, folder.path());
  const auto run =
      run_command("roadbook diagnose drive -m map.gpkg --json -o report.html", folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const nlohmann::json said = nlohmann::json::parse(run.out);
  const std::string line = "autocorrelation in cam1 (reprojection)";
  const auto& lines = said["unexplained"];
  EXPECT_NE(std::find(lines.begin(), lines.end(), line), lines.end()) << run.out;
  for (const char* camera : {"cam0", "cam1", "cam2", "cam3"})
    EXPECT_LT(said["checks"][camera]["reprojection"]["after"]["whiteness_p"], 1e-6) << camera;
  std::stringstream page;
  page << std::ifstream(folder.path() / "report.html").rdbuf();
  EXPECT_NE(page.str().find(line), std::string::npos);
}

TEST(ViewReport, SaysTheSameBytesOnAnyNumberOfThreads) {
  HiddenViewOptions hidden;
  hidden.length_m = 60.0;
  hidden.secret = {{"cam1.focal", 0.004}, {"ground.hinge", 0.01}};
  const ScratchFolder folder;
  write_hidden_views(hidden, folder.path());
  const std::string diagnose = "roadbook diagnose drive -m map.gpkg --json --threads ";
  const auto alone = run_command(diagnose + "1", folder.path());
  ASSERT_EQ(alone.status, 0) << alone.err;
  EXPECT_NE(alone.out.find("cam1.focal"), std::string::npos) << alone.out;
  for (const char* threads : {"2", "3"})
    EXPECT_EQ(run_command(diagnose + threads, folder.path()).out, alone.out) << threads;
}

}  // namespace
}  // namespace roadbook::test
