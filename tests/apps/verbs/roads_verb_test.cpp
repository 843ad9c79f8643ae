#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/driven_road.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

TEST(RoadsVerb, WarnsWhereLanesAreMissing) {
  const test::ScratchFolder folder;
  MapFileBuilder(folder.path() / "place.gpkg", "road")
      .finish(test::road_with_a_part_driven_once(40.0), {});
  const auto result =
      test::run_command("roadbook roads -m place.gpkg --min-passes 2 --json", folder.path());
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("warning: place.gpkg: coverage: got 0."), std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("no lane from ("), std::string::npos) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  // The lane covers 120 of 160 driven metres.
  EXPECT_NEAR(json.at("coverage").get<double>(), 0.75, 0.05);
  ASSERT_EQ(json.at("uncovered").size(), 1U);
  const auto& stretch = json.at("uncovered").at(0);
  EXPECT_EQ(stretch.at("passes"), 1);
  EXPECT_NEAR(stretch.at("driven_m").get<double>(), 37.0, 4.0);  // a reach belongs to the lane
  EXPECT_NEAR(stretch.at("to").at(0).get<double>(), 100.0, 2.0);
}

TEST(RoadsVerb, RefusesANetworkOfLessThanHalfOfWhatWasDriven) {
  const test::ScratchFolder folder;
  MapFileBuilder(folder.path() / "place.gpkg", "road")
      .finish(test::road_with_a_part_driven_once(400.0), {});
  const auto result =
      test::run_command("roadbook roads -m place.gpkg --min-passes 2", folder.path());
  EXPECT_EQ(result.status, 4);
  EXPECT_NE(result.err.find("error: place.gpkg: coverage: got 0."), std::string::npos)
      << result.err;
  EXPECT_EQ(test::run_command("roadbook roads -m place.gpkg", folder.path()).status, 0);
}

}  // namespace
}  // namespace roadbook
