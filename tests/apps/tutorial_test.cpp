#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apps/run_command.hpp"
#include "tests/apps/shared_drives.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

const fs::path kTutorial = fs::path(ROADBOOK_SOURCE_DIR) / "docs" / "tutorial.md";

// Returns the lines of the page's code blocks in one language, a string for each block.
std::vector<std::string> blocks_of(const std::string& language) {
  std::vector<std::string> blocks;
  std::istringstream page(test::read_text(kTutorial));
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("```", 0) == 0) {
      inside = !inside && line == "```" + language;
      if (inside) blocks.emplace_back();
    } else if (inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

std::vector<std::string> commands() {
  std::vector<std::string> lines;
  for (const std::string& block : blocks_of("sh")) {
    std::istringstream text(block);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
  }
  return lines;
}

// Makes a recording as a user has it: images and readings, but neither truth nor measures of the
// vehicle. It holds the first half of the drive.
void make_recording(const fs::path& drive, const fs::path& recording) {
  fs::create_directories(recording / "mav0");
  for (const char* sensor : {"cam0", "cam1", "cam2", "cam3", "wheels0", "imu0"}) {
    fs::copy(drive / sensor, recording / "mav0" / sensor, fs::copy_options::recursive);
    const std::string rows = test::read_text(drive / sensor / "data.csv");
    test::write_text(recording / "mav0" / sensor / "data.csv",
                     rows.substr(0, rows.find('\n', rows.size() / 2) + 1));
  }
}

// The server of the labelling page would wait for a page. With these options, it ends at once. An
// overhead image of a quarter of the pixels is enough for what follows.
std::string as_test(const std::string& command) {
  if (command.rfind("roadbook label ", 0) == 0) return command + " --port 0 --idle-s 1";
  if (command.rfind("roadbook overhead ", 0) == 0) return command + " --resolution-m 0.1";
  return command;
}

TEST(Tutorial, EveryCommandWorksInItsOrder) {
  const test::ScratchFolder folder;
  const std::vector<std::string> vehicle = blocks_of("yaml");
  ASSERT_EQ(vehicle.size(), 1U);
  ASSERT_GE(commands().size(), 20U);
  for (const std::string& command : commands()) {
    ASSERT_EQ(command.rfind("roadbook ", 0), 0U) << command;
    if (command.rfind("roadbook import ", 0) == 0)
      make_recording(folder.path() / "monday", folder.path() / "recording");
    if (command.rfind("roadbook map mine ", 0) == 0)
      test::write_text(folder.path() / "mine" / "vehicle.yaml", vehicle.front());
    const auto result = test::run_example(as_test(command), " --quiet", folder.path());
    ASSERT_EQ(result.status, 0) << command << "\n" << result.err;
    if (command.rfind("roadbook map mine ", 0) == 0) {
      EXPECT_NE(result.out.find("own vehicle: from vehicle.yaml"), std::string::npos) << result.out;
    }
  }
  for (const char* file : {"place.gpkg", "place.xodr", "place.osm", "nav2_keepout.pgm",
                           "report.html", "mine.gpkg", "mine_paths.csv", "mine.html"})
    EXPECT_GT(fs::file_size(folder.path() / file), 0U) << file;
}

}  // namespace
}  // namespace roadbook
