#include "tests/exchange/import/known_labels.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

#include "tests/support/command_output.hpp"

// Exports labels, changes the file as other programs do, and imports it into the same map.

namespace roadbook {
namespace {

using test::KnownLabels;

TEST_F(KnownLabels, AreKnownByOverlapAfterAnyRoundingOfPixels) {
  for (const double scale : {1.0, 2.0, 10.0, 100.0}) {
    Json file = written("coco");
    round_all(file, scale);
    expect_all_known(take("coco", file));
    strip(file);
    expect_all_known(take("coco", file));
  }
}

// An earlier version of Label Studio cut off digits.
TEST_F(KnownLabels, AreKnownWithTheirDigitsCutOff) {
  Json file = written("coco");
  for_each_number(file, [](Json& v) { v = std::floor(v.get<double>()); });
  strip(file);
  expect_all_known(take("coco", file));
}

TEST_F(KnownLabels, AreKnownAfterAnyRoundingOfDegrees) {
  for (const double scale : {1e9, 1e8, 1e7, 1e6}) {
    Json file = written("geojson");
    round_all(file, scale);
    expect_all_known(take("geojson", file));
    strip(file);
    expect_all_known(take("geojson", file));
  }
}

TEST_F(KnownLabels, AreKnownInSinglePrecision) {
  Json file = written("coco");
  for_each_number(file, [](Json& v) { v = static_cast<double>(static_cast<float>(v)); });
  strip(file);
  expect_all_known(take("coco", file));
}

TEST_F(KnownLabels, AreKnownInAnyOrderOfCornersAndAsMultiPolygons) {
  Json file = written("geojson");
  for (Json& f : file["features"]) {
    Json& rings = f["geometry"]["coordinates"];
    auto& ring = rings[0].get_ref<Json::array_t&>();
    ring.pop_back();
    std::reverse(ring.begin(), ring.end());
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
    ring.push_back(ring.front());
    f["geometry"] = {{"type", "MultiPolygon"}, {"coordinates", Json::array({rings})}};
  }
  expect_all_known(take("geojson", file));
  strip(file);
  expect_all_known(take("geojson", file));
}

TEST_F(KnownLabels, AreKnownWhereTheMeridianOf180DegreesCutsThem) {
  origin_ = GeoOrigin{-16.5, 179.99997, 0.0};  // the meridian lies 3.2 m to the east
  Json file = written("geojson");
  const auto& features = file["features"];
  EXPECT_GE(std::count_if(features.begin(), features.end(),
                          [](const Json& f) { return f["geometry"]["type"] == "MultiPolygon"; }),
            3);
  expect_all_known(take("geojson", file));
  strip(file);
  expect_all_known(take("geojson", file));
}

// A turned rectangle as CVAT writes it: two decimals of a pixel, one of a degree, no polygon.
TEST_F(KnownLabels, AreKnownAsTurnedRectangles) {
  const Map map = load_map(map_);
  std::vector<Json> annotations;
  for (const Label& label : labels()) {
    const auto box = box_in_map(map, label);
    if (!box) continue;
    const auto rounded = [](double value, double scale) {
      return std::round(value * scale) / scale;
    };
    const Eigen::Vector2d size(box->length_m / lot_.resolution_m, box->width_m / lot_.resolution_m);
    const Eigen::Vector2d low = pixel(box->centre.x(), box->centre.y()) - 0.5 * size;
    const double clockwise_deg = -box->heading * 180.0 / M_PI;
    annotations.push_back(
        {{"bbox",
          {rounded(low.x(), 100), rounded(low.y(), 100), rounded(size.x(), 100),
           rounded(size.y(), 100)}},
         {"segmentation", Json::array()},
         {"attributes", {{"occluded", false}, {"rotation", rounded(clockwise_deg, 10)}}}});
  }
  const LabelImport made = take("coco", coco(annotations));
  EXPECT_EQ(made.already, 6U);
  EXPECT_EQ(total(made), 6U);
}

// GDAL converts the file through formats of GIS programs. They have seven decimals, and shapefiles
// are clockwise.
TEST_F(KnownLabels, AreKnownAfterAWayThroughGdal) {
  const auto through = [&](const std::string& options, const std::string& name) {
    std::ofstream(folder_ / "own.geojson") << written("geojson").dump();
    const auto other = folder_ / name;
    const auto back = folder_ / "back.geojson";
    std::filesystem::remove(back);
    int status = 0;
    const std::string said = test::output_of("ogr2ogr " + options + " " + other.string() + " " +
                                                 (folder_ / "own.geojson").string() +
                                                 " 2>&1 && ogr2ogr -f GeoJSON -lco RFC7946=YES " +
                                                 back.string() + " " + other.string() + " 2>&1",
                                             &status);
    EXPECT_EQ(status, 0) << said;
    return import_labels(map_, "geojson", back, "bob", origin_);
  };
  expect_all_known(through("-f GeoJSON -lco RFC7946=YES -nlt PROMOTE_TO_MULTI", "a.geojson"));
  expect_all_known(through("-f GPKG -nln labels", "a.gpkg"));
  expect_all_known(through("-f \"ESRI Shapefile\"", "a.shp"));
}

TEST_F(KnownLabels, AreKnownInYoloOfFewDigitsAndAsBoxesAroundThem) {
  const auto folder = folder_ / "yolo";
  export_map(map_, "yolo", folder);
  for (const int digits : {6, 5, 4}) {
    std::ifstream in(folder / "labels" / "overhead.txt");
    std::ostringstream rounded;
    std::ostringstream around;
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      int kind = 0;
      words >> kind;
      rounded << kind << std::fixed << std::setprecision(digits);
      around << kind << std::fixed << std::setprecision(digits);
      Eigen::AlignedBox2d box;
      for (Eigen::Vector2d p; words >> p.x() >> p.y();) {
        rounded << " " << p.x() << " " << p.y();
        box.extend(p);
      }
      rounded << "\n";
      around << " " << box.center().x() << " " << box.center().y() << " " << box.sizes().x() << " "
             << box.sizes().y() << "\n";
    }
    for (const std::string& rows : {rounded.str(), around.str()}) {
      const auto other = yolo("names: [parking_space, crossing]\n", rows);
      expect_all_known(import_labels(map_, "yolo", other, "bob"));
      export_map(map_, "yolo", folder);
    }
  }
}

}  // namespace
}  // namespace roadbook
