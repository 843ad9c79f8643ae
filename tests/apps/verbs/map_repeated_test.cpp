#include <gtest/gtest.h>
#include <unistd.h>

#include <vector>

#include "mapping/layers/map_layers.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/apps/running_program.hpp"
#include "tests/apps/verbs/short_place.hpp"

// The same command run again, after a kill or after its success, ends at the same map.

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::copy_map;
using test::Place;
using test::run_command;
using test::RunningProgram;
using test::sessions_of;

// The state after a kill between the rename of the extended map and the removal of its checkpoints.
void expect_a_killed_extension_runs_again() {
  const fs::path folder = Place::of_all_tests().folder.path();
  copy_map(folder, "a.gpkg");
  const fs::path part = folder / "m.gpkg.part";
  {
    RunningProgram killed("map b -m m.gpkg -q", folder);
    while (killed.is_running() && !fs::exists(folder / "m.gpkg.new")) usleep(200);
    ASSERT_TRUE(killed.is_running());
    killed.kill_now();
  }
  ASSERT_TRUE(fs::exists(part));
  fs::copy_file(part, folder / "kept.part", fs::copy_options::overwrite_existing);
  ASSERT_EQ(run_command("roadbook map b -m m.gpkg -q", folder).status, 0);
  const std::string digest = map_digest(folder / "m.gpkg");
  EXPECT_EQ(sessions_of(folder / "m.gpkg"), (std::set<std::string>{"a", "b"}));
  fs::copy_file(folder / "kept.part", part);
  const auto again = run_command("roadbook map b -m m.gpkg -q", folder);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(map_digest(folder / "m.gpkg"), digest);
  EXPECT_FALSE(fs::exists(part));
}

// Another build of the program has another build id; its checkpoints are not taken up.
void expect_another_build_begins_afresh() {
  const fs::path folder = Place::of_all_tests().folder.path();
  fs::remove(folder / "new.gpkg");
  {
    RunningProgram killed("map a -m new.gpkg -q", folder);
    while (killed.is_running() && !fs::exists(folder / "new.gpkg.new")) usleep(200);
    ASSERT_TRUE(killed.is_running());
    killed.kill_now();
  }
  std::string program = test::read_text(ROADBOOK_PROGRAM);
  const std::string note("\x04\0\0\0\x14\0\0\0\x03\0\0\0GNU\0", 16);
  const std::size_t at = program.find(note);
  ASSERT_NE(at, std::string::npos);
  program[at + note.size()] = static_cast<char>(program[at + note.size()] ^ 1);
  test::write_text(folder / "other_build", program);
  fs::permissions(folder / "other_build", fs::perms::owner_all);
  fs::copy_file(folder / "new.gpkg.part", folder / "again.gpkg.part");
  const auto other = run_command("./other_build map a -m new.gpkg -q", folder);
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_NE(other.err.find("begun with other inputs"), std::string::npos) << other.err;
  const auto same = run_command("roadbook map a -m again.gpkg -q", folder);
  EXPECT_EQ(same.status, 0);
  EXPECT_EQ(same.err.find("begun with other inputs"), std::string::npos) << same.err;
  EXPECT_EQ(map_digest(folder / "new.gpkg"), map_digest(folder / "again.gpkg"));
}

void expect_a_drive_given_twice_is_named() {
  const fs::path folder = Place::of_all_tests().folder.path();
  fs::remove(folder / "link");
  fs::create_directory_symlink("a", folder / "link");
  const auto refused = [&](const std::string& arguments, const std::string& line) {
    const auto result = run_command("roadbook map " + arguments + " -q", folder);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_EQ(result.err, line) << arguments;
  };
  refused("a a -m none.gpkg", "error: a: drive: got the same drive as a, want each drive once\n");
  refused("a b link -m none.gpkg --replace",
          "error: link: drive: got the same drive as a, want each drive once\n");
  refused("b link -m a.gpkg",
          "error: link: drive: got session a of a.gpkg, want drives that the map lacks, all its "
          "drives in its order, or --replace\n");
  EXPECT_FALSE(fs::exists(folder / "none.gpkg"));
  EXPECT_FALSE(fs::exists(folder / "none.gpkg.part"));
}

void expect_the_same_verb_twice_gives_the_same_map() {
  const fs::path folder = Place::of_all_tests().folder.path();
  copy_map(folder, "full.gpkg");
  const auto digest_after = [&](const std::string& verb) {
    const auto made = run_command("roadbook " + verb + " -m m.gpkg -q", folder);
    EXPECT_EQ(made.status, 0) << made.err;
    EXPECT_TRUE(check_map(folder / "m.gpkg").problems.empty());
    return map_digest(folder / "m.gpkg");
  };
  const auto history = [&] {
    std::vector<std::string> actions;
    for (const auto& row : MapLayers(folder / "m.gpkg").read_table("audit").rows)
      actions.push_back(std::get<std::string>(row[1]));
    return actions;
  };
  EXPECT_EQ(history(), (std::vector<std::string>{"map", "roads"}));
  const std::string roads = digest_after("roads");
  EXPECT_EQ(digest_after("roads"), roads);
  const std::string speeds = digest_after("speeds --truth");
  EXPECT_EQ(digest_after("speeds --truth"), speeds);
  const std::string linked = digest_after("roads");  // spaces of the truth have lanes now
  EXPECT_EQ(digest_after("speeds --truth"), linked);
  const std::string overhead = digest_after("overhead --resolution-m 0.1");
  EXPECT_EQ(digest_after("overhead --resolution-m 0.1"), overhead);
  EXPECT_EQ(digest_after("speeds --truth"), overhead);
  EXPECT_EQ(history(), (std::vector<std::string>{"map", "roads", "speeds", "roads", "overhead"}));
}

TEST(MapRepeated, TheSameCommandAgainEndsAtTheSameMap) {
  expect_a_killed_extension_runs_again();
  expect_another_build_begins_afresh();
  expect_a_drive_given_twice_is_named();
  expect_the_same_verb_twice_gives_the_same_map();
}

}  // namespace
}  // namespace roadbook
