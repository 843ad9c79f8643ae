#include "drive/detections.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

fs::path written(const std::string& name, const std::string& text) {
  const fs::path file = fs::path(::testing::TempDir()) / ("roadbook_" + name + ".csv");
  std::ofstream(file) << text;
  return file;
}

TEST(Detections, ComeBackAsTheyWereWritten) {
  const fs::path folder = fs::path(::testing::TempDir()) / "roadbook_detector0";
  const std::vector<Detection> rows{
      {100, 5.25, -1.5, 0.2, 0.9, {0.05, 0.01, 0.03}, std::array{3.4, 0.0}},
      {200, -2.0, 3.0, 0.1, 0.6, {0.01, 0.0, 0.01}, std::array{-0.8, 0.125}}};
  const std::vector<Look> looks{{100, {12, 255}}, {200, {0, 99}}};
  write_detections(folder, rows, looks);
  const auto read = read_detections(folder / "data.csv");
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].t_ns, rows[i].t_ns);
    EXPECT_DOUBLE_EQ(read[i].x_m, rows[i].x_m);
    EXPECT_DOUBLE_EQ(read[i].y_m, rows[i].y_m);
    EXPECT_EQ(read[i].covariance, rows[i].covariance);
    EXPECT_EQ(read[i].eye_m, rows[i].eye_m);
  }
  const auto when = read_looks(folder / "looks.csv");
  ASSERT_EQ(when.size(), 2U);
  EXPECT_EQ(when[0].reach_dm, looks[0].reach_dm);
  EXPECT_EQ(when[1].reach_dm, looks[1].reach_dm);
}

TEST(Detections, WithoutTheFurtherColumnsTheirDefaultsHold) {
  const auto rows = read_detections(written("plain", "#timestamp [ns],x [m],y [m]\n7,1,2\n"));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].sigma_m, 0.3);
  EXPECT_EQ(rows[0].probability, 1.0);
  EXPECT_FALSE(rows[0].eye_m);
}

TEST(Detections, EveryFaultIsNamedWithItsLine) {
  const auto file = written("bad",
                            "#timestamp [ns],x [m],y [m],xx [m^2],xy [m^2],yy [m^2]\n"
                            "1,0,0,1,0,1\n2,0,0,1,2,1\n3,5000,0,1,0,1\n");
  try {
    (void)read_detections(file);
    FAIL() << "accepted";
  } catch (const BadInput& e) {
    ASSERT_EQ(e.problems().size(), 2U);
    EXPECT_EQ(e.problems()[0].line, 3);
    EXPECT_EQ(e.problems()[0].field, "xx, xy, yy");
    EXPECT_EQ(e.problems()[1].line, 4);
    EXPECT_EQ(e.problems()[1].field, "x");
  }
  EXPECT_THROW((void)read_looks(written("looks", "#timestamp [ns],reach_0 [m]\n5,-1\n")), BadInput);
}

TEST(Detections, ATableOfLooksThatIsCutWithinItsHeadOrFirstRowIsRefused) {
  const std::string whole = "#timestamp [ns],reach_0 [m],reach_1 [m]\n5,1.0,2.0\n";
  for (std::size_t length = 0; length < whole.size() - 3; ++length)
    EXPECT_THROW((void)read_looks(written("cut", whole.substr(0, length))), BadInput) << length;
  EXPECT_EQ(read_looks(written("cut", whole)).size(), 1U);
}

TEST(Detections, ADetectorThatTellsNoLooksHasNoTableOfThem) {
  const fs::path folder = fs::path(::testing::TempDir()) / "roadbook_no_looks";
  fs::remove_all(folder);
  write_detections(folder, {}, {});
  EXPECT_TRUE(fs::exists(folder / "data.csv"));
  EXPECT_FALSE(fs::exists(folder / "looks.csv"));
}

}  // namespace
}  // namespace roadbook
