#include "mapping/store/existing_map.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "mapping/store/map_event_log.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::small_map;
using Names = std::vector<std::string>;

// A map of drives with the digests "monday" and "tuesday". A table in it holds a user's work.
std::filesystem::path map_of_two_days(const Folder& folder) {
  const auto path = folder / "a.gpkg";
  Map map = small_map(1);
  map.sessions[0].drive_digest = "monday";
  map.sessions[1].drive_digest = "tuesday";
  MapFileBuilder(path, "key").finish(map, {});
  MapUpdate update(path);
  update.write_table({"rounds", {{"a", FieldType::kInteger}}, {{std::int64_t{1}}}});
  update.commit();
  MapEventLog(path, "label").append("by hand");
  return path;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(ExistingMap, ItGoesOnWhereAllItsDrivesComeFirstAgain) {
  const Folder folder;
  const auto path = map_of_two_days(folder);
  const auto stay = [&](const Names& digests) { return read_existing_map(path, digests).stay; };
  EXPECT_EQ(stay({"monday", "tuesday"}), 2U);
  EXPECT_EQ(stay({"monday", "tuesday", "friday"}), 2U);
  EXPECT_EQ(stay({"monday", "friday"}), 1U);
  EXPECT_EQ(stay({"monday"}), 1U);
  EXPECT_EQ(stay({"tuesday", "monday"}), 0U);
  EXPECT_TRUE(read_existing_map(path, {"monday", "tuesday", "friday"}).goes_on());
  EXPECT_FALSE(read_existing_map(path, {"monday", "friday", "tuesday"}).goes_on());
}

TEST(ExistingMap, WhatBelongsToItsDrivesIsLeftOutOfAMapOfOthersAndThatIsTold) {
  const Folder folder;
  const auto path = map_of_two_days(folder);
  std::vector<Problem> warnings;
  const auto tables = [&](const Names& digests) {
    return tables_that_stay(path, read_existing_map(path, digests), {"friction"},
                            {"rounds", "none_here"}, warnings);
  };
  EXPECT_EQ(tables({"monday", "tuesday", "friday"}), (Names{"friction", "rounds", "none_here"}));
  EXPECT_TRUE(warnings.empty());
  EXPECT_EQ(tables({"monday", "friday"}), Names{"friction"});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(to_line(warnings.front()),
            "warning: " + path.string() +
                ": rounds: got what was learnt with drive 1, want the same drives in the same "
                "order; it is left out");
}

// The damage is either bytes in the middle of the file or an event that a user changed by hand. The
// check of the pages and the digests finds it.
TEST(ExistingMap, ADamagedOneIsToldAndNothingIsWrittenOverIt) {
  for (const bool by_hand : {false, true}) {
    SCOPED_TRACE(by_hand);
    const Folder folder;
    const auto path = map_of_two_days(folder);
    if (by_hand) {
      SqlDatabase(path, SqlMode::kReadWrite).run("UPDATE label_events SET content = 'other'");
    } else {
      std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
      file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(path) / 2));
      file << std::string(5000, 'x');
    }
    const std::string before = bytes_of(path);
    EXPECT_THROW((void)read_existing_map(path, {"monday", "tuesday"}), BadInput);
    MapFinishOptions options;
    EXPECT_THROW(MapFileBuilder(path, "another key").finish(small_map(2), {}, options), BadInput);
    options.keep_tables = {"rounds"};
    EXPECT_THROW(MapFileBuilder(path, "another key").finish(small_map(2), {}, options), BadInput);
    EXPECT_TRUE(bytes_of(path) == before);
    EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg.new"));
  }
}

}  // namespace
}  // namespace roadbook
