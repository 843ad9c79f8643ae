#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::run_command;

constexpr double kRaisedM = 0.25;

// Map B: one pose of A is raised, the second session comes from another drive.
void write_two_maps(const std::filesystem::path& folder) {
  Map map = test::small_map(1, {.keyframes = 40});
  MapFileBuilder(folder / "a.gpkg", "a").finish(map, {});
  map.sessions[1].drive_digest = "another drive";
  map.keyframes[7].T_frame_vehicle.pretranslate(Eigen::Vector3d(0.0, 0.0, kRaisedM));
  MapFileBuilder(folder / "b.gpkg", "b").finish(map, {});
}

TEST(CompareVerb, TellsWhatDiffersAndWhere) {
  const test::ScratchFolder folder;
  write_two_maps(folder.path());
  const auto run = run_command("roadbook compare a.gpkg b.gpkg --json", folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json.at("sessions").at("both"), nlohmann::json({"drive 0"}));
  EXPECT_EQ(json.at("sessions").at("only_a"), nlohmann::json({"drive 1"}));
  EXPECT_EQ(json.at("poses").at("compared"), 40);
  const auto& worst = json.at("poses").at("worst");
  EXPECT_EQ(worst.at("session"), "drive 0");
  EXPECT_EQ(worst.at("t_ns"), 1'403'636'579'763'555'584 + 7 * std::int64_t{80'000'001});
  // The motion takes about a fortieth of it.
  EXPECT_NEAR(worst.at("distance_m").get<double>(), kRaisedM * 39.0 / 40.0, 0.02);
  EXPECT_TRUE(json.at("lanes").at("share_a").is_null());
  const auto lines = run_command("roadbook compare a.gpkg b.gpkg", folder.path());
  EXPECT_EQ(lines.status, 0);
  EXPECT_NE(lines.out.find("sessions: in both drive 0; only in A drive 1; only in B drive 1\n"),
            std::string::npos)
      << lines.out;
}

// The page needs no other file and no network; it has the numbers and marks the worst place.
TEST(CompareVerb, WritesOnePageWithBothMapsFromAbove) {
  const test::ScratchFolder folder;
  write_two_maps(folder.path());
  const auto run = run_command("roadbook compare a.gpkg b.gpkg -o page.html --json", folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json.at("page"), "page.html");
  EXPECT_TRUE(json.at("value").is_null());
  const std::string page = test::read_text(folder.path() / "page.html");
  for (const char* part : {"A: a.gpkg, B: b.gpkg", "class=\"track map-a\"", "class=\"track map-b\"",
                           "class=\"dot worst\"", "worst: 2", "drive 1</td><td>only in A"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_NE(page.find(">" + std::to_string(json.at("landmarks").at("moved").get<int>()) + " / "),
            std::string::npos);
  for (const char* part : {"http:", "https:", "<script", "src=", "@import"})
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  // A map is not overwritten by the page about it.
  const auto refused = run_command("roadbook compare a.gpkg b.gpkg -o b.gpkg", folder.path());
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
}

TEST(CompareVerb, TellsTheValueOfSessionsOnRequest) {
  const test::ScratchFolder folder;
  write_two_maps(folder.path());
  const auto run =
      run_command("roadbook compare a.gpkg b.gpkg --value -o page.html --json", folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const auto value = nlohmann::json::parse(run.out).at("value");
  for (const char* map : {"a", "b"}) {
    ASSERT_EQ(value.at(map).size(), 2U);
    EXPECT_EQ(value.at(map)[0].at("session"), "drive 0");
    EXPECT_EQ(value.at(map)[0].at("poses").at("count"), 40);
  }
  EXPECT_NE(test::read_text(folder.path() / "page.html").find("is worth to the others"),
            std::string::npos);
}

TEST(CompareVerb, MapsWithoutCommonPosesHaveNoNumbers) {
  const test::ScratchFolder folder;
  Map map = test::small_map(1);
  MapFileBuilder(folder.path() / "a.gpkg", "a").finish(map, {});
  for (Session& session : map.sessions) session.drive_digest += " of another year";
  MapFileBuilder(folder.path() / "b.gpkg", "b").finish(map, {});
  const auto run = run_command("roadbook compare a.gpkg b.gpkg --json", folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const auto poses = nlohmann::json::parse(run.out).at("poses");
  for (const char* key : {"median_m", "p95_m", "worst", "T_a_b"})
    EXPECT_TRUE(poses.at(key).is_null()) << key;
  const auto lines = run_command("roadbook compare a.gpkg b.gpkg", folder.path());
  EXPECT_NE(lines.out.find("poses: none in both, so places are not compared\n"), std::string::npos);
}

TEST(CompareVerb, WhatIsNoMapIsRefusedInOneLine) {
  const test::ScratchFolder folder;
  write_two_maps(folder.path());
  test::write_text(folder.path() / "text.gpkg", "no map");
  for (const char* pair : {"a.gpkg none.gpkg", "text.gpkg a.gpkg", "a.gpkg text.gpkg"}) {
    const auto run = run_command("roadbook compare " + std::string(pair), folder.path());
    EXPECT_EQ(run.status, 2) << pair;
    EXPECT_TRUE(run.out.empty());
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
}

}  // namespace
}  // namespace roadbook
