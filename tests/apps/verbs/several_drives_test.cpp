#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/evaluation/hidden_readings.hpp"
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

TEST(SeveralDrives, APlainLogIsNoneOfSeveral) {
  const ScratchFolder folder;
  write_hidden_drive(folder.path() / "e", 1, kLength, {});
  test::write_text(folder.path() / "log.yaml", "name: log\n");
  for (const char* order : {"e log.yaml", "log.yaml e"})
    expect_refused(run_command(std::string("roadbook diagnose ") + order, folder.path()),
                   "error: log.yaml: drive: got a file, want the folder of a drive: plain logs are "
                   "diagnosed one by one\n");
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
