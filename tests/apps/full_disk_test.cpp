#include <gtest/gtest.h>

#include <algorithm>

#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/driven_road.hpp"
#include "tests/apps/run_command.hpp"

// A full disk is named as such, by every verb that writes. The disk is a small file system in
// memory, which a user may mount in a name space of his own; where the system forbids that, only
// /dev/full is tried.

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;

constexpr const char* kFull = "no space left on the device holding ";

void expect_full(const CommandResult& result, const std::string& command) {
  EXPECT_EQ(result.status, 3) << command << ": " << result.err;
  EXPECT_NE(result.err.find(kFull), std::string::npos) << command << ": " << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

class FullDisk : public ::testing::Test {
 protected:
  FullDisk() {
    fs::create_directory(folder_.path() / "disk");
    MapFileBuilder(folder_.path() / "a.gpkg", "inputs").finish(test::driven_road(), {});
    EXPECT_EQ(run_command("roadbook roads -m a.gpkg -q", folder_.path()).status, 0);
  }
  // Runs a command after `disk` has become a file system of 4 MB with `kilobytes` left.
  [[nodiscard]] CommandResult run_on_disk(const std::string& command, int kilobytes) const {
    return run_command(
        "unshare -rm sh -c 'mount -t tmpfs -o size=4m none disk && cp a.gpkg disk/m.gpkg && "
        "dd if=/dev/zero of=disk/room bs=1k count=" +
            std::to_string(kilobytes) +
            " 2>/dev/null && { dd if=/dev/zero of=disk/rest bs=4k 2>/dev/null; rm disk/room; " +
            command + "; code=$?; cmp -s a.gpkg disk/m.gpkg || exit 99; exit $code; }'",
        folder_.path());
  }
  [[nodiscard]] bool may_mount() const {
    return run_command("unshare -rm mount -t tmpfs none disk", folder_.path()).status == 0;
  }

  const test::ScratchFolder folder_;
};

TEST_F(FullDisk, IsNamedByEveryVerbThatWritesThere) {
  if (!may_mount()) return;
  for (const int kilobytes : {0, 40, 300})
    for (const char* command : {"roadbook roads -m disk/m.gpkg --min-passes 1 --reach-m 3 -q"})
      expect_full(run_on_disk(command, kilobytes), command + std::to_string(kilobytes));
  for (const char* command :
       {"roadbook export -m a.gpkg --format geojson --latitude-deg 48 --longitude-deg 9 "
        "-o disk/a.geojson -q",
        "roadbook export -m a.gpkg --format tum -o disk/a.tum -q",
        "roadbook export -m a.gpkg --format gpkg -o disk/b.gpkg -q",
        "roadbook export -m a.gpkg --format opendrive -o disk/a.xodr -q",
        "roadbook report -m a.gpkg -o disk/a.html -q",
        "roadbook simulate zurich --size small --max-duration-s 1 --image-scale 0.1 -q -o disk/d"})
    expect_full(run_on_disk(command, 0), command);
}

TEST_F(FullDisk, IsNamedWhereADeviceIsWritten) {
  for (const char* command :
       {"roadbook report -m a.gpkg -o /dev/full -q", "roadbook check a.gpkg --json > /dev/full"})
    expect_full(run_command(command, folder_.path()), command);
}

}  // namespace
}  // namespace roadbook
