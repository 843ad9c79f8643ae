#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

#include "exchange/import/outline_shape.hpp"
#include "tests/exchange/import/foreign_files.hpp"
#include "tests/support/command_output.hpp"

// Exports labels, changes the file as other programs do, and imports it into the same map.

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

class KnownLabels : public test::ForeignFiles {
 protected:
  KnownLabels() {
    LabelStore store(map_);
    std::vector<Label> drawn;
    for (OrientedBox box : test::spaces_of(lot_)) {
      box.heading += 0.1234567;
      box.width_m = 2.3;  // neighbours do not overlap
      const auto c = box.corners();
      const std::vector<Eigen::Vector2d> corners(c.begin(), c.end());
      drawn.push_back(label_of_box(store.map(), *anchor_for(store.map(), corners), box));
      drawn.back().kind = test::kSpace;
    }
    const std::vector<Eigen::Vector2d> corners{{2, -1}, {4, -1}, {4.123, 1.5}, {3, 0.5}, {2, 1}};
    drawn.push_back(label_of_polygon(store.map(), *anchor_for(store.map(), corners), corners));
    drawn.back().kind = "crossing";
    store.create_all(drawn, "ann");
  }
  Json written(const std::string& format) const {
    ExportOptions options;
    options.origin = origin_;
    options.layers = {};
    export_map(map_, format, file_, options);
    std::ifstream in(file_);
    Json json = Json::parse(in);
    if (format == "geojson") keep_labels(json["features"]);
    return json;
  }
  static void keep_labels(Json& features) {
    Json kept = Json::array();
    for (const Json& one : features)
      if (one["properties"].contains("class")) kept.push_back(one);
    features = kept;
  }
  // Calls `change(number)` for each coordinate of a file.
  static void for_each_number(Json& file, const std::function<void(Json&)>& change) {
    const std::function<void(Json&)> all = [&](Json& value) {
      if (value.is_array())
        for (Json& one : value) all(one);
      else
        change(value);
    };
    if (file.contains("annotations"))
      for (Json& a : file["annotations"]) all(a["segmentation"]);
    else
      for (Json& f : file["features"]) all(f["geometry"]["coordinates"]);
  }
  static void round_all(Json& file, double scale) {
    for_each_number(file, [&](Json& v) { v = std::round(v.get<double>() * scale) / scale; });
  }
  void expect_all_known(const LabelImport& made) const {
    EXPECT_EQ(made.stored, 0U);
    EXPECT_EQ(made.changed, 0U);
    EXPECT_EQ(made.already, 7U);
    EXPECT_EQ(made.count_left_out(), 0U);
    EXPECT_EQ(labels().size(), 7U);
    for (const Label& label : labels()) EXPECT_EQ(label.version, 1);
  }
  // Leaves only geometry and class, as a program does that knows no other fields.
  static void strip(Json& file) {
    if (file.contains("annotations")) {
      for (Json& a : file["annotations"]) a.erase("attributes");
      for (Json& image : file["images"]) image.erase("world");
    } else {
      for (Json& f : file["features"]) f["properties"] = {{"class", f["properties"]["class"]}};
    }
  }
  Eigen::Vector2d middle_of_label(std::int64_t id) const {
    for (const Label& label : labels())
      if (label.id == id) return seen_in_map(load_map(map_), label)->middle;
    return {NAN, NAN};
  }
  Json& of_label(Json& file, std::int64_t id) const {
    for (Json& f : file["features"])
      if (f["properties"]["space"] == id) return f;
    throw std::runtime_error("no such label");
  }
  // Moves a label of a GeoJSON file to the east.
  void move(Json& feature, double metres) const {
    const double per_degree = 111.3e3 * std::cos(origin_->latitude_deg * M_PI / 180.0);
    for (Json& point : feature["geometry"]["coordinates"][0])
      point[0] = point[0].get<double>() + metres / per_degree;
  }
};

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

TEST_F(KnownLabels, AMovedLabelIsAnEditOfTheSameLabel) {
  for (const double metres : {0.3, 3.0}) {
    const Eigen::Vector2d before = middle_of_label(6);
    Json file = written("geojson");
    move(of_label(file, 6), metres);
    round_all(file, 1e7);
    const LabelImport made = take("geojson", file);
    EXPECT_EQ(made.stored, 0U);
    EXPECT_EQ(made.changed, 1U);
    EXPECT_EQ(made.already, 6U);
    EXPECT_EQ(labels().size(), 7U);
    EXPECT_LT((middle_of_label(6) - before - Eigen::Vector2d(metres, 0.0)).norm(), 0.02);
    LabelStore store(map_);  // one step, which its author undoes
    EXPECT_EQ(store.undo("ann").size(), 1U);
  }
}

TEST_F(KnownLabels, AnotherClassOrNoteIsAnEditToo) {
  Json file = written("geojson");
  of_label(file, 2)["properties"]["class"] = "loading_bay";
  of_label(file, 3)["properties"]["note"] = "worn";
  const LabelImport made = take("geojson", file);
  EXPECT_EQ(made.changed, 2U);
  EXPECT_EQ(made.already, 5U);
  EXPECT_EQ(labels()[1].kind, "loading_bay");
  EXPECT_EQ(labels()[2].note, "worn");
  EXPECT_EQ(labels()[2].length_m, 5.0);
}

TEST_F(KnownLabels, ThroughCocoTheyAreEditedAsWell) {
  Json file = written("coco");
  ASSERT_EQ(file["annotations"][0]["attributes"]["space"], 1);
  auto& ring = file["annotations"][0]["segmentation"][0];
  for (std::size_t i = 0; i < ring.size(); i += 2) ring[i] = ring[i].get<double>() + 10.0;
  const LabelImport made = take("coco", file);
  EXPECT_EQ(made.changed, 1U);
  EXPECT_EQ(made.already, 6U);
  EXPECT_EQ(labels()[0].version, 2);
  EXPECT_EQ(labels()[0].shape, LabelShape::kBox);
}

TEST_F(KnownLabels, ACopyIsANewLabel) {
  Json file = written("geojson");
  Json copy = of_label(file, 6);
  move(copy, 2.6);
  file["features"].push_back(copy);
  const LabelImport made = take("geojson", file);
  EXPECT_EQ(made.stored, 1U);
  EXPECT_EQ(made.already, 7U);
  EXPECT_EQ(labels().size(), 8U);
}

TEST_F(KnownLabels, WhatSomebodyHasChangedSinceIsNotOverwritten) {
  Json file = written("geojson");
  {
    LabelStore store(map_);
    Label label = *store.find(6);
    label.T_vehicle_label.translation().x() += 0.5;
    store.change(label, "bob");
    label = *store.find(5);
    label.T_vehicle_label.translation().x() += 0.5;
    store.change(label, "bob");
  }
  move(of_label(file, 6), 0.3);
  const LabelImport made = take("geojson", file);
  EXPECT_EQ(made.changed, 0U);
  EXPECT_EQ(made.stored, 0U);
  EXPECT_EQ(made.already, 6U);  // 5 is as old as the file, which says nothing new of it
  ASSERT_EQ(made.count_left_out(), 1U);
  EXPECT_TELLS(to_line(made.left_out[0].reason),
               "label 6, which was changed in the map since the file was written");
}

// Without the number, the importer cannot know whether the label moved or the file holds a second
// label next to it.
TEST_F(KnownLabels, NoTwinLiesOnItsTwin) {
  Json file = written("geojson");
  strip(file);
  for (Json& f : file["features"]) move(f, 0.2);
  const LabelImport made = take("geojson", file);
  EXPECT_EQ(made.stored, 0U);
  EXPECT_EQ(made.count_left_out(), 7U);
  EXPECT_EQ(labels().size(), 7U);
  EXPECT_TELLS(to_line(made.left_out.back().reason), "got an outline on label 6 (overlap 0.8");
}

// Numbers from another map identify other labels there.
TEST_F(KnownLabels, ANumberOfAnotherMapIsNotBelieved) {
  Json file = written("geojson");
  for (Json& f : file["features"]) {
    f["properties"]["edited_utc"] = "2013-01-01T00:00:00.000Z";
    move(f, 0.2);
  }
  const LabelImport made = take("geojson", file);
  EXPECT_EQ(made.changed, 0U);
  EXPECT_EQ(made.stored, 0U);
  EXPECT_EQ(made.count_left_out(), 7U);
}

TEST_F(KnownLabels, ALabelMovedOntoAnotherIsLeftOut) {
  Json file = written("geojson");
  const Eigen::Vector2d apart = middle_of_label(5) - middle_of_label(6);
  move(of_label(file, 6), apart.x() + 0.1);
  const LabelImport made = take("geojson", file);
  EXPECT_EQ(made.changed, 0U);
  ASSERT_EQ(made.count_left_out(), 1U);
  EXPECT_TELLS(to_line(made.left_out[0].reason), "an outline on label 5");
}

TEST(OutlineShapes, TheStepOfDecimalsIsFound) {
  EXPECT_EQ(rounding_step({1028.0, 249.99999999999977}), 1.0);
  EXPECT_EQ(rounding_step({1028.5, 3.0}), 0.1);
  EXPECT_EQ(rounding_step({8.5418135, 47.376871}), 1e-7);
  const double single = static_cast<double>(1196.54716F);
  EXPECT_NEAR(rounding_step({single, 0.5}), std::pow(2.0, -13.0), 1e-12);  // 24 bits up to 2048
  EXPECT_EQ(rounding_step({1196.5471621825359}), 0.0);
  EXPECT_EQ(rounding_step({}), 0.0);
}

TEST(OutlineShapes, OverlapAndDistanceAreTheOnesWorkedByHand) {
  const std::vector<Eigen::Vector2d> a{{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  const std::vector<Eigen::Vector2d> b{{1, 0}, {3, 0}, {3, 1}, {1, 1}};
  EXPECT_NEAR(intersection_over_union(a, b), 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(outline_distance(a, b), 1.0, 1e-12);
  EXPECT_EQ(intersection_over_union(a, {{5, 5}, {6, 5}, {6, 6}}), 0.0);
  EXPECT_NEAR(outline_distance(a, {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}}), 0.0, 1e-12);
}

}  // namespace
}  // namespace roadbook
