#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "exchange/import/import_labels.hpp"
#include "mapping/store/map_check.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/support/command_output.hpp"
#include "tests/support/source_tree.hpp"

// Python's own library reads the label files (read_label_files.py), and `import` reads them back.

namespace roadbook {
namespace {

using test::Folder;
using test::output_of;

constexpr double kLatitude = 47.3769;
constexpr double kLongitude = 8.5417;

class LabelFiles : public ::testing::TestWithParam<const char*> {
 protected:
  LabelFiles() {
    lot_.spaces_a_side = 4;
    test::write_lot(map(), lot_);
    test::write_lot(other(), lot_);
    LabelStore store(map());
    std::vector<Label> labels;
    for (OrientedBox box : test::spaces_of(lot_)) {
      box.heading += 0.1234567;  // no number that a format writes in few digits
      const auto corners = box.corners();
      labels.push_back(label_of_box(
          store.map(), *anchor_for(store.map(), {corners.begin(), corners.end()}), box));
      labels.back().kind = "parking_space";
    }
    const std::vector<Eigen::Vector2d> crossing{{2, -1}, {4, -1}, {4.123, 1.5}, {3, 0.5}, {2, 1}};
    labels.push_back(label_of_polygon(store.map(), *anchor_for(store.map(), crossing), crossing));
    labels.back().kind = "crossing";
    labels.back().note = "worn, \"old\"";
    labels.push_back(labels[0]);
    labels.back().kind = rejected_kind("parking_space");
    labels[1].source = LabelSource::kAccepted;
    labels[1].sigma_m = 0.25;
    store.create_all(labels, "ann");
  }
  std::filesystem::path map() const { return folder_ / "lot.gpkg"; }
  std::filesystem::path other() const { return folder_ / "other.gpkg"; }
  std::filesystem::path file() const {
    const std::string format = GetParam();
    return folder_ / (format == "yolo" ? "labels" : "labels." + std::string(format) + ".json");
  }
  static std::optional<GeoOrigin> origin() { return GeoOrigin{kLatitude, kLongitude, 0.0}; }
  void write() const {
    ExportOptions options;
    options.origin = origin();
    export_map(map(), GetParam(), file(), options);
  }
  // Corners of all labels that are things, in order of their ids.
  static std::vector<std::pair<std::string, std::vector<Eigen::Vector2d>>> corners_of(
      const std::filesystem::path& map_file) {
    const Map map = load_map(map_file);
    std::vector<std::pair<std::string, std::vector<Eigen::Vector2d>>> all;
    for (const Label& label : read_labels(map_file)) {
      if (is_rejected_kind(label.kind)) continue;
      all.emplace_back(label.kind, std::vector<Eigen::Vector2d>());
      for (const auto& corner : corners_in_map(map, label))
        all.back().second.emplace_back(corner.head<2>());
    }
    return by_kind(std::move(all));
  }
  // Formats may group labels by class.
  using Corners = std::vector<std::pair<std::string, std::vector<Eigen::Vector2d>>>;
  static Corners by_kind(Corners all) {
    std::stable_sort(all.begin(), all.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    return all;
  }

  Folder folder_;
  test::Lot lot_;
};

double farthest_apart(const std::vector<Eigen::Vector2d>& a,
                      const std::vector<Eigen::Vector2d>& b) {
  double farthest = a.size() == b.size() ? 0.0 : 1e9;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    farthest = std::max(farthest, (a[i] - b[i]).norm());
  return farthest;
}

TEST_P(LabelFiles, AnotherReaderFindsEveryLabelToAMillimetreAndNoRejection) {
  write();
  const std::string reader =
      "python3 " + (test::source_tree() / "tests/exchange/read_label_files.py").string() + " ";
  int status = 0;
  const std::string text =
      output_of(reader + GetParam() + " " + file().string() +
                    (GetParam() == std::string("geojson") ? " 47.3769 8.5417" : ""),
                &status);
  ASSERT_EQ(status, 0) << text;
  std::istringstream lines(text);
  Corners got;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    got.emplace_back();
    words >> got.back().first;
    for (Eigen::Vector2d p; words >> p.x() >> p.y();) got.back().second.push_back(p);
  }
  got = by_kind(std::move(got));
  const auto want = corners_of(map());
  ASSERT_EQ(got.size(), want.size()) << text;
  for (std::size_t i = 0; i < want.size(); ++i) {
    EXPECT_EQ(got[i].first, want[i].first);
    EXPECT_LT(farthest_apart(got[i].second, want[i].second), 1e-3) << i;
  }
}

TEST_P(LabelFiles, GoIntoAnotherMapAndNotTwiceIntoTheirOwn) {
  write();
  EXPECT_EQ(import_labels(map(), GetParam(), file(), "bob", origin()).stored, 0U);
  const LabelImport made = import_labels(other(), GetParam(), file(), "bob", origin());
  const auto want = corners_of(map());
  EXPECT_EQ(made.stored, want.size());
  EXPECT_EQ(made.already, 0U);
  const auto got = corners_of(other());
  ASSERT_EQ(got.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i) {
    EXPECT_EQ(got[i].first, want[i].first);
    EXPECT_LT(farthest_apart(got[i].second, want[i].second), 1e-3);
  }
  for (const Label& label : read_labels(other()))
    EXPECT_EQ(label.shape, label.kind == "crossing" ? LabelShape::kPolygon : LabelShape::kBox);
  EXPECT_TRUE(check_map(other()).problems.empty());
  const MapLayers layers(other());
  EXPECT_EQ(layers.read_layer("parking_spaces").features.size(), 8U);
  EXPECT_EQ(layers.read_layer("crossings").features.size(), 1U);
}

// The imported standard deviation is never smaller than that in the file, also if the poses of the
// exporting map were uncertain.
TEST_P(LabelFiles, AreAsExactAsTheFileSaysAndNotAsDrawnWhereItSaysNothing) {
  write();
  import_labels(other(), GetParam(), file(), "bob", origin());
  const Map before = load_map(map());
  const Map after = load_map(other());
  const auto written = read_labels(map());
  const auto read = read_labels(other());
  ASSERT_EQ(read.size(), 9U);
  int unsure = 0;
  for (const Label& label : read) {
    if (GetParam() == std::string("yolo")) {
      EXPECT_EQ(label.sigma_m, 0.12);
      continue;
    }
    const auto same = std::find_if(written.begin(), written.end(), [&](const Label& other_label) {
      return other_label.kind == label.kind &&
             (seen_in_map(before, other_label)->middle - seen_in_map(after, label)->middle).norm() <
                 0.01;
    });
    ASSERT_NE(same, written.end());
    // The standard deviation contains the part of the pose only once, even after several exports
    // and imports.
    EXPECT_NEAR(*sigma_in_map(after, label), *sigma_in_map(before, *same), 1e-6);
    unsure += *sigma_in_map(after, label) > 0.25 ? 1 : 0;
  }
  EXPECT_EQ(unsure, GetParam() == std::string("yolo") ? 0 : 1);
}

TEST_P(LabelFiles, AreTakenBackAsOneStep) {
  write();
  import_labels(other(), GetParam(), file(), "bob", origin());
  LabelStore store(other());
  ASSERT_EQ(store.labels().size(), 9U);
  EXPECT_EQ(store.undo("bob").size(), 9U);
  EXPECT_TRUE(store.labels().empty());
}

TEST(LabelImports, WhatStandsTwiceInAFileIsStoredOnce) {
  const test::Folder folder;
  test::Lot lot;
  lot.spaces_a_side = 2;
  const auto map = folder / "lot.gpkg";
  test::write_lot(map, lot);
  std::ofstream(folder / "twice.json") << R"({"images":[{"id":1,"width":300,"height":200,
    "world":{"corner_m":[0,10],"resolution_m":0.1}}],"categories":[{"id":1,"name":"parking_space"}],
    "annotations":[{"image_id":1,"category_id":1,"bbox":[0,30,25,40]},
                   {"image_id":1,"category_id":1,"bbox":[0,30,25,40]}]})";
  const auto result = import_labels(map, "coco", folder / "twice.json", "bob");
  EXPECT_EQ(result.stored, 1U);
  EXPECT_EQ(result.already, 1U);
}

INSTANTIATE_TEST_SUITE_P(Formats, LabelFiles, ::testing::Values("coco", "yolo", "geojson"));

}  // namespace
}  // namespace roadbook
