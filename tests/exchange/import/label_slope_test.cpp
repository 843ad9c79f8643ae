#include <gtest/gtest.h>

#include <string>

#include "exchange/import/import_labels.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/support/source_tree.hpp"

namespace roadbook {
namespace {

class LabelsOnASlope : public ::testing::TestWithParam<const char*> {};

std::vector<Eigen::Vector3d> corners_of_first(const std::filesystem::path& map) {
  return corners_in_map(load_map(map), read_labels(map).at(0));
}

// Formats hold the horizontal projection of a box; labels hold the lengths of its sides on the
// slope.
TEST_P(LabelsOnASlope, ComeBackAndAreKnownAgain) {
  const test::Folder folder;
  const test::Lot lot;
  Map tilted = test::lot_map(lot);
  for (Keyframe& keyframe : tilted.keyframes)
    keyframe.T_frame_vehicle.rotate(Eigen::AngleAxisd(0.07, Eigen::Vector3d::UnitX()));
  const std::filesystem::path from = folder / "slope.gpkg";
  const std::filesystem::path to = folder / "slope_too.gpkg";
  for (const auto& map : {from, to}) {
    MapFileBuilder(map, "lot").finish(tilted, {});
    test::write_lot_picture(map, lot);
  }
  {
    LabelStore store(from);
    const OrientedBox box{{5.0, 4.5}, 1.2, 5.0, 2.5};
    const auto corners = box.corners();
    const auto anchor = anchor_for(store.map(), {corners.begin(), corners.end()});
    ASSERT_TRUE(anchor);
    Label label = label_of_box(store.map(), *anchor, box);
    label.kind = "parking_space";
    store.create_all({label}, "ann");
  }
  ExportOptions options;
  options.origin = GeoOrigin{47.3769, 8.5417, 0.0};
  const auto file = folder / (std::string(GetParam()) == "yolo" ? "labels" : "labels.json");
  export_map(from, GetParam(), file, options);
  EXPECT_EQ(import_labels(from, GetParam(), file, "bob", options.origin).stored, 0U);
  EXPECT_EQ(import_labels(to, GetParam(), file, "bob", options.origin).stored, 1U);
  const auto want = corners_of_first(from);
  const auto got = corners_of_first(to);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((got[i] - want[i]).norm(), 1e-3) << i;
}

INSTANTIATE_TEST_SUITE_P(Formats, LabelsOnASlope, ::testing::Values("coco", "yolo", "geojson"));

}  // namespace
}  // namespace roadbook
