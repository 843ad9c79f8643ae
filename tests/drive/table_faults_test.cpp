#include "drive/table_faults.hpp"

#include "tests/drive/foreign_recordings.hpp"

namespace roadbook::test {
namespace {

// Tables of other programs differ in separators, surrounding characters and encoding.

std::string utf16(const std::string& text, bool big_endian) {
  std::string bytes = big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text)
    bytes += big_endian ? std::string(1, '\0') + c : std::string(1, c) + '\0';
  return bytes;
}

std::string replaced_all(std::string text, char from, const std::string& to) {
  std::string result;
  for (const char c : text) result += c == from ? to : std::string(1, c);
  return result;
}

const std::string kImages = "#timestamp [ns],filename\n100,100.png\n200000100,200000100.png\n";

// Returns the message of `import euroc` for a recording with this image table.
std::string euroc_with_table(const std::string& table) {
  const TemporaryFolder f;
  const fs::path camera = f.path() / "s/mav0/cam0";
  for (const char* const name : {"100.png", "200000100.png"})
    write_flat_image(camera / "data" / name, 1);
  write_text(camera / "sensor.yaml",
             "sensor_type: camera\nT_BS: {rows: 4, cols: 4, data: [0,0,1,0, -1,0,0,0, 0,-1,0,1, "
             "0,0,0,1]}\nresolution: [64, 48]\ncamera_model: pinhole\nintrinsics: [40, 40, 31.5, "
             "23.5]\ndistortion_model: none\n");
  write_text(camera / "data.csv", table);
  const auto made = try_import("euroc", f.path() / "s", f.path() / "out");
  return (made.refused ? "refused " : "") + made.text;
}

TEST(TableFaults, WhatSeparatesTheColumnsIsNamedWithTheLine) {
  EXPECT_EQ(euroc_with_table(kImages), "");
  const struct {
    char separator;
    const char* name;
  } kOthers[] = {{';', "semicolons"}, {'\t', "tabs"}, {'|', "bars"}, {' ', "blanks"}};
  for (const auto& [separator, name] : kOthers) {
    const auto text = euroc_with_table(replaced_all(kImages, ',', std::string(1, separator)));
    ROADBOOK_EXPECT_TEXT(text, "cam0/data.csv:1: header: got #timestamp [ns]");
    ROADBOOK_EXPECT_TEXT(
        text, "(" + std::string(name) + " between them), want columns with commas between them");
    // The header is as it should be, the rows are not.
    const auto rows =
        euroc_with_table("#timestamp [ns],filename\n100" + std::string(1, separator) + "100.png\n");
    ROADBOOK_EXPECT_TEXT(rows,
                         "data.csv:2: row: got 1 fields (" + std::string(name) + " between them)");
  }
}

TEST(TableFaults, LineEndsAndAByteOrderMarkAreReadWhatElseIsNamed) {
  EXPECT_EQ(euroc_with_table("\xEF\xBB\xBF" + replaced_all(kImages, '\n', "\r\n")), "");
  ROADBOOK_EXPECT_TEXT(euroc_with_table(replaced_all(kImages, '\n', "\r")),
                       "data.csv:1: header: got line ends of CR alone");
  ROADBOOK_EXPECT_TEXT(euroc_with_table(utf16(kImages, false)),
                       "data.csv:1: header: got UTF-16 text, want UTF-8 text");
  ROADBOOK_EXPECT_TEXT(euroc_with_table(utf16(kImages, true)), "got UTF-16 text");
  ROADBOOK_EXPECT_TEXT(euroc_with_table("#\"timestamp [ns]\",\"filename\"\n\"100\",\"100.png\"\n"),
                       "(quotes around them)");
}

TEST(TableFaults, AHeaderWithoutItsMarkNamesTheSeparatorAsWell) {
  ROADBOOK_EXPECT_TEXT(euroc_with_table("timestamp [ns];filename\n100;100.png\n"),
                       "header: got timestamp [ns];filename (semicolons between them), want a line "
                       "like '#timestamp [ns],...'");
}

TEST(TableFaults, DecimalCommasAreNamed) {
  const TemporaryFolder f;
  write_text(f.path() / "wheels0/sensor.yaml",
             "sensor_type: wheels\nwheel_radius_left: 0.3\nwheel_radius_right: 0.3\n"
             "track_width: 1.5\n");
  write_text(f.path() / "wheels0/data.csv",
             "#timestamp [ns],rear_left_angle [rad],rear_right_angle [rad]\n0,0,1,0,2\n");
  ROADBOOK_EXPECT_TEXT(
      all_lines(check_drive(f.path())),
      "data.csv:2: row: got 5 fields (decimal commas?), want 3 as the header names");
  EXPECT_EQ(number_wanted("1,5"), "a finite number with a point, not a comma, before its decimals");
  EXPECT_EQ(number_wanted("1.5.2"), "a finite number");
  EXPECT_EQ(number_wanted("a,b"), "a finite number");
}

TEST(TableFaults, TextTablesOfImportersNameThemToo) {
  const TemporaryFolder f;
  const auto kaist = [&](const std::string& encoder) {
    return try_import("kaist", write_kaist(f.path() / "k", encoder), f.path() / "o").text;
  };
  ROADBOOK_EXPECT_TEXT(kaist("100;1;2\n200;3;4\n"),
                       "encoder.csv:1: row: got 1 fields (semicolons between them), want 3 with "
                       "commas between them");
  ROADBOOK_EXPECT_TEXT(kaist("100 1 2\n"), "(blanks between them)");
  ROADBOOK_EXPECT_TEXT(kaist("\"100\",\"1\",\"2\",\"\"\n"), "(quotes around them)");
  ROADBOOK_EXPECT_TEXT(kaist(utf16("100,1,2\n", false)), "encoder.csv:1: got UTF-16 text");
  const auto kitti = write_kitti(f.path() / "s", {"0.png", "1.png"}, kitti_times(2));
  // Tabs and several blanks separate fields as one blank does.
  write_text(kitti / "calib.txt", "P0:\t40  0\t31.5 0 0 40 23.5 0 0 0 1 0\r\n");
  EXPECT_EQ(try_import("kitti", kitti, f.path() / "out").text, "");
  write_text(kitti / "calib.txt", "P0: 40,5 0 31.5 0 0 40 23.5 0 0 0 1 0\n");
  ROADBOOK_EXPECT_TEXT(try_import("kitti", kitti, f.path() / "o2").text,
                       "with a point, not a comma");
}

// For any bytes, the reader gives one of the listed answers.
TEST(TableFaults, RandomLinesAreReadWithoutHarm) {
  const std::string letters = " ,;\t|\"[]#\r\n0123.eE-+ab\xFF\xFE";
  for (std::uint64_t i = 0; i < 50'000; ++i) {
    Random random(9, "lines", i);
    std::string line;
    for (std::uint64_t k = 0, n = random.below(30); k < n; ++k)
      line += random.below(20) == 0 ? '\0' : letters[random.below(letters.size())];
    const std::size_t got = 1 + random.below(20);
    const auto fault =
        layout_fault(line, random.below(2) == 0 ? ',' : ' ', got, 1 + random.below(9));
    ASSERT_TRUE(fault.empty() || fault == "decimal commas?" || fault == "quotes around them" ||
                fault.ends_with(" between them"));
    for (const auto field : split_at_blanks(line))
      ASSERT_EQ(field.find_first_of(" \t\r"), std::string_view::npos);
    (void)encoding_fault(line);
    (void)number_wanted(line);
  }
}

TEST(TableFaults, CarriageReturnsAreAFaultOnlyWhereTheyAloneEndLines) {
  EXPECT_EQ(encoding_fault("1,2\r3,4\r"), "line ends of CR alone");
  EXPECT_EQ(encoding_fault("1,2"), "");
  EXPECT_EQ(encoding_fault("1,2\r"), "");  // CR LF, split at LF
  EXPECT_EQ(encoding_fault("1,2\r\r"), "");
}

}  // namespace
}  // namespace roadbook::test
