#include "diagnosis/streams/drive_session.hpp"

#include <gtest/gtest.h>

#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

constexpr std::int64_t kHour = 3'600'000'000'000;
constexpr std::int64_t kEnd = kStart + (kFrames - 1) * kFrame;

// A map of one drive, as if its tables had been read by an older program.
Map map_of(const std::string& name, std::int64_t begin_ns, std::int64_t end_ns) {
  Map map;
  map.sessions.emplace_back();
  map.sessions.back().name = name;
  map.sessions.back().drive_digest = "another";
  map.sessions.back().t_begin_ns = begin_ns;
  map.sessions.back().t_end_ns = end_ns;
  return map;
}

TEST(DriveSession, IsFoundByDigestWhateverItIsCalled) {
  const TemporaryFolder folder;
  const Drive drive = Drive::open(write_small_drive(folder.path() / "monday"));
  Map map = map_of("monday", kStart + kHour, kEnd + kHour);
  map.sessions.push_back(map.sessions.front());
  map.sessions.back().name = "tuesday";
  map.sessions.back().drive_digest = drive.digest();
  EXPECT_EQ(find_session(map, drive), 1);
}

TEST(DriveSession, OfTheSameNameIsAnotherDriveUnlessItWasRecordedThen) {
  const TemporaryFolder folder;
  const Drive drive = Drive::open(write_small_drive(folder.path() / "monday"));
  EXPECT_EQ(find_session(map_of("monday", kStart, kEnd), drive), 0);
  EXPECT_EQ(find_session(map_of("monday", kStart + kHour, kEnd + kHour), drive), std::nullopt);
  EXPECT_EQ(find_session(map_of("monday", kStart, kEnd + kFrame), drive), std::nullopt);
  EXPECT_EQ(find_session(map_of("tuesday", kStart, kEnd), drive), std::nullopt);
  EXPECT_THROW(
      static_cast<void>(session_of(map_of("monday", kStart - kHour, kEnd), drive, "map.gpkg")),
      BadInput);
}

TEST(DriveSession, OfADriveWithoutImagesIsRecordedWhenItsSensorsWereRead) {
  const TemporaryFolder folder;
  {
    DriveWriter writer(folder.path() / "monday", {}, small_wheels());
    for (int i = 0; i < 4 * kFrames; ++i) writer.write_wheels(wheels_at(i));
    writer.finish();
  }
  const Drive drive = Drive::open(folder.path() / "monday");
  ASSERT_EQ(drive.frame_count(), 0U);
  EXPECT_EQ(find_session(map_of("monday", kStart, kEnd), drive), 0);
  EXPECT_EQ(find_session(map_of("monday", kStart, kEnd + kHour), drive), std::nullopt);
}

}  // namespace
}  // namespace roadbook::test
