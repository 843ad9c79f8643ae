#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/apps/verbs/short_place.hpp"

// `roadbook localise` as a user runs it, on short drives.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

test::CommandResult localise(const std::string& arguments) {
  return test::run_command("roadbook localise " + arguments + " -q",
                           test::Place::of_all_tests().folder.path());
}

std::string text_in(const std::string& name) {
  return test::read_text(test::Place::of_all_tests().folder.path() / name);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(LocaliseVerb, WritesTrajectoryTableAndPictureAndLeavesTheMapAsItIs) {
  const std::string before = text_in("a.gpkg");
  const auto result = localise(
      "b -m a.gpkg -o b.tum --frames b.csv --picture b.svg --json --start 0,0,0 --predicted");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(text_in("a.gpkg") == before);
  const auto json = nlohmann::json::parse(result.out);
  for (const char* key : {"frames", "localised", "predicted", "lost", "relocalised", "inliers",
                          "cpu_ms", "jumps_m", "map_digest", "sessions_used", "truth"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json.at("sessions_used"), nlohmann::json({"a"}));
  // The later visit drives on beyond the end of the map.
  EXPECT_GT(json.at("localised").get<int>(), 0.6 * json.at("frames").get<int>());
  EXPECT_LT(json.at("truth").at("median_m").get<double>(), 0.05);
  const auto table = lines_of(text_in("b.csv"));
  ASSERT_EQ(table.size(), json.at("frames").get<std::size_t>() + 1);
  const auto columns = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  for (const std::string& line : table) EXPECT_EQ(columns(line), columns(table.front())) << line;
  EXPECT_EQ(lines_of(text_in("b.tum")).size(),
            json.at("localised").get<std::size_t>() + json.at("predicted").get<std::size_t>());
  EXPECT_EQ(text_in("b.svg").rfind("<svg", 0), 0U);
}

TEST(LocaliseVerb, SaysThatTheMapHasTheDriveItself) {
  const auto result = localise("a -m a.gpkg -o a.tum");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.err.find("warning: a: drive: got session a of the map itself"),
            std::string::npos)
      << result.err;
}

TEST(LocaliseVerb, TooFewFramesEndWithStatusFourAndTheFilesAreWritten) {
  const auto result = localise("b -m a.gpkg -o lost.tum --frames lost.csv --no-relocalise");
  EXPECT_EQ(result.status, 4);
  EXPECT_NE(result.err.find("error: a.gpkg: b: got 0 of "), std::string::npos) << result.err;
  EXPECT_TRUE(text_in("lost.tum").empty());
  const auto table = lines_of(text_in("lost.csv"));
  ASSERT_GT(table.size(), 2U);
  EXPECT_NE(table[1].find(",lost,,,,"), std::string::npos) << table[1];
  // The later visit drives on beyond the end of the map.
  const auto wanted = localise("b -m a.gpkg -o want.tum --start 0,0,0 --want 1.0 --sessions a");
  EXPECT_EQ(wanted.status, 4);
  EXPECT_NE(wanted.err.find("frames localised, want 100.0 % of them (--want)"), std::string::npos)
      << wanted.err;
  EXPECT_GT(lines_of(text_in("want.tum")).size(), 40U);
}

TEST(LocaliseVerb, BadInputIsNamedInOneLine) {
  const auto expect_line = [](const std::string& arguments, int status, const std::string& line) {
    const auto result = localise(arguments);
    EXPECT_EQ(result.status, status) << arguments;
    EXPECT_EQ(result.err.rfind(line, 0), 0U) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  expect_line("b -m a.gpkg -o b.tum --start 1,2", 1, "error: --start: got 1,2, want X,Y,HEADING");
  expect_line("b -m a.gpkg -o b.tum --start 900,0,0", 1, "error: --start: got 900.00,0.00");
  expect_line("b -m a.gpkg -o b.tum --sessions nobody", 1, "error: --sessions: got nobody, want a");
  expect_line("b -m a.gpkg -o a.gpkg", 1, "error: --output: got");
  expect_line("b -m nothing.gpkg -o b.tum", 2, "error: nothing.gpkg");
  expect_line("nothing -m a.gpkg -o b.tum", 2, "error: nothing");
}

}  // namespace
}  // namespace roadbook
