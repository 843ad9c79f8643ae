#include "exchange/import/item_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/random.hpp"
#include "exchange/export/geo_origin.hpp"
#include "exchange/layers/item_table.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/layers/parse_utc.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kNow_ns = 1'700'000'000'000'000'000;  // 2023-11-14T22:13:20Z

class ItemFiles : public ::testing::Test {
 protected:
  using Json = nlohmann::json;

  static Json item(const std::string& type, const Json& coordinates) {
    return {{"type", "Feature"},
            {"geometry", {{"type", type}, {"coordinates", coordinates}}},
            {"properties", {{"kind", "queue"}, {"observed_utc", "2023-11-14T22:00:00Z"}}}};
  }
  [[nodiscard]] ItemFile read(const Json& feature,
                              const std::optional<GeoOrigin>& origin = std::nullopt) const {
    std::ofstream(folder_ / "items.geojson") << feature.dump();
    return read_item_file(folder_ / "items.geojson", origin, kNow_ns);
  }
  // The message about a file that is refused.
  [[nodiscard]] std::string fault_of(const Json& feature,
                                     const std::optional<GeoOrigin>& origin = std::nullopt) const {
    try {
      (void)read(feature, origin);
    } catch (const BadInput& bad) {
      EXPECT_EQ(bad.problems().size(), 1U);
      return to_line(bad.problems()[0]);
    }
    return "no fault";
  }
  test::Folder folder_;
};

TEST(ParseUtc, ReadsTimesWithAZoneAndNoOthers) {
  EXPECT_EQ(parse_utc("2023-11-14T22:13:20Z"), kNow_ns);
  EXPECT_EQ(parse_utc("2023-11-14 22:13:20.5Z"), kNow_ns + 500'000'000);
  EXPECT_EQ(parse_utc("2023-11-15T00:13:20+02:00"), kNow_ns);
  EXPECT_EQ(parse_utc("2023-11-14T16:43:20-05:30"), kNow_ns);
  EXPECT_EQ(parse_utc(utc_text(kNow_ns)), kNow_ns);
  EXPECT_EQ(parse_utc("2024-02-29T00:00:00Z"), 1'709'164'800'000'000'000);
  for (const char* wrong :
       {"", "2023-11-14", "2023-11-14T22:13:20", "2023-02-29T00:00:00Z", "2023-11-14T24:00:00Z",
        "2023-11-14T22:60:00Z", "2023-11-14T22:13:20Zx", "2023-11-14T22:13:20.Z",
        "1969-12-31T23:59:59Z", "2300-01-01T00:00:00Z", "2023-11-14T22:13:20+0200"})
    EXPECT_FALSE(parse_utc(wrong)) << wrong;
}

TEST_F(ItemFiles, ReadsAllGeometriesInMetres) {
  EXPECT_EQ(read(item("Point", {1, 2, 50})).items[0].parts[0][0], Eigen::Vector2d(1, 2));
  EXPECT_EQ(read(item("MultiPoint", {{1, 2}, {3, 4}})).items[0].parts.size(), 2U);
  EXPECT_EQ(read(item("LineString", {{1, 2}, {3, 4}})).items[0].reach_m, 5.0);
  EXPECT_EQ(
      read(item("MultiLineString", {{{1, 2}, {3, 4}}, {{5, 6}, {7, 8}}})).items[0].parts.size(),
      2U);
  const Json ring = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}};
  const Json hole = {{4, 4}, {6, 4}, {6, 6}, {4, 6}, {4, 4}};
  const LayerItem area = read(item("Polygon", {ring, hole})).items[0];
  EXPECT_EQ(area.shape, ItemShape::kPolygon);
  EXPECT_EQ(area.reach_m, 0.0);
  EXPECT_EQ(area.parts[0].size(), 4U) << "the closing point is not stored";
  EXPECT_EQ(area.distance_m({2, 2}), 0.0);
  EXPECT_NEAR(area.distance_m({5, 5}), 1.0, 1e-12);
  EXPECT_EQ(read(item("MultiPolygon", {{ring}, {hole}})).items[0].parts.size(), 2U);
}

TEST_F(ItemFiles, TakesWhatAPropertySaysAndDefaultsOtherwise) {
  Json feature = item("Point", {1, 2});
  feature["properties"].update(
      {{"half_life_s", 50}, {"speed_mps", 2.5}, {"reach_m", 9}, {"note", "long"}, {"fid", 7}});
  const ItemFile given = read(feature);
  EXPECT_EQ(given.items[0].half_life_s, 50.0);
  EXPECT_EQ(given.items[0].speed, 2.5);
  EXPECT_EQ(given.items[0].reach_m, 9.0);
  EXPECT_EQ(given.items[0].note, "long");
  ASSERT_EQ(given.notes.size(), 1U) << "a property that is no item's is named";
  EXPECT_EQ(given.notes[0].got, "fid");
  for (const char* name : {"half_life_s", "speed_mps", "reach_m", "note"})
    feature["properties"][name] = nullptr;  // as GIS programs write empty columns
  EXPECT_EQ(read(feature).items[0].half_life_s, 600.0);
  EXPECT_FALSE(read(feature).items[0].speed);
}

TEST_F(ItemFiles, ARingThatIsNotClosedIsClosedWithANote) {
  const ItemFile open = read(item("Polygon", {{{0, 0}, {10, 0}, {10, 10}}}));
  ASSERT_EQ(open.notes.size(), 1U);
  EXPECT_EQ(open.notes[0].field, "feature.geometry.coordinates[0][0]");
  EXPECT_EQ(open.items[0].parts[0].size(), 3U);
  EXPECT_EQ(open.items[0].distance_m({8, 2}), 0.0);
  EXPECT_TRUE(read(item("Polygon", {{{0, 0}, {9, 0}, {9, 9}, {0, 0}}})).notes.empty());
  EXPECT_NE(fault_of(item("Polygon", {{{0, 0}, {5, 0}, {9, 0}, {0, 0}}})).find("corners on a line"),
            std::string::npos);
}

TEST_F(ItemFiles, DegreesAreLongitudeThenLatitude) {
  const GeoOrigin origin{48.78, 9.18, 30.0};
  EXPECT_LT(read(item("Point", {9.18, 48.78}), origin).items[0].parts[0][0].norm(), 1e-6);
  EXPECT_NE(fault_of(item("Point", {48.78, 9.18}), origin).find("(here they are swapped)"),
            std::string::npos);
  EXPECT_NE(fault_of(item("Point", {500, 20}), origin).find("which are no degrees"),
            std::string::npos);
  EXPECT_NE(fault_of(item("Point", {10.18, 48.78}), origin).find("far from the map's origin"),
            std::string::npos);
  Json other = item("Point", {9.18, 48.78});
  other["crs"] = {{"type", "name"}, {"properties", {{"name", "EPSG:25832"}}}};
  EXPECT_NE(fault_of(other, origin).find("crs: got EPSG:25832, want none, or WGS84"),
            std::string::npos);
}

// Both forms of a polygon across the meridian of 180 degrees: cut (RFC 7946), and running on.
TEST_F(ItemFiles, APolygonAcrossTheMeridianOf180DegreesIsOneArea) {
  const GeoOrigin origin{-17.0, 180.0, 0.0};
  const auto ring = [](double west, double east) {
    return Json{
        {west, -17.001}, {east, -17.001}, {east, -16.999}, {west, -16.999}, {west, -17.001}};
  };
  const LayerItem cut =
      read(item("MultiPolygon", {{ring(179.999, 180.0)}, {ring(-180.0, -179.999)}}), origin)
          .items[0];
  const LayerItem whole =
      read(item("Polygon", Json::array({ring(179.999, 180.001)})), origin).items[0];
  for (const LayerItem& area : {cut, whole}) {
    EXPECT_EQ(area.distance_m({50.0, 30.0}), 0.0);
    EXPECT_EQ(area.distance_m({-50.0, 30.0}), 0.0);
    EXPECT_NEAR(area.distance_m({150.0, 0.0}), 150.0 - 106.47, 0.1);
  }
}

// Damaged files give items within bounds or a fault, and nothing else.
TEST_F(ItemFiles, AnyBytesGiveItemsOrAFault) {
  const Json ring = {{9.18, 48.78}, {9.1801, 48.78}, {9.1801, 48.7801}, {9.18, 48.78}};
  Json collection{{"type", "FeatureCollection"}, {"features", Json::array()}};
  collection["features"].push_back(item("MultiPolygon", Json::array({Json::array({ring})})));
  collection["features"].push_back(item("LineString", {{9.18, 48.78}, {9.1801, 48.7801}}));
  collection["features"].push_back(item("Point", {9.18, 48.78, 0}));
  collection["features"][0]["properties"]["half_life_s"] = 50;
  const std::string good = collection.dump();
  const std::vector<std::string> words{"null", "1e308", "-1",   "[",      "]",     "{}", "[[",
                                       "true", "\"\"",  "9e99", "1e-300", "Multi", ",",  "[]"};
  Random random(9, "bytes");
  int read_well = 0;
  for (int k = 0; k < 500; ++k) {
    std::string text = good;
    if (random.below(2) == 0) {  // a digit alone: most of these files are still JSON
      const std::size_t from = random.below(text.size());
      const std::size_t digit = text.find_first_of("0123456789", from);
      if (digit != std::string::npos) text[digit] = static_cast<char>('0' + random.below(10));
    } else {
      const std::size_t at = random.below(text.size());
      const std::string& word = words[random.below(words.size())];
      if (random.below(3) == 0)
        text[at] = static_cast<char>(random.below(256));
      else
        text.replace(at, random.below(12), word);
    }
    std::ofstream(folder_ / "any.geojson") << text;
    for (const auto& origin :
         {std::optional<GeoOrigin>(), std::optional(GeoOrigin{48.78, 9.18, 5})})
      try {
        for (const LayerItem& one :
             read_item_file(folder_ / "any.geojson", origin, kNow_ns).items) {
          EXPECT_TRUE(std::isfinite(one.distance_m({1.0, 2.0})));
          EXPECT_GT(one.half_life_s, 0.0);
          ++read_well;
        }
      } catch (const BadInput&) {
      }
  }
  EXPECT_GT(read_well, 100) << "some damage is harmless";
}

TEST_F(ItemFiles, ReadsBackFromTheMapAndRefusesATableThatContradictsItself) {
  const std::filesystem::path map = folder_ / "place.gpkg";
  MapFileBuilder(map, "key").finish(test::small_map(1), {});
  LayerItem area = read(item("Polygon", {{{0, 0}, {0.1, 0}, {1.0 / 3.0, 7}, {0, 0}}})).items[0];
  area.speed = 0.1;
  area.note = "a \"note\"";
  {
    MapUpdate update(map);
    append_items(update, MapLayers(map), {area}, {0}, kNow_ns + 5);
    update.commit();
  }
  const auto stored = read_items(MapLayers(map));
  ASSERT_EQ(stored.size(), 1U);
  EXPECT_EQ(stored[0].parts, area.parts) << "to the last bit";
  EXPECT_EQ(stored[0].speed, area.speed);
  EXPECT_FALSE(stored[0].grip_factor);
  EXPECT_EQ(stored[0].note, area.note);
  EXPECT_EQ(stored[0].expired_ns, kNow_ns + 5);
  const PlainTable good = MapLayers(map).read_table("layer_items");
  const auto refused = [&](std::size_t row, std::size_t column, const FieldValue& value) {
    PlainTable bad = good;
    bad.rows[row][column] = value;
    MapUpdate update(map);
    update.write_table(bad);
    update.commit();
    EXPECT_THROW((void)read_items(MapLayers(map)), BadInput) << row << " " << column;
  };
  refused(0, 0, std::int64_t{3});
  refused(0, 1, std::string("drop"));
  refused(0, 3, std::string("cloud"));
  refused(0, 4, std::string("circle"));
  refused(0, 5, std::string("[[[1]]]"));
  refused(0, 5, std::string("[[]]"));
  refused(0, 5, std::string("[[[1e300,0]]]"));
  refused(0, 8, 0.0);
  refused(0, 9, -1.0);
  refused(1, 0, std::int64_t{1});
}

}  // namespace
}  // namespace roadbook
