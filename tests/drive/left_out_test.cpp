#include "tests/drive/foreign_recordings.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook::test {
namespace {

// Rows that importers leave out are counted with their share; too large a share is refused.

// A row each 10 ms; from row `back_at` on the clock is `back` rows behind.
std::string encoder_rows(int count, int back_at, int back) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    const int tick = i < back_at ? i : i - back;
    text += std::to_string(1'000'000'000 + std::int64_t{tick} * 10'000'000) + "," +
            std::to_string(3 * i) + "," + std::to_string(3 * i) + "\n";
  }
  return text;
}

TEST(LeftOutRows, AClockSetBackForLongIsRefusedWithItsShare) {
  const TemporaryFolder f;
  const auto s = write_kaist(f.path() / "s", encoder_rows(300, 150, 150));
  const auto made = try_import("kaist", s, f.path() / "out");
  EXPECT_TRUE(made.refused);
  ROADBOOK_EXPECT_TEXT(made.text,
                       "encoder.csv:151: rows: got 150 of 300 rows (50 %) that repeat a stamp or "
                       "go back in time, want ascending stamps (where the clock was set back, "
                       "import the parts one by one), or at most 10 %");
}

TEST(LeftOutRows, AFewAreAWarningWithTheirShareAndTheLimitIsAnOption) {
  const TemporaryFolder f;
  const auto s = write_kaist(f.path() / "s", encoder_rows(300, 150, 6));
  ImportOptions options;
  auto made = try_import("kaist", s, f.path() / "a", options);
  EXPECT_FALSE(made.refused);
  ROADBOOK_EXPECT_TEXT(made.text, "warning: ");
  ROADBOOK_EXPECT_TEXT(made.text, "encoder.csv:151: rows: got 6 of 300 rows (2 %) that repeat");
  EXPECT_EQ(Drive::open(f.path() / "a").wheel_readings().size(), 294u);
  options.max_left_out = 0.01;
  made = try_import("kaist", s, f.path() / "b", options);
  EXPECT_TRUE(made.refused) << made.text;
  options.max_left_out = 1.0;
  const auto half = write_kaist(f.path() / "h", encoder_rows(300, 150, 150));
  EXPECT_FALSE(try_import("kaist", half, f.path() / "c", options).refused);
}

TEST(LeftOutRows, PosesThatGoBackCountAsWell) {
  const TemporaryFolder f;
  const auto s = write_kaist(f.path() / "s", encoder_rows(30, 30, 0));
  std::string poses;
  for (const int t : {0, 1, 2, 0, 1, 2})
    poses += std::to_string(1'000'000'000 + t) + ",1,0,0,5,0,1,0,6,0,0,1,7\n";
  write_text(s / "global_pose.csv", poses);
  ROADBOOK_EXPECT_TEXT(try_import("kaist", s, f.path() / "o").text,
                       "global_pose.csv:4: rows: got 3 of 6 rows (50 %)");
}

TEST(LeftOutRows, MissingImagesOfAEurocRecordingAreCounted) {
  const TemporaryFolder f;
  const auto s = write_small_drive(f.path() / "s");
  const auto image = [&](int i) {
    return s / "cam0/data" / (std::to_string(kStart + i * kFrame) + ".png");
  };
  for (int i = 3; i < 5; ++i) fs::remove(image(i));
  const auto few = try_import("euroc", s, f.path() / "a");
  EXPECT_FALSE(few.refused);
  ROADBOOK_EXPECT_TEXT(
      few.text, "cam0: images: got 2 of 25 images (8 %) that are missing or damaged; left out");
  for (int i = 5; i < 15; ++i) fs::remove(image(i));
  const auto many = try_import("euroc", s, f.path() / "b");
  EXPECT_TRUE(many.refused);
  ROADBOOK_EXPECT_TEXT(many.text, "got 12 of 25 images (48 %) that are missing or damaged");
  ROADBOOK_EXPECT_TEXT(all_lines(check_drive(s)), "cam0/data: images: got 13 of 25 (52 %) usable");
}

TEST(LeftOutRows, ImagesThatNoRowNamesAreCounted) {
  const TemporaryFolder f;
  const auto d = write_small_drive(f.path() / "d");
  std::string table = read_text(d / "cam1/data.csv");
  table.resize(table.find(std::to_string(kStart + 20 * kFrame)));
  write_text(d / "cam1/data.csv", table);
  const auto report = check_drive(d);
  EXPECT_TRUE(report.usable);
  ROADBOOK_EXPECT_TEXT(all_lines(report),
                       "cam1/data: images: got 25 files for 20 rows of data.csv; "
                       "5 files without a row are not used");
}

// A segment of a real car whose stamps go back by half of it.
TEST(LeftOutRows, ARealSegmentWhoseClockGoesBackIsRefused) {
  ROADBOOK_REQUIRE_DATA(source, "comma2k19_example");
  const TemporaryFolder f;
  const fs::path s = f.path() / "s";
  fs::copy(source, s, fs::copy_options::recursive);
  for (const auto& entry : fs::directory_iterator(s))
    fs::permissions(entry.path(), fs::perms::owner_all);
  fs::permissions(s, fs::perms::owner_all);
  std::istringstream in(read_text(s / "wheel_speed.csv"));
  std::string text, line;
  std::vector<std::string> rows;
  while (std::getline(in, line)) rows.push_back(line);
  const bool header = rows.front().find_first_of("0123456789") != 0;
  if (header) text = rows.front() + "\n";
  rows.erase(rows.begin(), rows.begin() + (header ? 1 : 0));
  rows.resize(300);
  const double step = std::stod(rows[1]) - std::stod(rows[0]);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double t = std::stod(rows[i]) - (i < 150 ? 0.0 : 150.0 * step);
    std::ostringstream stamp;
    stamp.precision(17);
    stamp << t;
    text += stamp.str() + rows[i].substr(rows[i].find(',')) + "\n";
  }
  write_text(s / "wheel_speed.csv", text);
  const auto made = try_import("comma2k19", s, f.path() / "out");
  EXPECT_TRUE(made.refused);
  ROADBOOK_EXPECT_TEXT(made.text, "wheel_speed.csv:");
  ROADBOOK_EXPECT_TEXT(made.text, "of 300 rows (");
}

}  // namespace
}  // namespace roadbook::test
