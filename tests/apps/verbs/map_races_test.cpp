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
#include "tests/apps/verbs/short_place.hpp"

// Two commands that write one map. The first is held (SIGSTOP) at a moment of its run, the second
// runs to its end, the first continues. Each has its whole effect, or is refused: nothing is lost
// or mixed. ROADBOOK_RACES sets the number of moments; the short test tries a few.

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::copy_map;
using test::Place;
using test::run_command;
using test::RunningProgram;
using test::sessions_of;

int races() {
  const char* const number = std::getenv("ROADBOOK_RACES");
  return number == nullptr ? 2 : std::atoi(number);
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
void expect_no_mixture_with_another_map(const std::string& verb, int moments) {
  const fs::path folder = Place::of_all_tests().folder.path();
  copy_map(folder, "full.gpkg");
  const auto usual = time_of(verb, folder);
  for (int i = 0; i < moments; ++i) {
    SCOPED_TRACE(verb + " " + std::to_string(i));
    copy_map(folder, "full.gpkg");
    const Race made = race(verb, "map b -m m.gpkg --replace", usual * (i + 0.5) / moments, folder);
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
  expect_no_mixture_with_another_map("overhead -m m.gpkg --resolution-m 0.1", races());
  // The others lock a map in the same way.
  for (const char* verb :
       {"roads -m m.gpkg", "speeds -m m.gpkg --truth", "diagnose a -m m.gpkg --keep"})
    expect_no_mixture_with_another_map(verb, (races() + 1) / 2);
  expect_no_mixed_drive();
}

}  // namespace
}  // namespace roadbook
