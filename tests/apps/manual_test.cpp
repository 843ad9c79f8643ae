#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "mapping/store/map_file_sqlite.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/apps/shared_drives.hpp"
#include "tests/support/map_file_document.hpp"

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

// Road works at the start of the drive.
constexpr const char* kWorks = R"({"type":"FeatureCollection","features":[{"type":"Feature",
"properties":{"kind":"road_works","observed_utc":"2024-05-17T08:30:00Z","half_life_s":1e9},
"geometry":{"type":"Point","coordinates":[8.5417,47.3769]}}]})";

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

// Returns the columns of a table, without those that every layer has.
std::vector<std::string> columns_of(const SqlDatabase& map, const std::string& table) {
  std::vector<std::string> columns;
  SqlStatement rows = map.prepare("SELECT name FROM pragma_table_info(?)");
  rows.bind_text(1, table);
  while (rows.step())
    if (rows.text(0) != "fid" && rows.text(0) != "geom") columns.push_back(rows.text(0));
  return columns;
}

// Returns the first column of the rows that `sql` gives.
std::set<std::string> names_of(const SqlDatabase& map, const std::string& sql) {
  std::set<std::string> names;
  SqlStatement rows = map.prepare(sql);
  while (rows.step()) names.insert(rows.text(0));
  return names;
}

// Removes from `missing` what the map has, and expects that the document tells the same columns.
void compare_with_document(const fs::path& file,
                           const test::MapFileDocument& document,
                           std::set<std::string>& missing) {
  const SqlDatabase map(file, SqlMode::kRead);
  const auto rasters =
      names_of(map,
               "SELECT table_name FROM gpkg_contents WHERE data_type LIKE '%tile%' OR "
               "data_type LIKE '%coverage%'");
  for (const std::string& raster : rasters)
    EXPECT_TRUE(document.rasters.contains(raster)) << raster;
  const auto tables =
      names_of(map,
               "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE "
               "'gpkg_%' AND name NOT LIKE 'rtree_%' AND name NOT LIKE 'sqlite_%'");
  for (const std::string& table : tables) {
    missing.erase(table);
    const auto columns = columns_of(map, table);
    if (rasters.contains(table) || columns == std::vector<std::string>{"source"}) continue;
    ASSERT_TRUE(document.columns.contains(table)) << table;
    EXPECT_EQ(document.columns.at(table), columns) << table;
  }
}

// Compares the reference of the map file with all maps that the manual's commands made.
void expect_documented_maps(const fs::path& folder) {
  // The examples import spaces after `roads`, and give no speed configuration.
  std::ofstream(folder / "speeds.yaml") << "max_speed_mps: 7\n";
  for (const char* command : {"roadbook roads -m place.gpkg --quiet",
                              "roadbook speeds -m place.gpkg --config speeds.yaml --quiet"}) {
    const auto result = test::run_command(command, folder);
    ASSERT_EQ(result.status, 0) << command << "\n" << result.err;
  }
  const auto document = test::read_map_file_document();
  std::set<std::string> missing = document.rasters;
  for (const auto& [name, columns] : document.columns) missing.insert(name);
  for (const char* map : {"place.gpkg", "road.gpkg", "visit.gpkg"})
    compare_with_document(folder / map, document, missing);
  // The manual draws no further kind of label and makes no edit. The other tables are those of the
  // label server: tests/apps/map_file_document_test.cpp compares them.
  EXPECT_EQ(missing, (std::set<std::string>{"box_examples", "label_learning", "label_sightings",
                                            "map_before_edits", "map_edits", "other_labels",
                                            "people_learning"}));
}

// Runs the main task of the manual from end to end: one drive through all verbs. The median error
// against the simulation's truth must be below 5 cm, as promised for the map.
TEST(Manual, EveryExampleWorksFromTheDriveToTheReport) {
  const test::ScratchFolder folder;
  const auto commands = examples();
  ASSERT_GE(commands.size(), 9U);
  std::ofstream(folder.path() / "spaces.geojson") << kSpaces;
  std::ofstream(folder.path() / "works.geojson") << kWorks;
  for (const std::string& command : commands) {
    // A quarter of the pixels shows the same.
    const bool is_overhead = command.rfind("roadbook overhead ", 0) == 0;
    const auto result = test::run_example(
        command, is_overhead ? " --resolution-m 0.1 --json --quiet" : " --json --quiet",
        folder.path());
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
  expect_documented_maps(folder.path());
  expect_nothing_learnt_twice(folder.path());
  const auto check = test::run_command("roadbook check place.gpkg", folder.path());
  EXPECT_EQ(check.status, 0) << check.err;
  for (const char* file : {"report.html", "poses.tum", "place.geojson", "overhead.tif",
                           "labels.json", "labels_yolo/labels/overhead.txt"})
    EXPECT_GT(fs::file_size(folder.path() / file), 0U) << file;
}

}  // namespace
}  // namespace roadbook
