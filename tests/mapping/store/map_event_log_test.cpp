#include "mapping/store/map_event_log.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::small_map;

std::filesystem::path map_in(const Folder& folder) {
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  return path;
}

TEST(MapEventLog, EventsComeBackInOrderAndTheMapStaysWhole) {
  const Folder folder;
  const auto path = map_in(folder);
  const std::string before = map_digest(path);
  {
    MapEventLog log(path, "label");
    EXPECT_TRUE(log.events().empty());
    EXPECT_EQ(log.append("first"), 1);
    EXPECT_EQ(log.append("second, with 'quotes' and \n lines"), 2);
  }
  EXPECT_TRUE(check_map(path).problems.empty());
  EXPECT_NE(map_digest(path), before);
  MapEventLog log(path, "label");
  EXPECT_EQ(log.events(),
            (std::vector<std::string>{"first", "second, with 'quotes' and \n lines"}));
  EXPECT_EQ(read_event_log(path, "label"), log.events());
  EXPECT_TRUE(read_event_log(path, "other").empty());
  EXPECT_FALSE(std::filesystem::exists(path.string() + "-journal"));
}

TEST(MapEventLog, NobodyElseChangesTheMapMeanwhile) {
  const Folder folder;
  const auto path = map_in(folder);
  MapEventLog log(path, "label");
  EXPECT_THROW(MapEventLog(path, "label"), StorageError);
  EXPECT_THROW(MapUpdate{path}, StorageError);
  EXPECT_EQ(load_map(path).keyframes.size(), small_map(1).keyframes.size());
}

TEST(MapEventLog, OtherChangesOfTheMapKeepIt) {
  const Folder folder;
  const auto path = map_in(folder);
  MapEventLog(path, "label").append("kept");
  MapUpdate update(path);
  update.write_table({"plain", {{"a", FieldType::kInteger}}, {{std::int64_t{1}}}});
  update.commit();
  EXPECT_TRUE(check_map(path).problems.empty());
  EXPECT_EQ(MapEventLog(path, "label").events(), std::vector<std::string>{"kept"});
}

TEST(MapEventLog, ABuildThatReplacesTheMapKeepsIt) {
  const Folder folder;
  const auto path = map_in(folder);
  MapEventLog(path, "label").append("kept");
  MapFileBuilder(path, "another key").finish(small_map(2), {});
  EXPECT_TRUE(check_map(path).problems.empty());
  EXPECT_EQ(read_event_log(path, "label"), std::vector<std::string>{"kept"});
}

// The child process acknowledges each saved event. After the kill, the log must contain all
// acknowledged events.
TEST(MapEventLog, WhatWasAcknowledgedSurvivesAKill) {
  const Folder folder;
  const auto path = map_in(folder);
  for (int trial = 0; trial < 6; ++trial) {
    const std::size_t before = read_event_log(path, "label").size();
    int acknowledged[2];
    ASSERT_EQ(pipe(acknowledged), 0);
    const pid_t child = fork();
    if (child == 0) {
      MapEventLog log(path, "label");
      for (int i = 0;; ++i) {
        log.append(std::string(1000, 'x') + std::to_string(i));
        const char done = 1;
        if (write(acknowledged[1], &done, 1) != 1) _exit(1);
      }
    }
    close(acknowledged[1]);
    char done = 0;
    std::size_t said = 0;
    for (; said < 5U + 3U * static_cast<unsigned>(trial); ++said)
      ASSERT_EQ(read(acknowledged[0], &done, 1), 1);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    while (read(acknowledged[0], &done, 1) == 1) ++said;
    close(acknowledged[0]);
    const std::size_t stored = read_event_log(path, "label").size() - before;
    EXPECT_GE(stored, said);
    EXPECT_LE(stored, said + 1);
    EXPECT_TRUE(check_map(path).problems.empty());
  }
}

TEST(MapEventLog, AChangedEventIsFoundOnOpeningAndByTheCheck) {
  const Folder folder;
  const auto path = map_in(folder);
  {
    MapEventLog log(path, "label");
    for (const char* text : {"a", "b", "c"}) log.append(text);
  }
  SqlDatabase(path, SqlMode::kReadWrite)
      .run("UPDATE label_events SET content = 'B' WHERE event = 2");
  EXPECT_THROW(MapEventLog(path, "label"), BadInput);
  const auto problems = check_map(path).problems;
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.front().line, 2);
  SqlDatabase(path, SqlMode::kReadWrite).run("DELETE FROM label_events WHERE event = 3");
  EXPECT_THROW((void)read_event_log(path, "label"), BadInput);
}

}  // namespace
}  // namespace roadbook
