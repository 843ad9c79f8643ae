#include <gtest/gtest.h>

#include <fstream>

#include "base/error.hpp"
#include "exchange/import/import_labels.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/mapping/store/small_map.hpp"

// Tests the messages about label files that cannot be imported.

namespace roadbook {
namespace {

class WrongLabelFiles : public ::testing::Test {
 protected:
  WrongLabelFiles() {
    lot_.spaces_a_side = 3;
    test::write_lot(map_, lot_);
  }
  std::string fault(const std::string& format,
                    const std::string& text,
                    const std::optional<GeoOrigin>& origin = std::nullopt) {
    std::filesystem::path file = folder_ / "labels.json";
    if (format == "yolo") {
      file = folder_ / "yolo";
      std::filesystem::create_directories(file / "labels");
      std::ofstream(file / "data.yaml") << "names: [parking_space, crossing]\n";
      std::ofstream(file / "labels" / "overhead.txt") << text;
    } else {
      std::ofstream(file) << text;
    }
    try {
      import_labels(map_, format, file, "ann", origin);
    } catch (const Error& error) {
      EXPECT_TRUE(read_labels(map_).empty());
      return error.what();
    }
    return "taken";
  }
  // A COCO file of one annotation.
  std::string coco(const std::string& annotation) const {
    const test::LotPicture picture(lot_);
    return R"({"images":[{"id":1,"width":)" + std::to_string(picture.place().columns) +
           R"(,"height":)" + std::to_string(picture.place().rows) +
           R"(}],"categories":[{"id":4,"name":"parking_space"}],"annotations":[)" + annotation +
           "]}";
  }
  test::Folder folder_;
  std::filesystem::path map_ = folder_ / "lot.gpkg";
  test::Lot lot_;
};

#define EXPECT_SAYS(text, words) EXPECT_NE((text).find(words), std::string::npos) << (text)

TEST_F(WrongLabelFiles, CocoFieldsAreNamed) {
  EXPECT_SAYS(fault("coco", "{\n\n]"), "labels.json:3: text: got no JSON");
  EXPECT_SAYS(fault("coco", "[1e999]"), "labels.json:1: [0]: got a number that is too large");
  EXPECT_SAYS(fault("coco", "{}"), "images: got nothing, want a list");
  EXPECT_SAYS(fault("coco", R"({"images":[{"id":1,"width":5,"height":7}]})"),
              "got 5 x 7 pixels, want ");
  EXPECT_SAYS(
      fault("coco", coco(R"({"image_id":1,"category_id":"4","segmentation":[[1,1,2,1,2,2]]})")),
      "annotations[0].category_id: got \"4\", want a whole number");
  EXPECT_SAYS(
      fault("coco", coco(R"({"image_id":1,"category_id":5,"segmentation":[[1,1,2,1,2,2]]})")),
      "annotations[0].category_id: got 5, want an id of `categories`");
  EXPECT_SAYS(fault("coco", coco(R"({"image_id":1,"category_id":4,"segmentation":[[1,1,2,1,2]]})")),
              "annotations[0].segmentation: got 5 numbers, want pairs");
  EXPECT_SAYS(
      fault("coco",
            coco(R"({"image_id":1,"category_id":4,"segmentation":[[10,10,90,90,90,10,10,90]]})")),
      "annotations[0].segmentation: got a polygon that crosses itself");
  EXPECT_SAYS(
      fault("coco", coco(R"({"image_id":1,"category_id":4,"segmentation":{"counts":"x"}})")),
      "got a run-length mask, want a polygon");
  EXPECT_SAYS(fault("coco", coco(R"({"image_id":1,"category_id":4,"bbox":[1e9,0,3,4]})")),
              "no part in the image, want an outline that lies in the image");
}

// A field of a wrong type is an error; the importer does not treat it as a missing field.
TEST_F(WrongLabelFiles, CocoFieldsOfAnotherKindAreNotPassedOver) {
  const auto with = [this](const std::string& more) {
    return fault("coco",
                 coco(R"({"image_id":1,"category_id":4,"bbox":[90,90,30,40],)" + more + "}"));
  };
  const std::string where = "labels.json: annotations[0].";
  EXPECT_SAYS(with(R"("segmentation":"x")"), where + R"(segmentation: got "x", want a polygon)");
  EXPECT_SAYS(with(R"("segmentation":7)"), where + "segmentation: got 7, want a polygon");
  EXPECT_SAYS(with(R"("segmentation":true)"), where + "segmentation: got true, want a polygon");
  EXPECT_SAYS(with(R"("segmentation":{"counts":"x"})"), "got a run-length mask, want a polygon");
  EXPECT_SAYS(with(R"("segmentation":[[1,1,"2",1,2,2]])"),
              where + "segmentation: got no numbers, want one list of numbers");
  EXPECT_SAYS(with(R"("attributes":[1])"), where + "attributes: got [1], want an object");
  EXPECT_SAYS(with(R"("attributes":{"note":5})"), where + "attributes.note: got 5, want text");
  EXPECT_SAYS(with(R"("attributes":{"shape":"bxo"})"),
              where + R"(attributes.shape: got "bxo", want box or polygon)");
  EXPECT_SAYS(with(R"("attributes":{"heading_rad":"N"})"),
              where + R"(attributes.heading_rad: got "N", want a number of radians)");
  EXPECT_SAYS(fault("coco", coco(R"({"image_id":1,"category_id":4,"bbox":[90,90,-30,40]})")),
              where + "bbox: got [90,90,-30,40], want x, y, width, height");
  std::string twice = coco(R"({"image_id":1,"category_id":4,"bbox":[90,90,30,40]})");
  twice.insert(twice.find("],\"annotations\""), R"(,{"id":4,"name":"crossing"})");
  EXPECT_SAYS(fault("coco", twice), "categories[1].id: got 4, want one that no other category has");
  // The field is missing, empty, or specific to the writer.
  EXPECT_EQ(with(R"("segmentation":[],"attributes":{"note":null,"occluded":false})"), "taken");
}

TEST_F(WrongLabelFiles, PolygonsThatTouchThemselvesAreNone) {
  const auto polygon = [this](const std::string& ring) {
    return fault("coco", coco(R"({"image_id":1,"category_id":4,"segmentation":[[)" + ring + "]]}"));
  };
  const char* const touches = "annotations[0].segmentation: got a polygon that touches itself";
  EXPECT_SAYS(polygon("10,10,50,10,30,30,50,50,10,50,30,30"),
              touches);                                                // two corners are one place
  EXPECT_SAYS(polygon("10,10,50,10,50,50,30,10,10,50"), touches);      // a corner on a side
  EXPECT_SAYS(polygon("10,10,50,10,90,10,50,10,50,50"), touches);      // there and back
  EXPECT_EQ(polygon("10,10,50,10,50,10,50,50,10,50,10,10"), "taken");  // a corner given twice
}

TEST_F(WrongLabelFiles, ScoresSizesAndNamesHaveARange) {
  const auto scored = [this](const std::string& score) {
    return fault("coco", coco(R"({"image_id":1,"category_id":4,"bbox":[90,90,30,40],"score":)" +
                              score + "}"));
  };
  EXPECT_SAYS(scored("7"), "annotations[0].score: got 7, want 0 to 1");
  EXPECT_SAYS(scored("\"x\""), "annotations[0].score: got \"x\", want 0 to 1");
  EXPECT_SAYS(fault("coco", R"({"images":[{"id":1,"width":4294967300,"height":7}]})"),
              "images[0].width: got 4294967300, want 1 to 1000000");
  const auto named = [this](const std::string& name) {
    std::string text = coco(R"({"image_id":1,"category_id":4,"bbox":[90,90,30,40]})");
    return fault("coco", text.replace(text.find("parking_space"), 13, name));
  };
  EXPECT_SAYS(named(""), "labels.json: categories[0].name: got '', want 1 to 64 printable");
  EXPECT_SAYS(named("a\\nb"), "categories[0].name: got a control character");
  EXPECT_SAYS(named(std::string(65, 'a')), "categories[0].name: got 65 characters");
  EXPECT_SAYS(fault("coco", coco(R"({"image_id":1,"category_id":4,"bbox":[90,90,9000,0.01]})")),
              "labels.json: annotations[0].segmentation: got ");
}

// A label without uncertainty would outweigh all other evidence. A label with more than 10 m is
// implausible in a car park.
TEST_F(WrongLabelFiles, HowExactALabelIsHasARange) {
  const auto exact = [](const std::string& sigma_m) {
    return R"({"image_id":1,"category_id":4,"bbox":[90,90,30,40],"attributes":{"sigma_m":)" +
           sigma_m + "}}";
  };
  EXPECT_SAYS(fault("coco", coco(exact("-1"))),
              "annotations[0].segmentation: got sigma_m -1.000000, want above 0, at most 10 m");
  EXPECT_SAYS(fault("coco", coco(exact("0"))), "got sigma_m 0.000000, want above 0");
  EXPECT_SAYS(fault("coco", coco(exact("10.1"))), "got sigma_m 10.100000, want above 0, at most");
  EXPECT_SAYS(fault("coco", coco(exact("\"exact\""))), "attributes.sigma_m: got \"exact\", want");
  EXPECT_EQ(fault("coco", coco(exact("10"))), "taken");
  ASSERT_EQ(read_labels(map_).size(), 1U);
  EXPECT_NEAR(*sigma_in_map(load_map(map_), read_labels(map_).front()), 10.0, 1e-9);
}

TEST_F(WrongLabelFiles, YoloRowsAreNamed) {
  EXPECT_SAYS(fault("yolo", "0 0.5 0.5 0.6 0.5 0.6 0.6\n7 0.5 0.5 0.1 0.1\n"),
              "overhead.txt:2: class: got 7, want 0 to 1");
  EXPECT_SAYS(fault("yolo",
                    "\xEF\xBB\xBF"
                    "0\t0.5\t y  0.1 0.1\r\n"),
              "overhead.txt:1: column 3: got y");
  EXPECT_SAYS(fault("yolo", "0 0.5 x 0.1 0.1\n"), "overhead.txt:1: column 3: got x");
  EXPECT_SAYS(fault("yolo", "0 0.5 0.5 0.1\n"), "overhead.txt:1: row: got 4 columns");
  EXPECT_SAYS(fault("yolo", "1 0.4 0.4 0.6 0.6 0.6 0.4 0.4 0.6\n"),
              "a polygon that crosses itself");
}

TEST_F(WrongLabelFiles, GeoJsonNeedsThePlaceOfTheMapAndDegreesNearIt) {
  const auto polygon = [](const std::string& ring, const std::string& more) {
    return R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{)" + more +
           R"(},"geometry":{"type":"Polygon","coordinates":[)" + ring + "]}}]}";
  };
  const std::string degrees =
      "[[8.5417,47.3769],[8.54171,47.3769],[8.54171,47.37691],[8.5417,47.3769]]";
  const GeoOrigin here{47.3769, 8.5417, 0.0};
  EXPECT_SAYS(fault("geojson", polygon(degrees, R"("class":"bay")")),
              "origin: got none, want latitude and longitude");
  EXPECT_SAYS(
      fault("geojson", polygon("[[0,0],[500,0],[500,300],[0,0]]", R"("class":"bay")"), here),
      "want longitude, latitude of this place in degrees");
  EXPECT_SAYS(fault("geojson",
                    polygon("[[47.3769,8.5417],[47.377,8.5417],[47.377,8.542],[47.3769,8.5417]]",
                            R"("class":"bay")"),
                    here),
              "far from the map's origin");
  EXPECT_SAYS(fault("geojson", polygon(degrees, R"("name":"bay")"), here),
              "features[0].properties.class: got nothing");
  EXPECT_SAYS(fault("geojson", polygon(degrees, R"("class":"bay","sigma_m":"x")"), here),
              "features[0].properties.sigma_m: got \"x\", want a number of metres");
  EXPECT_SAYS(
      fault("geojson",
            polygon("[[8.5417,47.3769],[8.54175,47.37695],[8.54175,47.3769],[8.5417,47.37695],"
                    "[8.5417,47.3769]]",
                    R"("class":"bay")"),
            here),
      "a polygon that crosses itself");
  const auto with = [&](const std::string& more) {
    return fault("geojson", polygon(degrees, R"("class":"bay",)" + more), here);
  };
  const std::string where = "labels.json: features[0].properties.";
  EXPECT_SAYS(with(R"("length_m":"five")"), where + R"(length_m: got "five", want a number)");
  EXPECT_SAYS(with(R"("length_m":5,"width_m":-2)"), where + "width_m: got -2, want a number");
  EXPECT_SAYS(with(R"("note":5)"), where + "note: got 5, want text");
  const auto in_crs = [&](const std::string& crs) {
    std::string text = polygon(degrees, R"("class":"bay")");
    return fault("geojson", text.insert(1, R"("crs":)" + crs + ","), here);
  };
  EXPECT_SAYS(in_crs(R"({"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::3857"}})"),
              "labels.json: crs: got urn:ogc:def:crs:EPSG::3857, want none, or WGS84");
  EXPECT_SAYS(in_crs("7"), "labels.json: crs: got 7, want none, or WGS84");
  EXPECT_EQ(in_crs(R"({"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}})"),
            "taken");
  // Other programs close a ring to their last digit.
  const std::string nearly =
      "[[8.5417,47.3769],[8.54171,47.3769],[8.54171,47.37691],[8.54170001,47.376899999]]";
  EXPECT_EQ(fault("geojson", polygon(nearly, R"("class":"bay")"), here), "taken");
}

}  // namespace
}  // namespace roadbook
