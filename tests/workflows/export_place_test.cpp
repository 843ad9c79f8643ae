#include "workflows/export_place.hpp"

#include <gtest/gtest.h>

#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/driven_road.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/workflows/recorded_messages.hpp"
#include "tests/workflows/thrown_problem.hpp"
#include "workflows/find_roads.hpp"

namespace roadbook {
namespace {

TEST(ExportPlace, WritesTheFileOfTheVerb) {
  const test::ScratchFolder folder;
  ExportRequest request;
  request.map = folder.path() / "place.gpkg";
  MapFileBuilder(request.map, "inputs").finish(test::driven_road(), {});
  RoadsRequest roads;
  roads.map = request.map;
  (void)find_roads(roads, NoMessages());

  request.format = "path";
  request.output = folder.path() / "lanes.json";
  EXPECT_TRUE(labels_without_place(request).empty());
  const ExportResult result = export_place(request);
  EXPECT_EQ(result.files, std::vector<std::filesystem::path>{request.output});
  EXPECT_TRUE(result.warnings.empty());
  const auto verb =
      test::run_command("roadbook export -m place.gpkg -f path -o verb.json -q", folder.path());
  ASSERT_EQ(verb.status, 0) << verb.err;
  EXPECT_EQ(test::read_text(request.output), test::read_text(folder.path() / "verb.json"));

  request.format = "geojson";
  EXPECT_EQ(test::thrown_problem([&] { (void)export_place(request); }).field, "origin");
  request.format = "paths";
  EXPECT_EQ(test::thrown_problem([&] { (void)export_place(request); }).got, "paths");
  request.format = "path";
  request.output = folder.path() / "none" / "lanes.json";
  EXPECT_THROW((void)export_place(request), StorageError);
}

}  // namespace
}  // namespace roadbook
