#include <gtest/gtest.h>

#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/driven_road.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/workflows/recorded_messages.hpp"
#include "tests/workflows/thrown_problem.hpp"
#include "workflows/find_roads.hpp"
#include "workflows/make_speeds.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// The map of a road that two sessions drove, once for the library and once for the verb.
class MappedRoad : public ::testing::Test {
 protected:
  MappedRoad() {
    for (const fs::path& map : {map_, verb_map_})
      MapFileBuilder(map, "inputs").finish(test::driven_road(), {});
  }
  [[nodiscard]] RoadsRequest roads() const {
    RoadsRequest request;
    request.map = map_;
    return request;
  }
  [[nodiscard]] SpeedsRequest speeds() const {
    SpeedsRequest request;
    request.map = map_;
    return request;
  }
  void run_verb(const std::string& arguments) const {
    const auto result =
        test::run_command("roadbook " + arguments + " -m verb.gpkg -q", folder_.path());
    ASSERT_EQ(result.status, 0) << result.err;
  }

  const test::ScratchFolder folder_;
  const fs::path map_ = folder_.path() / "place.gpkg";
  const fs::path verb_map_ = folder_.path() / "verb.gpkg";
};

TEST_F(MappedRoad, FindRoadsStoresTheLanesOfTheVerb) {
  test::RecordedMessages messages;
  const RoadsResult result = find_roads(roads(), messages);
  ASSERT_EQ(result.network.lanes.size(), 1U);
  EXPECT_NEAR(result.network.lanes.front().length_m, 60.0, 1.0);
  EXPECT_TRUE(messages.warnings.empty());
  run_verb("roads");
  EXPECT_EQ(map_digest(map_), map_digest(verb_map_));
}

TEST_F(MappedRoad, FindRoadsWarnsThroughMessagesAndRefuses) {
  MapFileBuilder(map_, "inputs").finish(test::road_with_a_part_driven_once(40.0), {});
  RoadsRequest request = roads();
  request.options.min_passes = 2;
  test::RecordedMessages messages;
  (void)find_roads(request, messages);
  ASSERT_FALSE(messages.warnings.empty());
  EXPECT_EQ(messages.warnings.front().field, "coverage");
  EXPECT_EQ(messages.warnings.front().severity, Severity::kWarning);

  const std::string before = map_digest(map_);
  request.options.min_passes = 100;
  EXPECT_THROW((void)find_roads(request, messages), Refused);
  EXPECT_EQ(map_digest(map_), before);
}

TEST_F(MappedRoad, MakeSpeedsStoresTheSpeedsOfTheVerb) {
  (void)find_roads(roads(), NoMessages());
  run_verb("roads");
  std::string table = "#timestamp [ns],x [m],y [m],sigma [m],probability [-]\n";
  for (int i = 0; i < 20; ++i)
    table +=
        std::to_string(std::int64_t{1'600'000'011'000'000'000} + i * std::int64_t{100'000'000}) +
        "," + std::to_string(8.0 - 0.2 * i) + ",0.5,0.2,0.95\n";
  test::write_text(folder_.path() / "people.csv", table);
  SpeedsRequest request = speeds();
  request.detections = {folder_.path() / "people.csv"};
  request.observed = {"visit1"};
  const SpeedsResult result = make_speeds(request);
  EXPECT_EQ(result.taken.tables.added, 20U);
  ASSERT_EQ(result.visits.size(), 2U);
  EXPECT_EQ(result.visits.front().people, 20U);
  EXPECT_GT(result.presence_max, 0.2);
  EXPECT_EQ(result.digest, load_meta(map_).digest);
  run_verb("speeds --detections people.csv --observed visit1");
  EXPECT_EQ(map_digest(map_), map_digest(verb_map_));
}

TEST_F(MappedRoad, MakeSpeedsThrowsTheFieldOfTheInputThatItCannotUse) {
  const std::string before = map_digest(map_);
  EXPECT_FALSE(test::thrown_problem([&] { (void)make_speeds(speeds()); }).field.empty())
      << "the map has no lanes yet";
  EXPECT_EQ(map_digest(map_), before);

  (void)find_roads(roads(), NoMessages());
  SpeedsRequest request = speeds();
  request.observed = {"no such visit"};
  EXPECT_EQ(test::thrown_problem([&] { (void)make_speeds(request); }).field, "--observed");
  test::write_text(folder_.path() / "speeds.yaml", "caution: 1\nmax_speed_mps: fast\n");
  request = speeds();
  request.config = folder_.path() / "speeds.yaml";
  const Problem bad = test::thrown_problem([&] { (void)make_speeds(request); });
  EXPECT_EQ(bad.line, 2);
  EXPECT_EQ(bad.field, "max_speed_mps");
}

}  // namespace
}  // namespace roadbook
