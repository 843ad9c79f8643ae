#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Returns the commands of the manual's ```sh blocks, in order.
std::vector<std::string> examples() {
  std::vector<std::string> commands;
  std::istringstream manual(
      test::read_text(fs::path(ROADBOOK_SOURCE_DIR) / "docs" / "reference" / "command_line.md"));
  bool inside = false;
  for (std::string line; std::getline(manual, line);) {
    if (line.rfind("```", 0) == 0)
      inside = line == "```sh";
    else if (inside && line.rfind("roadbook ", 0) == 0)
      commands.push_back(line);
  }
  return commands;
}

// A space next to the start of the drive, in the format that a GIS program writes.
constexpr const char* kSpaces = R"({"type":"FeatureCollection","features":[{"type":"Feature",
"properties":{"class":"parking_space"},"geometry":{"type":"Polygon","coordinates":[[
[8.5417398,47.3769270],[8.5418061,47.3769270],[8.5418061,47.3769495],[8.5417398,47.3769495],
[8.5417398,47.3769270]]]}}]})";

// Builds the map again. The new map keeps what `detect` learnt, and `detect` does not repeat its
// notes on images.
void expect_nothing_learnt_twice(const fs::path& folder) {
  const auto learnt = [&](const std::string& options) {
    const auto result =
        test::run_command("roadbook detect -m visit.gpkg --json --quiet " + options, folder);
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  };
  const auto before = learnt("");
  EXPECT_GT(before.at("answers"), 0);
  EXPECT_EQ(learnt("--oracle visit").at("answers"), before.at("answers"));
  const auto map = test::run_command("roadbook map visit -m visit.gpkg --replace --quiet", folder);
  ASSERT_EQ(map.status, 0) << map.err;
  const auto after = learnt("");
  EXPECT_EQ(after.at("answers"), before.at("answers"));
  EXPECT_GE(after.at("examples"), before.at("examples"));
}

// Runs the main task of the manual from end to end: one drive through all verbs. The median error
// against the simulation's truth must be below 5 cm, as promised for the map.
TEST(Manual, EveryExampleWorksFromTheDriveToTheReport) {
  const test::ScratchFolder folder;
  const auto commands = examples();
  ASSERT_GE(commands.size(), 9U);
  std::ofstream(folder.path() / "spaces.geojson") << kSpaces;
  for (const std::string& command : commands) {
    const auto result = test::run_command(command + " --json --quiet", folder.path());
    ASSERT_EQ(result.status, 0) << command << "\n" << result.err;
    const auto object = nlohmann::json::parse(result.out, nullptr, false);
    ASSERT_TRUE(object.is_object()) << command << "\n" << result.out;
    if (command.rfind("roadbook map drive ", 0) == 0) {
      EXPECT_GT(object.at("loops").at("accepted"), 0);
      EXPECT_EQ(object.at("scale").at("source"), "wheels");
      EXPECT_LT(object.at("truth").at("ate_median_m").get<double>(), 0.05);
      EXPECT_LT(object.at("truth").at("ate_p95_m").get<double>(), 0.10);
      EXPECT_EQ(object.at("digest").get<std::string>().size(), 64U);
    }
    if (command.rfind("roadbook roads ", 0) == 0) {
      EXPECT_GE(object.at("lanes"), 1);
      EXPECT_GE(object.at("coverage").get<double>(), 0.99);
    }
  }
  expect_nothing_learnt_twice(folder.path());
  const auto check = test::run_command("roadbook check place.gpkg", folder.path());
  EXPECT_EQ(check.status, 0) << check.err;
  for (const char* file : {"report.html", "poses.tum", "place.geojson", "overhead.tif",
                           "labels.json", "labels_yolo/labels/overhead.txt"})
    EXPECT_GT(fs::file_size(folder.path() / file), 0U) << file;
}

}  // namespace
}  // namespace roadbook
