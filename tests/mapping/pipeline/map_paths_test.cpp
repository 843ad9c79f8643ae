#include "mapping/pipeline/map_paths.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace roadbook {
namespace {

namespace fs = std::filesystem;

fs::path fresh_folder() {
  const fs::path folder = fs::canonical(fs::path(::testing::TempDir())) / "roadbook_map_paths";
  fs::remove_all(folder);
  for (const char* inner : {"maps", "drives/monday/cam0", "elsewhere"})
    fs::create_directories(folder / inner);
  return folder;
}

TEST(MapPaths, AreRelativeToTheMapsFolder) {
  const fs::path folder = fresh_folder();
  const fs::path map = folder / "maps" / "place.gpkg";
  EXPECT_EQ(path_from_map(folder / "drives" / "monday", map), "../drives/monday");
  EXPECT_EQ(path_from_map(folder / "maps" / "drive" / "", map), "drive");
  EXPECT_EQ(path_from_map(map, map), "place.gpkg");
  EXPECT_EQ(path_from_map("drive", "place.gpkg"), "drive");
  EXPECT_EQ(path_from_map("../drive", "place.gpkg"), "../drive");
  // A map that is a link lies where the link leads.
  std::ofstream(folder / "elsewhere" / "real.gpkg") << "map";
  fs::create_symlink(folder / "elsewhere" / "real.gpkg", map);
  EXPECT_EQ(path_from_map(folder / "elsewhere" / "drive", map), "drive");
}

TEST(MapPaths, KeepALinkBelowTheMapAndFollowOneThatAPathLeaves) {
  const fs::path folder = fresh_folder();
  const fs::path map = folder / "maps" / "place.gpkg";
  fs::create_directory_symlink(folder / "drives" / "monday", folder / "maps" / "link");
  EXPECT_EQ(path_from_map(folder / "maps" / "link", map), "link");
  EXPECT_EQ(path_from_map(folder / "maps" / "link" / ".." / "monday", map), "../drives/monday");
}

TEST(MapPaths, OfProblemsNameNoFolderOfTheMachine) {
  const fs::path folder = fresh_folder();
  const fs::path drive = folder / "drives" / "monday";
  const auto stored = [&](const fs::path& file, const fs::path& map) {
    return problems_from_map({{Severity::kWarning, file.string(), 7, "image", "none", "one"}},
                             {drive}, map)
        .front();
  };
  const fs::path near = folder / "maps" / "place.gpkg";
  EXPECT_EQ(to_line(stored(drive / "cam0" / "data.csv", near)),
            "warning: ../drives/monday/cam0/data.csv:7: image: got none, want one");
  // Nothing but the root is shared: the names of folders on the way stay out.
  const fs::path far = "/no_such_folder/maps/place.gpkg";
  EXPECT_EQ(stored(drive / "cam0" / "data.csv", far).file, "monday/cam0/data.csv");
  EXPECT_EQ(stored(drive, far).file, "monday");
  EXPECT_EQ(stored(folder / "elsewhere" / "vehicle.yaml", far).file, "vehicle.yaml");
  EXPECT_EQ(stored("", far).file, "");
}

}  // namespace
}  // namespace roadbook
