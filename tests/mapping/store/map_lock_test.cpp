#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <optional>

#include "base/error.hpp"
#include "base/files/lock_holder.hpp"
#include "mapping/store/map_event_log.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::small_map;

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Runs `body` in another process and returns the text of its StorageError; empty without one.
template <typename Body>
std::string refusal_elsewhere(const Body& body) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    std::string text;
    try {
      body();
    } catch (const StorageError& fault) {
      text = fault.what();
    }
    const ssize_t written = write(ends[1], text.data(), text.size());
    _exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  char part[512];
  for (ssize_t n = 0; (n = read(ends[0], part, sizeof(part))) > 0;)
    text.append(part, static_cast<std::size_t>(n));
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return text;
}

TEST(MapHold, KeepsOthersAwayAndNamesTheProcessThatHoldsTheMap) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  std::optional<MapHold> hold(std::in_place, path);
  const std::string text = refusal_elsewhere([&] { MapUpdate update(path); });
  EXPECT_EQ(text.rfind("error: " + path.string() + ": lock: got a map that process " +
                           std::to_string(getpid()) + " (test_store",
                       0),
            0U)
      << text;
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_NE(refusal_elsewhere([&] { MapEventLog log(path, "label"); }), "");
  EXPECT_NE(refusal_elsewhere([&] { MapFileBuilder build(path, "key"); }), "");
  hold.reset();
  EXPECT_EQ(refusal_elsewhere([&] { MapUpdate update(path); }), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg.part"));
}

// Another program may lock bytes of its own in the file. The message does not blame it.
TEST(MapHold, OnlyLocksOnTheBytesOfSqliteNameTheirProcess) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  std::ofstream(path) << "text";
  const auto holder_of_lock_at = [&](off_t byte) {
    const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    lock.l_start = byte;
    lock.l_len = 1;
    EXPECT_EQ(fcntl(file, F_SETLK, &lock), 0);
    const std::string holder = lock_holder(path);
    close(file);
    return holder;
  };
  EXPECT_EQ(holder_of_lock_at(0), "another process");
  EXPECT_EQ(holder_of_lock_at(0x40000000).rfind("process " + std::to_string(getpid()), 0), 0U);
}

// A workflow takes the hold; the functions that it calls change the map one after another.
TEST(MapHold, ItsProcessChangesTheMapUnderItOneObjectAtATime) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  const MapHold hold(path);
  MapFileBuilder(path, "key").finish(small_map(1), {});
  {
    MapUpdate update(path);
    EXPECT_THROW(MapUpdate second(path), StorageError);
    update.set_meta("note", "one");
    update.commit();
  }
  { MapEventLog(path, "label").append("first"); }
  EXPECT_EQ(MapEventLog(path, "label").append("second"), 2);
  EXPECT_NE(refusal_elsewhere([&] { MapUpdate update(path); }), "");
}

// The path of a file that does not exist yet, as a user types it.
TEST(MapHold, IsOneForARelativePath) {
  const Folder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  {
    const MapHold hold("a.gpkg");
    MapFileBuilder("a.gpkg", "key").finish(small_map(1), {});
    const MapHold second("./a.gpkg");
    MapUpdate update(folder / "a.gpkg");
    update.commit();
  }
  std::filesystem::current_path(before);
  EXPECT_TRUE(std::filesystem::exists(folder / "a.gpkg"));
}

// Checkpoints survive the end of a hold; a lock file alone does not.
TEST(MapHold, KnowsTheBuildThatWaits) {
  const Folder folder;
  const auto part = folder / "a.gpkg.part";
  { EXPECT_EQ(MapHold(folder / "a.gpkg").waiting_build(), ""); }
  EXPECT_FALSE(std::filesystem::exists(part));
  { MapFileBuilder(folder / "a.gpkg", "key").save("odometry", {{"poses", "1"}}); }
  { EXPECT_EQ(MapHold(folder / "a.gpkg").waiting_build(), "key"); }
  EXPECT_TRUE(std::filesystem::exists(part));
  { MapHold(folder / "a.gpkg").remove_checkpoints(); }
  EXPECT_FALSE(std::filesystem::exists(part));
}

TEST(MapLock, IsOneUnderAllNamesAndALinkStaysALink) {
  const Folder folder;
  const auto map = folder / "a.gpkg";
  const auto link = folder / "link.gpkg";
  std::filesystem::create_directory(folder / "elsewhere");
  const auto far = folder / "elsewhere/far.gpkg";
  std::filesystem::create_symlink("a.gpkg", link);
  std::filesystem::create_symlink("../link.gpkg", far);
  MapFileBuilder(far, "key").finish(small_map(1), {});  // the target of the link does not exist yet
  for (const auto& [held, other] : {std::pair{map, far}, {far, link}, {link, map}}) {
    const MapHold hold(held);
    EXPECT_NE(refusal_elsewhere([&, path = other] { MapUpdate update(path); }), "");
  }
  MapUpdate update(link);
  update.set_meta("note", "one");
  update.commit();
  EXPECT_EQ(load_meta(map).values.at("note"), "one");
  EXPECT_TRUE(std::filesystem::is_symlink(link) && std::filesystem::is_symlink(far));
  EXPECT_FALSE(std::filesystem::is_symlink(map));
  EXPECT_FALSE(std::filesystem::exists(folder / "elsewhere/far.gpkg.part"));
}

// An event goes into the file in place. The copies that hard links make must not share it.
TEST(MapLock, AnEventOfOneHardLinkIsNoneOfTheOther) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  { MapEventLog(path, "label").append("before"); }
  std::filesystem::create_hard_link(path, folder / "b.gpkg");
  MapEventLog one(path, "label");
  MapEventLog two(folder / "b.gpkg", "label");
  EXPECT_EQ(one.append("of a"), 2);
  EXPECT_EQ(two.append("of b"), 2);
  EXPECT_EQ(read_event_log(path, "label"), (std::vector<std::string>{"before", "of a"}));
  EXPECT_EQ(read_event_log(folder / "b.gpkg", "label"),
            (std::vector<std::string>{"before", "of b"}));
}

// Many processes begin at once: each of them changes the map, or is refused; none is lost.
TEST(MapLock, OfProcessesThatBeginTogetherEachWinsOrIsRefused) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  std::vector<pid_t> children;
  for (int i = 0; i < 8; ++i) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    try {
      MapUpdate update(path);
      update.set_meta("process " + std::to_string(i), "was here");
      update.commit();
      _exit(0);
    } catch (const StorageError&) {
      _exit(3);
    }
  }
  std::size_t done = 0;
  for (std::size_t i = 0; i < children.size(); ++i) {
    int status = 0;
    waitpid(children[i], &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    const bool won = WEXITSTATUS(status) == 0;
    EXPECT_TRUE(won || WEXITSTATUS(status) == 3);
    EXPECT_EQ(load_meta(path).values.contains("process " + std::to_string(i)), won);
    done += won ? 1 : 0;
  }
  EXPECT_GE(done, 1U);
}

TEST(MapUpdate, OfNothingLeavesTheFileAndItsHistoryAsTheyAre) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  const auto write = [&](std::int64_t value) {
    MapUpdate update(path);
    update.write_layer({"places",
                        "",
                        GeometryType::kPointZ,
                        {{"n", FieldType::kInteger}},
                        {{{{1, 2, 0, 0}}, {value}}}});
    update.write_table({"rounds", {{"a", FieldType::kInteger}}, {{value}}});
    update.note("places", "one");
    update.commit();
    return content_of(path);
  };
  const std::string first = write(1);
  EXPECT_TRUE(write(1) == first);
  EXPECT_FALSE(write(2) == first);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg.new"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg.part"));
}

}  // namespace
}  // namespace roadbook
