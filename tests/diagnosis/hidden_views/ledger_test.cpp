#include <gtest/gtest.h>

#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/diagnosis/hidden_views/view_injector.hpp"

// Repeats runs of diagnose from the ledger of a map.

namespace roadbook::test {
namespace {

// Moves poses and landmarks slightly, as a further session does; the ledger stays.
void build_anew(const std::filesystem::path& file) {
  Map map = load_map(file);
  for (MapFrame& frame : map.map_frames) frame.T_map_frame.translation() *= 1.001;
  for (Landmark& landmark : map.landmarks) landmark.p_frame *= 1.001;
  MapFileBuilder(file, "anew").finish(map, {});
}

TEST(Ledger, OfAMapThatHasOtherLandmarksNowARunThroughItSaysSo) {
  HiddenViewOptions hidden;
  hidden.seed = 301;
  hidden.length_m = 60.0;
  hidden.secret["cam1.rotation"] = 0.01;
  const ScratchFolder folder;
  write_hidden_views(hidden, folder.path());
  const auto kept = run_command("roadbook diagnose drive -m map.gpkg --keep", folder.path());
  ASSERT_EQ(kept.status, 0) << kept.err;
  const auto same = run_command("roadbook diagnose -m map.gpkg --again 1", folder.path());
  ASSERT_EQ(same.status, 0) << same.err;
  build_anew(folder.path() / "map.gpkg");
  const auto other = run_command("roadbook diagnose -m map.gpkg --again 1", folder.path());
  EXPECT_EQ(other.status, 4) << other.err;
  EXPECT_NE(other.err.find("poses or landmarks of the map have changed"), std::string::npos)
      << other.err;
}

}  // namespace
}  // namespace roadbook::test
