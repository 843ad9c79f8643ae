#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "exchange/import/import_labels.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/mapping/store/small_map.hpp"

// A file must keep the shape of a label and the front side of a box.

namespace roadbook {
namespace {

using nlohmann::json;

class LabelShapes : public ::testing::Test {
 protected:
  LabelShapes() {
    for (const auto& map : {map_, other_}) test::write_lot(map, lot_);
    LabelStore store(map_);
    std::vector<Label> labels;
    const auto add = [&](const OrientedBox& box, bool as_box) {
      const auto c = box.corners();
      const std::vector<Eigen::Vector2d> corners(c.begin(), c.end());
      const auto anchor = *anchor_for(store.map(), corners);
      labels.push_back(as_box ? label_of_box(store.map(), anchor, box)
                              : label_of_polygon(store.map(), anchor, corners));
      labels.back().kind = test::kSpace;
    };
    add({{3.0, 5.0}, 0.7, 2.0, 3.0}, true);    // wider than long
    add({{8.0, 5.0}, 2.3, 2.5, 2.5}, true);    // as long as wide
    add({{13.0, 5.0}, -2.9, 5.0, 2.5}, true);  // towards the west
    add({{18.0, 5.0}, 0.3, 5.0, 2.5}, false);  // a polygon of a class of boxes
    store.create_all(labels, "ann");
  }
  json written(const std::string& format) const {
    ExportOptions options;
    options.origin = origin_;
    export_map(map_, format, file_, options);
    std::ifstream in(file_);
    return json::parse(in);
  }
  std::vector<Label> read(const std::string& format, const json& text) const {
    std::ofstream(file_) << text;
    import_labels(other_, format, file_, "bob", origin_);
    return read_labels(other_);
  }
  void expect_the_same(std::vector<Label> got, double within) const {
    const auto want = read_labels(map_);
    const Map map = load_map(map_);
    const Map other = load_map(other_);
    const auto x_of = [&](const Label& label) { return seen_in_map(other, label)->middle.x(); };
    std::sort(got.begin(), got.end(),
              [&](const Label& a, const Label& b) { return x_of(a) < x_of(b); });
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < want.size(); ++i) {
      ASSERT_EQ(got[i].shape, want[i].shape) << i;
      if (want[i].shape != LabelShape::kBox) continue;
      EXPECT_NEAR(got[i].length_m, want[i].length_m, within) << i;
      EXPECT_NEAR(got[i].width_m, want[i].width_m, within) << i;
      const double turn = box_in_map(other, got[i])->heading - box_in_map(map, want[i])->heading;
      EXPECT_NEAR(std::remainder(turn, 2.0 * M_PI), 0.0, within) << i;
    }
  }

  test::Folder folder_;
  test::Lot lot_;
  GeoOrigin origin_{47.3769, 8.5417, 0.0};
  std::filesystem::path map_ = folder_ / "lot.gpkg";
  std::filesystem::path other_ = folder_ / "other.gpkg";
  std::filesystem::path file_ = folder_ / "labels.json";
};

TEST_F(LabelShapes, ComeBackThroughCocoWithSidesAndHeading) {
  expect_the_same(read("coco", written("coco")), 1e-9);
}

TEST_F(LabelShapes, ComeBackThroughCocoWhicheverCornerAnotherProgramBeginsWith) {
  json file = written("coco");
  for (json& annotation : file["annotations"]) {
    auto& ring = annotation["segmentation"][0].get_ref<json::array_t&>();
    std::rotate(ring.begin(), ring.begin() + 2, ring.end());
  }
  expect_the_same(read("coco", file), 1e-9);
}

// Degrees are written to 0.1 mm, which is 0.1 mrad over two metres.
TEST_F(LabelShapes, ComeBackThroughGeoJsonWithSidesAndHeading) {
  expect_the_same(read("geojson", written("geojson")), 3e-4);
}

TEST_F(LabelShapes, WhereAFileSaysNothingARectangleIsABoxAlongItsLongerSide) {
  json file = written("coco");
  for (json& annotation : file["annotations"]) annotation.erase("attributes");
  const auto got = read("coco", file);
  ASSERT_EQ(got.size(), 4U);
  for (const Label& label : got) EXPECT_EQ(label.shape, LabelShape::kBox);
  EXPECT_NEAR(got[0].length_m, 3.0, 1e-9);
  EXPECT_NEAR(got[0].width_m, 2.0, 1e-9);
}

}  // namespace
}  // namespace roadbook
