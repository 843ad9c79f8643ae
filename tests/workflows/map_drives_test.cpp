#include "workflows/map_drives.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mapping/store/map_file.hpp"
#include "sim/simulate.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/workflows/recorded_messages.hpp"
#include "tests/workflows/thrown_problem.hpp"

namespace roadbook {
namespace {

TEST(MapDrives, BuildsTheMapOfTheVerb) {
  const test::ScratchFolder folder;
  SimulateOptions drive;
  drive.max_duration_s = 5.0;
  (void)simulate(load_scenario("zurich", {"small", 0, 0.25}), folder.path() / "drive", drive);
  MapRequest request;
  request.drives = {folder.path() / "drive"};
  request.map = folder.path() / "place.gpkg";

  test::RecordedMessages stopped("odometry");
  EXPECT_THROW((void)map_drives(request, stopped), Interrupted);
  EXPECT_FALSE(std::filesystem::exists(request.map));

  test::RecordedMessages messages;
  const MapResult made = map_drives(request, messages);
  EXPECT_GT(made.summary.keyframes, 20U);
  EXPECT_FALSE(made.summary.is_unchanged);
  EXPECT_GE(messages.stages.size(), 2U);
  EXPECT_TRUE(messages.notes.empty());

  const auto verb = test::run_command("roadbook map drive -m verb.gpkg -q --json", folder.path());
  ASSERT_EQ(verb.status, 0) << verb.err;
  const auto json = nlohmann::json::parse(verb.out);
  EXPECT_EQ(json.at("digest"), made.summary.digest);
  EXPECT_EQ(json.at("keyframes"), made.summary.keyframes);
  EXPECT_EQ(map_digest(request.map), map_digest(folder.path() / "verb.gpkg"));

  EXPECT_TRUE(map_drives(request, messages).summary.is_unchanged);
}

TEST(MapDrives, ThrowsTheFieldOfTheInputThatItCannotUse) {
  const test::ScratchFolder folder;
  MapRequest request;
  request.drives = {folder.path() / "none"};
  request.map = folder.path() / "place.gpkg";
  test::RecordedMessages messages;
  const Problem no_drive = test::thrown_problem([&] { (void)map_drives(request, messages); });
  EXPECT_EQ(no_drive.severity, Severity::kError);
  EXPECT_EQ(no_drive.file, (folder.path() / "none").string());
  EXPECT_FALSE(no_drive.want.empty());

  test::write_text(folder.path() / "model.yaml", "effects:\n  wheels0.radius: large\n");
  request.model = folder.path() / "model.yaml";
  const Problem bad_size = test::thrown_problem([&] { (void)map_drives(request, messages); });
  EXPECT_EQ(bad_size.file, request.model.string());
  EXPECT_EQ(bad_size.line, 2);
  EXPECT_NE(bad_size.field.find("wheels0.radius"), std::string::npos) << bad_size.field;
  EXPECT_FALSE(std::filesystem::exists(request.map));
}

}  // namespace
}  // namespace roadbook
