#include "mapping/store/map_file_builder.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>

#include "base/error.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::small_map;

constexpr int kStages = 5;

std::string stage_name(int i) { return "stage " + std::to_string(i); }

/// Builds as the pipeline does: each stage reads the result that the previous stage saved.
void build(const std::filesystem::path& path) {
  MapFileBuilder build(path, "drive 1, seed 4");
  for (int i = 0; i < kStages; ++i) {
    if (build.has(stage_name(i))) continue;
    const std::string before = i == 0 ? "" : build.load(stage_name(i - 1), "result");
    build.save(stage_name(i),
               {{"result", before + std::string(300'000, static_cast<char>('a' + i))}});
  }
  Map map = small_map(4);
  map.sessions[0].drive_digest =
      std::to_string(build.load(stage_name(kStages - 1), "result").size());
  build.finish(map, {{"seed", "4"}});
}

/// Runs `body` in a child that leaves without cleaning up, like any other end of a process.
template <typename Body>
pid_t in_child(const Body& body) {
  const pid_t child = fork();
  if (child == 0) {
    body();
    _exit(0);
  }
  return child;
}

TEST(MapFileBuilder, KilledAnywhereItLeavesTheOldMapAndEndsTheSame) {
  const Folder folder;
  const auto path = folder / "place.gpkg";
  build(folder / "undisturbed.gpkg");
  const std::string want = map_digest(folder / "undisturbed.gpkg");
  MapFileBuilder(path, "older").finish(small_map(9), {});
  const std::string old = map_digest(path);
  Random random(1, "kill");
  for (int trial = 0; trial < 20; ++trial) {
    const pid_t child = in_child([&] { build(path); });
    usleep(static_cast<useconds_t>(random.uniform(1.0, 90'000.0)));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    const std::string now = map_digest(path);
    EXPECT_TRUE(now == old || now == want) << "trial " << trial;
    EXPECT_TRUE(check_map(path).problems.empty());
    if (trial % 4 != 3) continue;  // some kills hit a build that a kill has hit before
    build(path);
    EXPECT_EQ(map_digest(path), want) << "trial " << trial;
    MapFileBuilder(path, "older").finish(small_map(9), {});
  }
}

TEST(MapFileBuilder, TakesUpWhereItStopped) {
  const Folder folder;
  const std::string big(9'000'000, 'x');  // more than two chunks
  {
    MapFileBuilder first(folder / "a.gpkg", "key");
    first.save("odometry", {{"poses", big}, {"tracks", std::string("a\0b", 3)}, {"empty", ""}});
  }
  const MapFileBuilder second(folder / "a.gpkg", "key");
  ASSERT_TRUE(second.has("odometry"));
  EXPECT_FALSE(second.has("loops"));
  EXPECT_EQ(second.load("odometry", "poses"), big);
  EXPECT_EQ(second.load("odometry", "tracks"), std::string("a\0b", 3));
  EXPECT_EQ(second.load("odometry", "empty"), "");
  EXPECT_TRUE(second.warnings().empty());
}

TEST(MapFileBuilder, OtherInputsStartAfresh) {
  const Folder folder;
  MapFileBuilder(folder / "a.gpkg", "key").save("odometry", {{"poses", "1"}});
  const MapFileBuilder other(folder / "a.gpkg", "another key");
  EXPECT_FALSE(other.has("odometry"));
  ASSERT_EQ(other.warnings().size(), 1U);
  EXPECT_EQ(to_line(other.warnings().front()),
            "warning: " + (folder / "a.gpkg.part").string() +
                ": checkpoints: got a build begun with other inputs or options, want one of the "
                "same inputs, options and program; the build starts afresh");
}

TEST(MapFileBuilder, DamagedCheckpointsStartAfresh) {
  const Folder folder;
  const auto part = folder / "a.gpkg.part";
  for (const std::streamoff at : {std::streamoff{0}, std::streamoff{150'000}}) {
    MapFileBuilder(folder / "a.gpkg", "key")
        .save("odometry", {{"poses", std::string(300'000, 'p')}});
    {
      std::fstream file(part, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(at);
      file << "damage";
    }
    MapFileBuilder again(folder / "a.gpkg", "key");
    EXPECT_FALSE(again.has("odometry"));
    ASSERT_EQ(again.warnings().size(), 1U);
    // One fault a line: no line of another message within it.
    const std::string line = to_line(again.warnings().front());
    EXPECT_EQ(line.rfind("warning: " + part.string() + ": checkpoints: got "), 0U) << line;
    EXPECT_EQ(line.find("error"), std::string::npos) << line;
    again.save("odometry", {{"poses", "sound"}});
    EXPECT_EQ(again.load("odometry", "poses"), "sound");
  }
}

TEST(MapFileBuilder, OnlyOneProcessBuilds) {
  const Folder folder;
  const MapFileBuilder holder(folder / "a.gpkg", "key");
  const pid_t child = in_child([&] {
    try {
      const MapFileBuilder second(folder / "a.gpkg", "key");
    } catch (const StorageError&) {
      _exit(3);
    }
  });
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

TEST(MapFileBuilder, AFullDiskIsAStorageErrorAndLeavesTheOldMap) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "older").finish(small_map(9), {});
  const std::string old = map_digest(path);
  const Map large = small_map(3, {.keyframes = 100, .observations = 100, .landmarks = 2000});
  for (const rlim_t bytes : {rlim_t{20'000}, rlim_t{120'000}, rlim_t{400'000}, rlim_t{1'000'000}}) {
    const pid_t child = in_child([&] {
      signal(SIGXFSZ, SIG_IGN);  // the write then fails as on a full disk
      const rlimit limit{bytes, bytes};
      setrlimit(RLIMIT_FSIZE, &limit);
      try {
        MapFileBuilder(path, "key").finish(large, {});
      } catch (const StorageError&) {
        _exit(3);
      }
    });
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 3) << bytes;
    EXPECT_EQ(map_digest(path), old) << bytes;
  }
  // With room again the same command succeeds.
  MapFileBuilder(path, "key").finish(large, {});
  EXPECT_EQ(load_map(path).keyframes.size(), large.keyframes.size());
}

TEST(MapFileBuilder, AFolderThatIsNotThereIsAStorageError) {
  const Folder folder;
  EXPECT_THROW(MapFileBuilder(folder / "missing/a.gpkg", "key"), StorageError);
}

}  // namespace
}  // namespace roadbook
