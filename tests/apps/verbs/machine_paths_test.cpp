#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "mapping/store/map_file.hpp"
#include "tests/apps/run_command.hpp"

// A map is given to others and put on other machines. It must not tell where it was made.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

class MachinePaths : public ::testing::Test {
 protected:
  // Two visits, the first with damage that a map of it warns of: an image is missing.
  MachinePaths() {
    for (const std::string visit : {"0", "1"})
      run("simulate zurich --size small --visit " + visit +
          " --max-duration-s 6 --image-scale 0.5 -o " + path("visit" + visit));
    for (const auto& entry : fs::directory_iterator(folder_.path() / "visit0" / "cam1" / "data")) {
      fs::remove(entry.path());
      break;
    }
  }
  // Verbs get absolute paths: the way in which they could reach the map.
  [[nodiscard]] std::string path(const std::string& name) const {
    return (fs::canonical(folder_.path()) / name).string();
  }
  void run(const std::string& arguments) const {
    const auto result = test::run_command("roadbook " + arguments + " -q", fs::current_path());
    EXPECT_EQ(result.status, 0) << arguments << ": " << result.err;
  }
  void expect_no_machine_in(const std::string& file) const {
    const std::string bytes = test::read_text(path(file));
    EXPECT_EQ(bytes.find(folder_.path().string()), std::string::npos);
    EXPECT_EQ(bytes.find(path("")), std::string::npos);
    EXPECT_EQ(bytes.find(fs::canonical(folder_.path()).filename().string()), std::string::npos);
    const char* home = std::getenv("HOME");
    if (home != nullptr && std::string(home).size() > 1) {
      EXPECT_EQ(bytes.find(std::string(home) + "/"), std::string::npos) << home;
    }
  }

  const test::ScratchFolder folder_;
};

TEST_F(MachinePaths, AreInNoMapWhateverVerbHasWrittenToIt) {
  const std::string map = " -m " + path("place.gpkg");
  run("map " + path("visit1") + map);
  run("map " + path("visit0") + map);
  run("overhead --resolution-m 0.05" + map);
  run("roads" + map);
  run("speeds --truth" + map);
  run("diagnose " + path("visit0") + map);
  expect_no_machine_in("place.gpkg");

  // The warnings are there, and their files can be found from the map.
  const auto run_note =
      nlohmann::json::parse(load_meta(path("place.gpkg")).values.at("place.summary"));
  const auto& warnings = run_note.at("warnings");
  ASSERT_FALSE(warnings.empty());
  for (const auto& warning : warnings) {
    const auto file = warning.at("file").get<std::string>();
    EXPECT_TRUE(file.starts_with("visit0/")) << file;
    EXPECT_TRUE(fs::exists(folder_.path() / "visit0")) << file;
  }
}

}  // namespace
}  // namespace roadbook
