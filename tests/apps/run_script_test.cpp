#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>

#include "tests/apps/run_command.hpp"
#include "tests/support/real_data.hpp"
#include "tests/support/source_tree.hpp"

// Tests setup/run.sh, which runs the chain from drives to a report.

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::read_text;
using test::run_command;
using test::write_text;

std::string script() { return "'" + (test::source_tree() / "setup" / "run.sh").string() + "'"; }

// Replaces the program by a script. A verb listed in FAIL ends with the status that follows it
// there. The script logs each call.
class RunScript : public ::testing::Test {
 protected:
  RunScript() {
    const fs::path program = folder_.path() / "program";
    write_text(program,
               "#!/bin/sh\n"
               "echo \"$*\" >> \"$RUNS\"\n"
               "for fail in $FAIL; do\n"
               "  [ \"${fail%=*}\" != \"$1\" ] || { echo \"error: $1: no ground\" >&2; exit "
               "${fail#*=}; }\n"
               "done\n"
               "while [ $# -gt 0 ]; do\n"
               "  case $1 in -m | -o) [ -d \"$2\" ] || : > \"$2\" ;; esac\n"
               "  shift\n"
               "done\n");
    fs::permissions(program, fs::perms::owner_all);
    for (const char* const name : {"a b", "c"}) {
      fs::create_directories(folder_.path() / name / "cam0");
      write_text(folder_.path() / name / "cam0" / "sensor.yaml", "x");
      // The input is older than every mark.
      fs::last_write_time(folder_.path() / name / "cam0" / "sensor.yaml",
                          fs::file_time_type::clock::now() - std::chrono::hours(1));
      fs::last_write_time(program, fs::file_time_type::clock::now() - std::chrono::hours(1));
    }
  }

  CommandResult run(const std::string& drives, const std::string& fail = "") {
    fs::remove(folder_.path() / "runs");
    return run_command(
        "ROADBOOK=\"$PWD/program\" ROADBOOK_OUT=\"$PWD/out\" RUNS=\"$PWD/runs\" "
        "FAIL='" +
            fail + "' " + script() + " " + drives,
        folder_.path());
  }
  [[nodiscard]] std::string runs() const { return read_text(folder_.path() / "runs"); }

  test::ScratchFolder folder_;
};

TEST_F(RunScript, JoinsDrivesAndRunsTheWholeChainOnce) {
  const CommandResult first = run("'a b' c");
  EXPECT_EQ(first.status, 0) << first.err;
  const std::string at = folder_.path().string();
  EXPECT_NE(runs().find("map " + at + "/a b " + at + "/c -m " + at + "/out/a b+c/a b+c.gpkg"),
            std::string::npos)
      << runs();
  for (const char* const verb : {"overhead", "roads", "speeds", "export", "report"})
    EXPECT_NE(runs().find(verb), std::string::npos) << verb;
  for (const char* const line : {"map        done", "overhead   done", "report     done"})
    EXPECT_NE(first.out.find(line), std::string::npos) << first.out;
  const CommandResult again = run("'a b' c");
  EXPECT_EQ(again.status, 0);
  EXPECT_FALSE(fs::exists(folder_.path() / "runs")) << runs();
  EXPECT_NE(again.out.find("map        up to date"), std::string::npos) << again.out;
  write_text(folder_.path() / "c" / "vehicle.yaml", "length: 4\nwidth: 2\n");
  fs::last_write_time(folder_.path() / "c" / "vehicle.yaml",
                      fs::file_time_type::clock::now() + std::chrono::seconds(2));
  (void)run("'a b' c");
  EXPECT_NE(runs().find("map "), std::string::npos) << "the vehicle is new";
}

TEST_F(RunScript, AStepWithNothingToShowDoesNotStopTheOthers) {
  const CommandResult result = run("c", "overhead=4");
  EXPECT_EQ(result.status, 4);
  EXPECT_NE(result.err.find("error: overhead: no ground"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("overhead   nothing to show"), std::string::npos) << result.out;
  for (const char* const line : {"map        done", "roads      done", "report     done"})
    EXPECT_NE(result.out.find(line), std::string::npos) << result.out;
  // The next run tries it again.
  EXPECT_EQ(run("c").status, 0);
  EXPECT_NE(runs().find("overhead"), std::string::npos);
}

TEST_F(RunScript, WhatNeedsAFailedStepIsSkipped) {
  const CommandResult roads = run("c", "roads=2");
  EXPECT_EQ(roads.status, 2);
  for (const char* const line :
       {"roads      failed (exit status 2", "speeds     skipped: needs the result of roads",
        "opendrive  skipped: needs the result of roads", "overhead   done", "report     done"})
    EXPECT_NE(roads.out.find(line), std::string::npos) << roads.out;
  const CommandResult map = run("'a b'", "map=3 overhead=4");
  EXPECT_EQ(map.status, 3);
  for (const char* const line :
       {"map        failed (exit status 3", "overhead   skipped: needs the result of map",
        "report     skipped: needs the result of map"})
    EXPECT_NE(map.out.find(line), std::string::npos) << map.out;
  EXPECT_EQ(run("'a b'", "map=5").status, 5) << "interrupted";
  EXPECT_EQ(runs().find("overhead"), std::string::npos);
}

TEST_F(RunScript, RefusesWhatIsNoFolder) {
  const CommandResult result = run("c missing");
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("error: missing: got no such folder"), std::string::npos);
}

// Runs the real program on public recordings.
void expect_whole_chain(const std::string& drives,
                        const std::string& name,
                        const test::ScratchFolder& folder) {
  const CommandResult result = run_command(
      "ROADBOOK=\"$(command -v roadbook)\" ROADBOOK_OUT=\"$PWD/out\" " + script() + " " + drives,
      folder.path());
  EXPECT_EQ(result.status, 0) << result.out << result.err;
  for (const char* const step : {"map        done", "overhead   done", "roads      done",
                                 "speeds     done", "opendrive  done", "report     done"})
    EXPECT_NE(result.out.find(step), std::string::npos) << step << '\n' << result.out;
  EXPECT_GT(fs::file_size(folder.path() / "out" / name / "report.html"), 10'000U);
}

TEST(RunScriptOnRecordings, Kitti00GoesThroughAllSteps) {
  ROADBOOK_REQUIRE_DATA(kitti, "drives/kitti00");
  const test::ScratchFolder folder;
  expect_whole_chain("'" + kitti.string() + "'", "kitti00", folder);

  // These are the measures of KITTI's car. Its roof camera sees as much ground with the measures as
  // without them.
  write_text(folder.path() / "car.yaml", "length: 4.77\nwidth: 1.82\nheight: 1.51\n");
  const std::string overhead =
      "roadbook overhead -m out/kitti00/kitti00.gpkg --resolution-m 0.1 "
      "-q --json -o folder --vehicle ";
  const CommandResult with = run_command(overhead + "car.yaml", folder.path());
  EXPECT_EQ(with.status, 0) << with.err;
  EXPECT_NE(with.out.find("\"vehicle\": \"option\""), std::string::npos) << with.out;
  write_text(folder.path() / "car.yaml", "length: 4.77\nwidht: 1.82\n");
  const CommandResult wrong = run_command(overhead + "car.yaml", folder.path());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("car.yaml:2: widht: got an unknown key, want a known one (did you mean "
                           "width?)"),
            std::string::npos)
      << wrong.err;
}

TEST(RunScriptOnRecordings, BothMalagaDrivesGoThroughAllSteps) {
  ROADBOOK_REQUIRE_DATA(a, "drives/malaga07_a");
  ROADBOOK_REQUIRE_DATA(b, "drives/malaga07_b");
  const test::ScratchFolder folder;
  expect_whole_chain("'" + a.string() + "' '" + b.string() + "'", "malaga07_a+malaga07_b", folder);
}

}  // namespace
}  // namespace roadbook
