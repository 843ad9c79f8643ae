#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <set>
#include <sstream>

#include "base/random.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/apps/running_program.hpp"

// Two commands that write one map. The first is held (SIGSTOP) at a moment of its run, the second
// runs to its end, the first continues. Each has its whole effect, or is refused: nothing is lost
// or mixed. ROADBOOK_RACES sets the number of moments; the short test tries a few.

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using test::RunningProgram;

int races() {
  const char* const number = std::getenv("ROADBOOK_RACES");
  return number == nullptr ? 2 : std::atoi(number);
}

// Three short drives, a map of the first, and one with all layers that the verbs need.
struct Place {
  Place() {
    for (const char* name : {"a", "b", "c"}) {
      const std::string visit = std::to_string(name[0] - 'a');
      make(
          "simulate zurich --size small --max-duration-s 6 --image-scale 0.25 "
          "--visit " +
          visit + " -o " + name);
    }
    make("map a -m a.gpkg");
    fs::copy_file(folder.path() / "a.gpkg", folder.path() / "full.gpkg");
    make("roads -m full.gpkg");
  }
  void make(const std::string& arguments) const {
    const auto made = run_command("roadbook " + arguments + " -q", folder.path());
    EXPECT_EQ(made.status, 0) << arguments << ": " << made.err;
  }
  static const Place& of_all_tests() {
    static const Place place;
    return place;
  }

  test::ScratchFolder folder;
};

std::set<std::string> sessions_of(const fs::path& map) {
  std::set<std::string> names;
  for (const Session& session : load_map(map).sessions) names.insert(session.name);
  return names;
}

// Sessions that the layers and tables of the map say they come from.
std::set<std::string> sources_of_layers(const fs::path& map) {
  std::set<std::string> names;
  const MapLayers layers(map);
  const auto add = [&](const std::string& list) {
    std::istringstream words(list);
    for (std::string name; std::getline(words, name, ',');) names.insert(name);
  };
  for (const LayerInfo& info : layers.list()) {
    if (info.raster) continue;
    const VectorLayer layer = layers.read_layer(info.name);
    const auto field = layer.field("sessions");
    if (!field) continue;
    for (const Feature& feature : layer.features)
      if (const auto* text = std::get_if<std::string>(&feature.values[*field])) add(*text);
  }
  if (layers.has("overhead_sources"))
    for (const auto& row : layers.read_table("overhead_sources").rows)
      add(std::get<std::string>(row[1]));
  return names;
}

void expect_refused_by_lock(const CommandResult& result) {
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_NE(result.err.find(": lock: got a map that process "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("(roadbook "), std::string::npos) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

struct Race {
  CommandResult held;
  CommandResult other;
};

// Holds `first` after a share of its usual time while `second` runs.
Race race(const std::string& first,
          const std::string& second,
          std::chrono::duration<double> moment,
          const fs::path& folder) {
  RunningProgram held(first + " -q", folder);
  usleep(static_cast<useconds_t>(1e6 * moment.count()));
  held.hold();
  Race result;
  result.other = run_command("roadbook " + second + " -q", folder);
  held.go_on();
  result.held = held.wait();
  return result;
}

std::chrono::duration<double> time_of(const std::string& arguments, const fs::path& folder) {
  const auto begin = std::chrono::steady_clock::now();
  (void)run_command("roadbook " + arguments + " -q", folder);
  return std::chrono::steady_clock::now() - begin;
}

void copy_map(const fs::path& folder, const std::string& from) {
  for (const char* rest : {"m.gpkg", "m.gpkg.part", "m.gpkg.new"}) fs::remove(folder / rest);
  fs::copy_file(folder / from, folder / "m.gpkg");
}

void expect_no_lost_extension() {
  const fs::path folder = Place::of_all_tests().folder.path();
  copy_map(folder, "a.gpkg");
  const auto usual = time_of("map b -m m.gpkg", folder);
  for (int i = 0; i < races(); ++i) {
    SCOPED_TRACE(i);
    copy_map(folder, "a.gpkg");
    const Race made =
        race("map b -m m.gpkg", "map c -m m.gpkg", usual * (i + 0.5) / races(), folder);
    std::set<std::string> want{"a"};
    if (made.held.status == 0) want.insert("b");
    if (made.other.status == 0) want.insert("c");
    EXPECT_GT(want.size(), 1U) << made.held.err << made.other.err;
    if (made.held.status != 0) expect_refused_by_lock(made.held);
    if (made.other.status != 0) expect_refused_by_lock(made.other);
    EXPECT_EQ(sessions_of(folder / "m.gpkg"), want);
    EXPECT_TRUE(check_map(folder / "m.gpkg").problems.empty());
  }
}

// A verb that adds layers is held while the map is replaced by one of another drive.
void expect_no_mixture_with_another_map(const std::string& verb) {
  const fs::path folder = Place::of_all_tests().folder.path();
  copy_map(folder, "full.gpkg");
  const auto usual = time_of(verb, folder);
  for (int i = 0; i < races(); ++i) {
    SCOPED_TRACE(verb + " " + std::to_string(i));
    copy_map(folder, "full.gpkg");
    const Race made = race(verb, "map b -m m.gpkg --replace", usual * (i + 0.5) / races(), folder);
    if (made.other.status != 0) {
      expect_refused_by_lock(made.other);
      EXPECT_EQ(made.held.status, 0) << made.held.err;
    }
    // If the map was replaced before the verb locked it, the map of b may lack a layer for the
    // verb.
    EXPECT_TRUE(made.held.status == 0 || made.held.status == 2) << made.held.err;
    const std::set<std::string> want{made.other.status == 0 ? "b" : "a"};
    EXPECT_EQ(sessions_of(folder / "m.gpkg"), want);
    for (const std::string& source : sources_of_layers(folder / "m.gpkg"))
      EXPECT_TRUE(want.contains(source)) << source;
    EXPECT_TRUE(check_map(folder / "m.gpkg").problems.empty());
  }
}

void expect_no_mixed_drive() {
  const fs::path folder = Place::of_all_tests().folder.path();
  const std::string command =
      "simulate zurich --size small --max-duration-s 3 --image-scale 0.2 -o twice --overwrite";
  const auto usual = time_of(command, folder);
  const auto second = command + " --seed 7";
  for (int i = 0; i < races(); ++i) {
    const Race made = race(command, second, usual * (i + 0.5) / races(), folder);
    EXPECT_EQ(made.held.status, 0) << made.held.err;
    if (made.other.status != 0) {
      EXPECT_EQ(made.other.status, 3);
      EXPECT_NE(made.other.err.find("lock: got a folder that process "), std::string::npos)
          << made.other.err;
    }
    EXPECT_EQ(run_command("roadbook check twice -q", folder).status, 0);
  }
}

// All in one test, because each test is a process that would make the drives again.
TEST(MapRaces, EachVerbHasItsWholeEffectOrIsRefused) {
  expect_no_lost_extension();
  for (const char* verb : {"overhead -m m.gpkg --resolution-m 0.1", "roads -m m.gpkg",
                           "speeds -m m.gpkg --truth", "diagnose a -m m.gpkg --keep"})
    expect_no_mixture_with_another_map(verb);
  expect_no_mixed_drive();
}

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
