#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "exchange/export/geo_origin.hpp"
#include "exchange/import/import_labels.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/support/source_tree.hpp"

namespace roadbook {
namespace {

TEST(GeoOrigin, EveryDigitOfItCounts) {
  const Eigen::Vector2d place = ToDegrees({47.37690049, 8.54170051, 0.0})({0.0, 0.0});
  EXPECT_NEAR(place.x(), 8.54170051, 1e-10);
  EXPECT_NEAR(place.y(), 47.37690049, 1e-10);
}

// Features of other layers have no class. A layer of spaces that come from truth only has no class
// either.
TEST(GeoJsonLabels, FeaturesOfOtherLayersAreLeftOutAndCounted) {
  const test::Folder folder;
  test::write_lot(folder / "lot.gpkg", test::Lot());
  const GeoOrigin origin{47.3769, 8.5417, 0.0};
  const auto stored = [&](const std::string& layer, double width_m) {
    nlohmann::json ring;
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(2, -1), {4, -1}, {3, width_m - 1}, {2, -1}}) {
      const Eigen::Vector2d place = ToDegrees(origin)(corner);
      ring.push_back({place.x(), place.y()});
    }
    const nlohmann::json label{{"type", "Feature"},
                               {"properties", {{"class", "crossing"}}},
                               {"geometry", {{"type", "Polygon"}, {"coordinates", {ring}}}}};
    const nlohmann::json other{
        {"type", "Feature"}, {"properties", {{"layer", layer}}}, {"geometry", nullptr}};
    std::ofstream(folder / "labels.json")
        << nlohmann::json{{"type", "FeatureCollection"}, {"features", {other, label}}};
    return import_labels(folder / "lot.gpkg", "geojson", folder / "labels.json", "bob", origin);
  };
  const LabelImport roads = stored("roads", 2.0);
  EXPECT_EQ(roads.stored, 1U);
  EXPECT_EQ(roads.count_left_out(), 1U);
  const LabelImport spaces = stored("parking_spaces", 2.0);
  EXPECT_EQ(spaces.already, 1U);
  ASSERT_EQ(spaces.left_out.size(), 1U);
  EXPECT_EQ(spaces.left_out[0].reason.field, "layer parking_spaces");
  EXPECT_THROW(static_cast<void>(stored("roads", 0.0)), BadInput);  // a polygon without an area
}

}  // namespace
}  // namespace roadbook
