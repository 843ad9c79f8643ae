#include "exchange/export/picture_edge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "exchange/import/import_labels.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/mapping/store/small_map.hpp"

// Spaces that reach over the edge of the overhead image, which ends at y = -4 m.

namespace roadbook {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

class PictureEdge : public ::testing::Test {
 protected:
  PictureEdge() {
    lot_.spaces_a_side = 4;
    lot_.side_px = 400;  // 16 m: x from -4 to 12 m, y from 12 to -4 m
    for (const auto& map : {map_, other_}) test::write_lot(map, lot_);
    draw_all(map_);
  }
  void draw_all(const std::filesystem::path& map) const {
    LabelStore store(map);
    std::vector<Label> labels;
    for (const OrientedBox& box : test::spaces_of(lot_)) {
      const auto corners = box.corners();
      const auto anchor = anchor_for(store.map(), {corners.begin(), corners.end()});
      labels.push_back(label_of_box(store.map(), *anchor, box));
      labels.back().kind = test::kSpace;
    }
    // Only the legs of the first outline lie in the image. The second outline lies outside.
    for (const Outline& corners :
         {Outline{{1, -2}, {1, -6}, {4, -6}, {4, -2}, {3, -2}, {3, -5}, {2, -5}, {2, -2}},
          Outline{{1, -6}, {2, -6}, {2, -5}}}) {
      labels.push_back(label_of_polygon(store.map(), *anchor_for(store.map(), corners), corners));
      labels.back().kind = "crossing";
    }
    store.create_all(labels, "ann");
  }
  LabelImport there_and(const std::filesystem::path& map, const std::string& format) const {
    const GeoOrigin origin{47.3769, 8.5417, 0.0};
    ExportOptions options;
    options.origin = origin;
    const auto file = folder_ / (format == "yolo" ? format : format + ".json");
    export_map(map_, format, file, options);
    return import_labels(map, format, file, "bob", origin);
  }
  static std::vector<Outline> outlines_of(const std::filesystem::path& map) {
    std::vector<Outline> outlines;
    for (const LabelOutline& outline : outlines_of_labels(MapLayers(map)))
      outlines.push_back(outline.corners);
    return outlines;
  }
  // Whether one of the outlines has these corners, in any order.
  static bool has(const std::vector<Outline>& outlines, const Outline& corners) {
    return std::any_of(outlines.begin(), outlines.end(), [&](const Outline& one) {
      return one.size() == corners.size() &&
             std::all_of(one.begin(), one.end(), [&](const Eigen::Vector2d& p) {
               return std::any_of(corners.begin(), corners.end(),
                                  [&](const Eigen::Vector2d& q) { return (p - q).norm() < 1e-3; });
             });
    });
  }
  static Outline upright(double x0, double y0, double x1, double y1) {
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  }

  test::Folder folder_;
  test::Lot lot_;
  std::filesystem::path map_ = folder_ / "lot.gpkg";
  std::filesystem::path other_ = folder_ / "other.gpkg";
};

TEST_F(PictureEdge, CocoKeepsWholeWhatReachesOverIt) {
  EXPECT_EQ(there_and(map_, "coco").stored, 0U);
  EXPECT_EQ(there_and(other_, "coco").stored, 9U);
  const auto got = outlines_of(other_);
  auto want = outlines_of(map_);
  want.pop_back();  // lies outside
  for (const Outline& corners : want) EXPECT_TRUE(has(got, corners));
}

TEST_F(PictureEdge, GeoJsonKnowsNone) {
  EXPECT_EQ(there_and(map_, "geojson").stored, 0U);
  EXPECT_EQ(there_and(other_, "geojson").stored, 10U);
}

TEST_F(PictureEdge, YoloIsCutThereAndKnownAgain) {
  EXPECT_EQ(there_and(map_, "yolo").stored, 0U);
  EXPECT_EQ(there_and(other_, "yolo").stored, 10U);  // 4 spaces, 4 cut ones, 2 legs
  const auto got = outlines_of(other_);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(has(got, upright(2.5 * i, 3.0, 2.5 * i + 2.5, 8.0))) << i;
    EXPECT_TRUE(has(got, upright(2.5 * i, -4.0, 2.5 * i + 2.5, -3.0))) << i;
  }
  EXPECT_TRUE(has(got, upright(1, -4, 2, -2)));
  EXPECT_TRUE(has(got, upright(3, -4, 4, -2)));
}

// The importer recognises a cut outline by the edge that cut it, not by the edge of the current
// overhead image.
TEST_F(PictureEdge, YoloIsKnownAgainWhereTheOverheadImageHasGrown) {
  const auto grown = folder_ / "grown.gpkg";
  test::Lot lot = lot_;
  lot.side_px = 500;
  test::write_lot(grown, lot);
  draw_all(grown);
  EXPECT_EQ(there_and(grown, "yolo").stored, 0U);
}

TEST_F(PictureEdge, YoloHoldsSharesOfNoneToAllAlone) {
  there_and(map_, "yolo");
  std::ifstream rows(folder_ / "yolo" / "labels" / "overhead.txt");
  int count = 0;
  for (std::string line; std::getline(rows, line); ++count) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    for (double share = 0.0; words >> share;) {
      EXPECT_GE(share, 0.0) << line;
      EXPECT_LE(share, 1.0) << line;
    }
  }
  EXPECT_EQ(count, 10);
}

TEST_F(PictureEdge, WhatIsCutAndWhatIsLeftOutIsTold) {
  const auto yolo = warnings_of_picture_edge(map_, "yolo");
  ASSERT_EQ(yolo.size(), 2U);
  EXPECT_EQ(yolo[0].field, "labels outside the overhead image");
  EXPECT_EQ(yolo[0].got, "1");
  EXPECT_EQ(yolo[1].field, "labels over the overhead image's edge");
  EXPECT_EQ(yolo[1].got, "5");
  ASSERT_EQ(warnings_of_picture_edge(map_, "coco").size(), 1U);
  EXPECT_TRUE(warnings_of_picture_edge(map_, "geojson").empty());
}

// A strip of half a pixel along the edge is not visible in an image.
TEST_F(PictureEdge, LessThanAPixelIsNoPart) {
  const PicturePlace place{100, 100, {0.0, 10.0}, 0.1};
  EXPECT_TRUE(parts_in_picture(place, upright(-5, 2, 0.05, 4)).empty());
  EXPECT_EQ(parts_in_picture(place, upright(-5, 2, 0.15, 4)).size(), 1U);
  EXPECT_TRUE(parts_in_picture(place, {{-5, 2}, {0.002, 3}, {-5, 4}}).empty());  // a tip
  const Outline small = upright(3, 3, 3.05, 3.05);
  EXPECT_EQ(parts_in_picture(place, small), std::vector<Outline>{small});
}

}  // namespace
}  // namespace roadbook
