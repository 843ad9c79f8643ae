#include <gtest/gtest.h>

#include <sstream>

#include "tests/apps/run_command.hpp"

// Tests which libraries the program loads: each costs time at every start.

namespace roadbook {
namespace {

// The libraries that the loader initialises in a run, late ones included.
std::vector<std::string> libraries_loaded(const std::string& command,
                                          const std::filesystem::path& folder) {
  const test::CommandResult run = test::run_command("LD_DEBUG=libs " + command, folder);
  EXPECT_EQ(run.status, 0) << run.err;
  std::vector<std::string> libraries;
  std::istringstream lines(run.err);
  for (std::string line; std::getline(lines, line);)
    if (const auto at = line.find("calling init: "); at != std::string::npos)
      libraries.push_back(std::filesystem::path(line.substr(at + 14)).filename());
  return libraries;
}

bool holds(const std::vector<std::string>& libraries, const std::string& begin) {
  return std::any_of(libraries.begin(), libraries.end(),
                     [&](const std::string& name) { return name.starts_with(begin); });
}

// GDAL, image files and videos bring 210 more libraries and a tenth of a second.
TEST(Start, LoadsFewLibraries) {
  if (!ROADBOOK_LATE_LIBRARIES) GTEST_SKIP() << "this build is linked with all libraries";
  const test::ScratchFolder folder;
  const auto libraries = libraries_loaded("roadbook --version", folder.path());
  EXPECT_TRUE(holds(libraries, "libopencv_core")) << "the loader's words have changed";
  EXPECT_LT(libraries.size(), 70U);
  for (const char* late : {"libgdal", "libopencv_imgcodecs", "libopencv_videoio", "libavcodec"})
    EXPECT_FALSE(holds(libraries, late)) << late;
}

}  // namespace
}  // namespace roadbook
