#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "mapping/pipeline/build_map.hpp"
#include "tests/pipeline/map_judge.hpp"
#include "tests/pipeline/shared_round.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

struct WheelRow {
  std::string t;
  double left = 0.0;
  double right = 0.0;
  std::string rest;
};

using WheelFault = std::function<void(std::vector<WheelRow>&)>;

// Rewrites the wheels' table of a drive, of which `original` is the text.
void write_fault(const fs::path& drive, const std::string& original, const WheelFault& fault) {
  std::istringstream in(original);
  std::string header;
  std::getline(in, header);
  std::vector<WheelRow> rows;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    WheelRow row;
    std::string left;
    std::string right;
    std::getline(cells, row.t, ',');
    std::getline(cells, left, ',');
    std::getline(cells, right, ',');
    std::getline(cells, row.rest);
    row.left = std::stod(left);
    row.right = std::stod(right);
    rows.push_back(row);
  }
  fault(rows);
  std::ofstream out(drive / "wheels0/data.csv");
  out.precision(12);
  out << header << "\n";
  for (const WheelRow& row : rows)
    out << row.t << ',' << row.left << ',' << row.right << ',' << row.rest << "\n";
}

// Holds both wheels from row `first` for `count` rows; the turns of that time are lost.
void hold(std::vector<WheelRow>& rows, std::size_t first, std::size_t count) {
  const WheelRow from = rows[first];
  const std::size_t last = std::min(rows.size(), first + count) - 1;
  const WheelRow to = rows[last];
  for (std::size_t i = first; i < rows.size(); ++i) {
    rows[i].left = i <= last ? from.left : rows[i].left - (to.left - from.left);
    rows[i].right = i <= last ? from.right : rows[i].right - (to.right - from.right);
  }
}

struct Mapped {
  double ate_m = 0.0;
  std::size_t keyframes = 0;
  std::vector<std::string> doubts;  // warnings of the wheels against the cameras
};

Mapped mapped(const fs::path& drive) {
  MapOptions options;
  options.replace = true;
  options.covariances = false;
  const MapSummary summary = build_map({drive}, drive.parent_path() / "map.gpkg", options);
  Mapped result{summary.ate_median_m.value_or(1e9), summary.keyframes, {}};
  // A line names the sensor once, by its folder.
  for (const Problem& warning : summary.warnings)
    if (fs::path(warning.file).filename() == "wheels0") {
      EXPECT_EQ(warning.field, "motion");
      result.doubts.push_back(warning.got + " | " + warning.want);
      EXPECT_EQ(result.doubts.back().find("wheels0"), std::string::npos);
    }
  return result;
}

// Sound wheels are not doubted. Wheels that stick, stop for good or are swapped are: one warning
// says when and by how much, and the map is hardly worse than that of sound wheels.
TEST(WrongWheels, AreNamedAndDoNotBendTheMap) {
  const fs::path folder = test::fresh_folder("wrong_wheels");
  test::give_beginning_of_round(14.0, folder / "drive");
  std::stringstream original;
  original << std::ifstream(folder / "drive/wheels0/data.csv").rdbuf();
  const Mapped sound = mapped(folder / "drive");
  EXPECT_TRUE(sound.doubts.empty());
  ASSERT_LT(sound.ate_m, 0.05);

  constexpr std::size_t kFirst = 350;  // 7 s
  const auto judge = [&](const WheelFault& fault, const std::string& words) {
    SCOPED_TRACE(words);
    write_fault(folder / "drive", original.str(), fault);
    const Mapped map = mapped(folder / "drive");
    // Wheels that are believed bend this map by more than half a metre.
    EXPECT_LT(map.ate_m, 1.5 * sound.ate_m);
    EXPECT_GE(map.keyframes, sound.keyframes * 4 / 5);
    ASSERT_EQ(map.doubts.size(), 1U);
    EXPECT_NE(map.doubts[0].find(words), std::string::npos) << map.doubts[0];
  };
  judge([&](auto& rows) { hold(rows, kFirst, 75); }, "the cameras see");
  judge([&](auto& rows) { hold(rows, kFirst, 10000); }, "mapped without the wheels there");
  judge(
      [](auto& rows) {
        for (WheelRow& row : rows) std::swap(row.left, row.right);
      },
      "left and right exchanged");
}

}  // namespace
}  // namespace roadbook
