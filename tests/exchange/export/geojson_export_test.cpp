#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"
#include "exchange/export/geo_origin.hpp"
#include "exchange/import/geojson_geometry.hpp"
#include "tests/exchange/driven_place.hpp"
#include "tests/support/command_output.hpp"

namespace roadbook {
namespace {

using GeoJson = nlohmann::json;
using test::Folder;
using test::output_of;

GeoJson read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  return GeoJson::parse(in);
}

constexpr GeoOrigin kZurich{47.3769, 8.5417, 0.0};

TEST(GeojsonExport, AFolderGetsAFileALayerAndNoLandmarksUnlessAskedFor) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  ExportNotes notes;
  const auto files = export_map(map, "geojson", folder / "layers", {.origin = kZurich}, &notes);
  std::set<std::string> names;
  for (const auto& file : files) {
    names.insert(file.filename().string());
    for (const GeoJson& feature : read_json(file).at("features"))
      EXPECT_EQ(feature.at("properties").at("layer").get<std::string>() + ".geojson",
                file.filename().string());
  }
  EXPECT_EQ(names, (std::set<std::string>{"intersections.geojson", "lane_paths.geojson",
                                          "lanes.geojson", "poses.geojson"}));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].what, "features of layer landmark_points");
  EXPECT_EQ(notes[0].count, 40U);
  // A single file holds the same features. The export can write it into an existing folder under
  // any name.
  export_map(map, "geojson", folder / "all.geojson", {.origin = kZurich});
  std::size_t features = 0;
  for (const auto& file : files) features += read_json(file).at("features").size();
  EXPECT_EQ(read_json(folder / "all.geojson").at("features").size(), features);
  std::filesystem::create_directory(folder / "v1.0");
  const auto asked =
      export_map(map, "geojson", folder / "v1.0",
                 {.origin = kZurich, .layers = {"landmark_points", "lanes"}}, &notes);
  EXPECT_EQ(asked.size(), 2U);
  EXPECT_EQ(notes.size(), 1U);
  EXPECT_EQ(read_json(folder / "v1.0/landmark_points.geojson").at("features").size(), 40U);
  const auto lanes = read_json(folder / "layers/lanes.geojson").at("features").size();
  EXPECT_GT(lanes, 3U);
  EXPECT_NE(output_of("ogrinfo -so -al " + (folder / "layers/lanes.geojson").string())
                .find("Feature Count: " + std::to_string(lanes)),
            std::string::npos);
}

// Area [m^2] of rings in degrees about a latitude, by radii of curvature of the WGS84 ellipsoid.
double area_of(const GeoJson& rings, double latitude_deg) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double s = std::sin(latitude_deg * kDegree);
  const double w = 1.0 - 0.00669437999014 * s * s;
  const double north = 6378137.0 * (1.0 - 0.00669437999014) / std::pow(w, 1.5) * kDegree;
  const double east = 6378137.0 / std::sqrt(w) * std::cos(latitude_deg * kDegree) * kDegree;
  double twice = 0.0;
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    twice += east * north *
             (rings[i][0].get<double>() * (rings[i + 1][1].get<double>() - latitude_deg) -
              rings[i + 1][0].get<double>() * (rings[i][1].get<double>() - latitude_deg));
  return 0.5 * twice;
}

TEST(GeojsonExport, WhatCrossesTheAntimeridianIsCutThere) {
  // The map's origin lies 1.07 m west of the meridian.
  const GeoOrigin origin{-16.5, 179.99999, 0.0};
  const ToDegrees to_degrees(origin);
  // Concave: the meridian cuts it into three parts.
  const std::vector<Eigen::Vector4d> comb{{0, 0, 1, 0},   {4, 0, 2, 0},   {4, 1, 2, 0},
                                          {0.2, 1, 1, 0}, {0.2, 2, 1, 0}, {4, 2, 2, 0},
                                          {4, 3, 2, 0},   {0, 3, 1, 0},   {0, 0, 1, 0}};
  const GeoJson polygon = geojson_geometry(GeometryType::kPolygonZ, comb, to_degrees);
  ASSERT_EQ(polygon.at("type"), "MultiPolygon");
  ASSERT_EQ(polygon.at("coordinates").size(), 3U);
  double area = 0.0;
  for (const GeoJson& part : polygon.at("coordinates")) {
    ASSERT_EQ(part.size(), 1U);
    EXPECT_EQ(part[0].front(), part[0].back());
    std::set<bool> east;
    for (const GeoJson& p : part[0]) {
      EXPECT_LE(std::abs(p[0].get<double>()), 180.0);
      if (std::abs(p[0].get<double>()) < 180.0) east.insert(p[0] > 0.0);
      EXPECT_TRUE(p[2] >= 1.0 && p[2] <= 2.0) << p;
    }
    EXPECT_EQ(east.size(), 1U);
    EXPECT_GT(area_of(part[0], origin.latitude_deg), 0.0) << "rings go counter-clockwise";
    area += area_of(part[0], origin.latitude_deg);
  }
  EXPECT_NEAR(area, 4.0 * 3.0 - 3.8, 1e-3);

  const GeoJson line = geojson_geometry(GeometryType::kLineStringZ,
                                        {{-5, 0, 0, 0}, {5, 2, 1, 0}, {-5, 4, 2, 0}}, to_degrees);
  ASSERT_EQ(line.at("type"), "MultiLineString");
  EXPECT_EQ(line.at("coordinates").size(), 3U);
  const GeoJson point = geojson_geometry(GeometryType::kPointZ, {{5, 0, 0, 0}}, to_degrees);
  EXPECT_NEAR(point.at("coordinates")[0].get<double>(), -179.99996, 1e-5);

  // If the ring lies west of the meridian or far from it, the export does not cut it.
  for (const GeoOrigin& other : {GeoOrigin{-16.5, 179.999, 0.0}, kZurich})
    EXPECT_EQ(geojson_geometry(GeometryType::kPolygonZ, comb, ToDegrees(other)).at("type"),
              "Polygon");
}

TEST(GeojsonExport, PartsOfARingThatWasCutJoinAgain) {
  const ToDegrees to_degrees({-16.5, 179.99999, 0.0});
  const std::vector<Eigen::Vector4d> box{
      {-2, -1, 0, 0}, {3, 1, 0, 0}, {2, 3.5, 0, 0}, {-3, 1.5, 0, 0}, {-2, -1, 0, 0}};
  const GeoJson cut = geojson_geometry(GeometryType::kPolygonZ, box, to_degrees);
  ASSERT_EQ(cut.at("coordinates").size(), 2U);
  const GeoJson ring = joined_at_antimeridian(cut.at("coordinates"));
  ASSERT_EQ(ring.size(), box.size()) << ring;
  // The ring has the same corners in the same direction, but it may start at another corner.
  std::size_t first = 0;
  const auto corner = [&](std::size_t i) {
    return *to_degrees.inverse({ring[i % 4][0].get<double>(), ring[i % 4][1].get<double>()});
  };
  while (first < 4 && (corner(first) - box[0].head<2>()).norm() > 1e-3) ++first;
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((corner(first + i) - box[i].head<2>()).norm(), 1e-3) << ring;
  // Two separate polygons do not join to one ring.
  EXPECT_TRUE(joined_at_antimeridian(
                  GeoJson::parse("[[[[0,0],[1,0],[1,1],[0,0]]],[[[5,0],[6,0],[6,1],[5,0]]]]"))
                  .is_null());
  EXPECT_TRUE(joined_at_antimeridian(GeoJson::parse("[[[1,2]]]")).is_null());
}

TEST(GeojsonExport, BothWritingsOfALongitudeBeyondTheMeridianAreOnePlace) {
  const ToDegrees to_degrees({-16.5, 179.99999, 30.0});
  const Eigen::Vector2d p(5.0, -3.0);
  const Eigen::Vector2d degrees = to_degrees(p);
  EXPECT_LT(degrees.x(), 0.0);
  for (const double turn : {0.0, 360.0}) {
    const auto back = to_degrees.inverse(degrees + Eigen::Vector2d(turn, 0.0));
    ASSERT_TRUE(back);
    EXPECT_LT((*back - p).norm(), 1e-6);
  }
}

TEST(GeojsonExport, RingsRoundAPoleHaveNoFormInDegrees) {
  const ToDegrees to_degrees({89.0, 10.0, 0.0});
  std::vector<Eigen::Vector4d> ring;
  for (int i = 0; i <= 8; ++i)
    ring.emplace_back(111694.0 * 0.0 + 3000.0 * std::cos(i * std::numbers::pi / 4.0),
                      111694.0 + 3000.0 * std::sin(i * std::numbers::pi / 4.0), 0.0, 0.0);
  EXPECT_TRUE(geojson_geometry(GeometryType::kPolygonZ, ring, to_degrees).is_null());
  // A ring that does not enclose the pole has a form, even if its longitudes are far apart.
  for (Eigen::Vector4d& p : ring) p.y() -= 8000.0;
  EXPECT_EQ(geojson_geometry(GeometryType::kPolygonZ, ring, to_degrees).at("type"), "Polygon");
  EXPECT_THROW(GeoOrigin({90.0, 0.0, 0.0}).check(), InvalidOption);
}

TEST(GeojsonExport, OutlinesFromElsewhereCarryTheClassThatTheirLayerIsNamedFor) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  MapUpdate update(map);
  for (const char* name : {"parking_spaces", "crossings"}) {
    VectorLayer layer;
    layer.name = name;
    layer.type = GeometryType::kPolygonZ;
    layer.fields = {{"source", FieldType::kText}};
    layer.features = {{{{0, 0, 0, 0}, {5, 0, 0, 0}, {5, 2, 0, 0}, {0, 2, 0, 0}, {0, 0, 0, 0}},
                       {std::string("truth")}}};
    update.write_layer(layer);
  }
  update.commit();
  export_map(map, "geojson", folder / "layers", {.origin = kZurich});
  for (const auto& [layer, kind] :
       {std::pair{"parking_spaces", "parking_space"}, {"crossings", "crossing"}}) {
    const GeoJson file = read_json(folder / (std::string("layers/") + layer + ".geojson"));
    EXPECT_EQ(file.at("features").at(0).at("properties"),
              (GeoJson{{"layer", layer}, {"source", "truth"}, {"class", kind}}));
  }
}

}  // namespace
}  // namespace roadbook
