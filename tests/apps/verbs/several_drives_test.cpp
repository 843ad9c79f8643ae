#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/evaluation/hidden_readings.hpp"
#include "base/random.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::run_command;
using test::ScratchFolder;
using Json = nlohmann::ordered_json;

constexpr double kLength = 60.0;  // [m]

void expect_refused(const CommandResult& result, const std::string& line) {
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.err, line);
  EXPECT_EQ(result.out, "");
}

TEST(SeveralDrives, TheSameDataTwiceAreNoTwoDrivesWhateverTheFolder) {
  const ScratchFolder folder;
  write_hidden_drive(folder.path() / "e", 1, kLength, {});
  write_hidden_drive(folder.path() / "f", 2, kLength, {});
  fs::copy(folder.path() / "e", folder.path() / "copy", fs::copy_options::recursive);
  expect_refused(run_command("roadbook diagnose e e", folder.path()),
                 "error: e: drive: got the same drive as e, want another one\n");
  expect_refused(run_command("roadbook diagnose e f copy", folder.path()),
                 "error: copy: drive: got the same drive as e, want another one\n");
  EXPECT_EQ(run_command("roadbook diagnose e f", folder.path()).status, 0);
}

// A car whose wheels are 5 % larger than stated, in bends of 10 m to the left and to the right.
void write_log(const fs::path& folder,
               const std::string& name,
               double seconds,
               std::uint64_t seed) {
  Random random(seed, "log");
  std::string table = "t,x,y,yaw,rl,rr\n";
  double x = 0.0, y = 0.0, yaw = 0.0, left = 0.0, right = 0.0;
  constexpr double kStep = 0.02, kRadius = 0.31 * 1.05, kTrack = 1.6;
  for (int i = 0; i * kStep < seconds; ++i) {
    const double t = i * kStep;
    const double speed = 3.0 + std::sin(0.7 * t);
    const double turn = speed / 10.0 * (std::sin(0.5 * t) > 0.0 ? 1.0 : -1.0);
    std::string row = std::to_string(t);
    for (const double v : {x + 0.01 * random.normal(), y + 0.01 * random.normal(),
                           yaw + 0.002 * random.normal(), left, right})
      row += "," + std::to_string(v);
    table += row + "\n";
    x += kStep * speed * std::cos(yaw + 0.5 * kStep * turn);
    y += kStep * speed * std::sin(yaw + 0.5 * kStep * turn);
    yaw += kStep * turn;
    left += kStep * (speed - 0.5 * kTrack * turn) / kRadius + 3e-4 * random.normal();
    right += kStep * (speed + 0.5 * kTrack * turn) / kRadius + 3e-4 * random.normal();
  }
  test::write_text(folder / (name + ".csv"), table);
  test::write_text(folder / (name + ".yaml"),
                   "name: " + name + "\nfile: " + name +
                       ".csv\nvehicle: {radius_m: 0.31, track_width_m: 1.6}\n"
                       "poses: {time: t, x: x, y: y, heading: yaw, measured_by: tracker}\n"
                       "wheels: {time: t, left: rl, right: rr}\n");
}

// Runs of 7 m each, as in a laboratory: each alone is refused.
TEST(SeveralDrives, ShortPlainLogsAreDiagnosedTogether) {
  const ScratchFolder folder;
  std::string command = "roadbook diagnose --json";
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    write_log(folder.path(), name, 2.4, static_cast<std::uint64_t>(name[0]));
    command += std::string(" ") + name + ".yaml";
  }
  const auto alone = run_command("roadbook diagnose a.yaml", folder.path());
  EXPECT_EQ(alone.status, 2);
  EXPECT_NE(alone.err.find("want at least 5.0 s"), std::string::npos) << alone.err;
  const auto result = run_command(command, folder.path());
  ASSERT_EQ(result.status, 0) << result.err;
  const Json found = Json::parse(result.out);
  ASSERT_FALSE(found["causes"].empty()) << result.out;
  const Json& cause = found["causes"][0];
  EXPECT_EQ(cause["effect"], "wheels0.radius") << result.out;
  EXPECT_LT(cause["interval95"][0], 0.05);
  EXPECT_GT(cause["interval95"][1], 0.05);
  expect_refused(run_command("roadbook diagnose a.yaml a.yaml", folder.path()),
                 "error: a.yaml: drive: got the same drive as a.yaml, want another one\n");
  expect_refused(run_command("roadbook diagnose a.yaml b.yaml", folder.path()),
                 "error: 2 drives together: duration: got 4.7 s, want at least 5.0 s\n");
}

// One drive recorded only friction, and the other drive recorded all other streams. The diagnosis
// uses each drive for the effects that its streams can show.
TEST(SeveralDrives, OneWithoutMotionIsLeftOutOfItAndItsReadingsAreStillLookedAt) {
  const ScratchFolder folder;
  write_hidden_drive(folder.path() / "fr", 1, 150.0, {{"wheels0.radius_difference", 0.02}});
  write_hidden_readings(folder.path() / "fronly", 3, HiddenKind::kFriction,
                        {{"friction0.speed_bias", 0.01}});
  const auto result = run_command("roadbook diagnose fronly fr --json", folder.path());
  ASSERT_EQ(result.status, 0) << result.err;
  const Json found = Json::parse(result.out);
  const auto names = [&](const std::string& effect) {
    return std::any_of(found["causes"].begin(), found["causes"].end(),
                       [&](const Json& c) { return c["effect"] == effect; });
  };
  EXPECT_TRUE(names("wheels0.radius_difference")) << result.out;
  EXPECT_TRUE(names("friction0.speed_bias")) << result.out;
  const auto& notes = found["notes"];
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const Json& note) {
    return note == "fronly: left out of the motion, because it records no stream besides the poses";
  })) << notes;
}

}  // namespace
}  // namespace roadbook
