#include <algorithm>
#include <cmath>

#include "tests/exchange/import/foreign_files.hpp"

// GeoJSON files and YOLO folders of other programs.

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

class ForeignGeoJson : public test::ForeignFiles {
 protected:
  ForeignGeoJson() {
    const auto c = space_.corners();
    corners_ = {c.begin(), c.end()};
  }
  static Json classed() { return {{"class", test::kSpace}}; }
  Json good() const { return feature(classed(), "Polygon", Json::array({degrees(corners_)})); }
  // Imports a good feature, which is stored, together with an odd one. Returns the message about
  // the odd one.
  std::string said_of(const Json& odd) {
    const LabelImport made = take("geojson", collection({good(), odd}));
    EXPECT_EQ(total(made), 2U);
    EXPECT_EQ(made.count_left_out(), 1U);
    return made.left_out.empty() ? "nothing" : to_line(made.left_out[0].reason);
  }
  std::vector<Eigen::Vector2d> corners_;
};

TEST_F(ForeignGeoJson, ARectangleStaysABoxWhateverCornersAProgramAdds) {
  Json ring = degrees(corners_);
  ring.insert(ring.begin() + 1, ring[1]);  // a corner twice
  ring.push_back(ring.front());            // closed twice
  EXPECT_EQ(
      take("geojson", collection({feature(classed(), "Polygon", Json::array({ring}))})).stored, 1U);
  EXPECT_NEAR(only_box().length_m, 5.0, 1e-3);
}

// Seven decimals are 1.1 cm, six 11 cm, single precision at 47 degrees 0.4 m.
TEST_F(ForeignGeoJson, ARoundedBoxIsABox) {
  space_.heading += 0.4;
  const auto c = space_.corners();
  corners_ = {c.begin(), c.end()};
  for (const double scale : {1e7, 1e6}) {
    clear_map();
    Json file = collection({good()});
    for (Json& point : file["features"][0]["geometry"]["coordinates"][0])
      for (Json& value : point) value = std::round(value.get<double>() * scale) / scale;
    take("geojson", file);
    EXPECT_NEAR(only_box().width_m, 2.5, 2.0 * 1.12e5 / scale);
  }
}

TEST_F(ForeignGeoJson, AMultiPolygonOfOneIsAPolygon) {
  EXPECT_EQ(take("geojson", collection({feature(classed(), "MultiPolygon",
                                                Json::array({Json::array({degrees(corners_)})}))}))
                .stored,
            1U);
  EXPECT_NEAR(only_box().length_m, 5.0, 1e-3);
}

TEST_F(ForeignGeoJson, ShapesThatNoLabelHasAreLeftOutWithAWord) {
  const Json ring = degrees({{0.5, -4}, {2, -4}, {2, -7}, {0.5, -7}});
  const Json hole = degrees({{1, -5}, {1.5, -5}, {1.5, -6}, {1, -6}});
  EXPECT_TELLS(said_of(feature(classed(), "Polygon", {ring, hole})),
               "features[1].geometry.coordinates: got 2 rings, want one ring without holes");
  EXPECT_TELLS(said_of(feature(classed(), "MultiPolygon",
                               {Json::array({ring}), Json::array({degrees(corners_)})})),
               "features[1].geometry.coordinates: got 2 polygons");
  EXPECT_TELLS(said_of(feature(classed(), "Point", ring[0])),
               "features[1].geometry.type: got \"Point\"");
  Json empty = feature(classed(), "Point", ring[0]);
  empty["geometry"] = nullptr;
  empty["id"] = "a7";
  EXPECT_TELLS(said_of(empty), "features[1].geometry.type: got nothing (id \"a7\"), want Polygon");
}

TEST_F(ForeignGeoJson, TheClassMayStandInAnotherProperty) {
  const Json odd = feature({{"Class", test::kSpace}}, "Polygon", Json::array({degrees(corners_)}));
  EXPECT_EQ(take("geojson", collection({odd})).stored, 1U);
  clear_map();
  const Json other =
      feature({{"kind", test::kSpace}, {"fid", 3}}, "Polygon", Json::array({degrees(corners_)}));
  EXPECT_TELLS(refusal("geojson", collection({other}).dump()),
               "features[0].properties.class: got nothing, want the name of a class "
               "(--class-field names another of its properties: kind)");
  EXPECT_EQ(take("geojson", collection({other}).dump(), "kind").stored, 1U);
}

TEST_F(ForeignGeoJson, OneFeatureAloneIsAFile) { EXPECT_EQ(take("geojson", good()).stored, 1U); }

TEST_F(ForeignGeoJson, SwappedDegreesAreNamed) {
  Json file = collection({good()});
  for (Json& point : file["features"][0]["geometry"]["coordinates"][0])
    std::swap(point[0], point[1]);
  EXPECT_TELLS(refusal("geojson", file.dump()), "(here they are swapped)");
}

// An export of a whole map contains layers without labels, and spaces that come from truth only.
TEST_F(ForeignGeoJson, OtherLayersAreCountedAndSaidOnce) {
  std::vector<Json> features{good()};
  for (int i = 0; i < 5; ++i)
    features.push_back(feature({{"layer", "landmarks"}}, "Point", {8.54, 47.37}));
  for (int i = 0; i < 3; ++i)
    features.push_back(feature({{"layer", "parking_spaces"}, {"length_m", 5.0}}, "Polygon",
                               Json::array({degrees(corners_)})));
  const LabelImport made = take("geojson", collection(features));
  EXPECT_EQ(made.stored, 1U);
  EXPECT_EQ(made.count_left_out(), 8U);
  ASSERT_EQ(made.left_out.size(), 2U);
  EXPECT_TELLS(to_line(made.left_out[0].reason), "layer landmarks: got 5 features");
  EXPECT_TELLS(to_line(made.left_out[1].reason),
               "layer parking_spaces: got 3 features, want ones that have a class");
  // A file with only such features is not refused either.
  features.erase(features.begin());
  const LabelImport none = take("geojson", collection(features));
  EXPECT_EQ(none.stored + none.already, 0U);
  EXPECT_EQ(none.count_left_out(), 8U);
}

class ForeignYolo : public test::ForeignFiles {
 protected:
  static constexpr const char* kNames = "names: [parking_space, crossing]\n";
  // A box in the picture, 60 by 120 of its pixels.
  static constexpr const char* kRow = "0 0.22 0.27 0.1 0.2\n";
};

TEST_F(ForeignYolo, NamesThatDoNotBeginAtNothingAreNamed) {
  EXPECT_TELLS(refusal_of_yolo(yolo("names:\n  1: parking_space\n  2: crossing\n", kRow)),
               "names: got a list that begins at 1, want 0, 1, ...");
  EXPECT_TELLS(refusal_of_yolo(yolo("names: {0: a, 1: b, 3: c}\n", kRow)),
               "names: got no 2 before 3, want 0, 1, ...");
  EXPECT_TELLS(refusal_of_yolo(yolo("names: {first: a}\n", kRow)), "names.first: ");
  EXPECT_TELLS(refusal_of_yolo(yolo("nc: 2\n", kRow)), "names: got nothing");
  EXPECT_TELLS(refusal_of_yolo(yolo("names: []\n", kRow)), "names: got none");
  EXPECT_EQ(refusal_of_yolo(yolo("names: {1: crossing, 0: parking_space}\n", kRow)), "taken");
}

TEST_F(ForeignYolo, NamesMayStandInAListOfTheirOwn) {
  const auto folder = yolo("", kRow);
  std::ofstream(folder / "classes.txt") << "parking_space\r\ncrossing\r\n\n";
  EXPECT_EQ(import_labels(map_, "yolo", folder, "ann").stored, 1U);
  EXPECT_EQ(labels()[0].kind, test::kSpace);
}

TEST_F(ForeignYolo, RowsOfOtherPicturesAreCounted) {
  const auto folder = yolo(kNames, kRow);
  std::ofstream(folder / "labels" / "street.txt") << kRow << "\n" << kRow;
  const LabelImport made = import_labels(map_, "yolo", folder, "ann");
  EXPECT_EQ(made.stored, 1U);
  EXPECT_EQ(made.count_left_out(), 2U);
  EXPECT_TELLS(to_line(made.left_out[0].reason), "street.txt: rows: got 2 of 1 other pictures");
}

TEST_F(ForeignYolo, TheOverheadImageIsFoundWhereTrainersAndProgramsPutIt) {
  const auto folder = yolo(kNames, "");
  std::filesystem::create_directories(folder / "labels" / "train");
  EXPECT_TELLS(refusal_of_yolo(folder), "overhead.txt: got no such file");
  std::ofstream(folder / "labels" / "train" / "a1b2-overhead.txt") << kRow;
  EXPECT_EQ(import_labels(map_, "yolo", folder, "ann").stored, 1U);
  std::ofstream(folder / "labels" / "train" / "c3-overhead.txt") << kRow;
  EXPECT_TELLS(refusal_of_yolo(folder), "got a1b2-overhead.txt, c3-overhead.txt, want one file");
}

TEST_F(ForeignYolo, AnAngleOrAConfidenceAtTheEndIsNoCorner) {
  for (const char* row : {"0 0.2 0.2 0.1 0.1 0.9\n", "0 0.2 0.2 0.3 0.2 0.3 0.3 0.2 0.3 0.9\n"})
    EXPECT_TELLS(refusal_of_yolo(yolo(kNames, row)), "no angle, and no confidence at its end");
}

TEST_F(ForeignYolo, BytesOfAnotherKindAreNamed) {
  EXPECT_TELLS(refusal_of_yolo(yolo(kNames, std::string("0\0 0.5\n", 7))),
               "overhead.txt:1: text: got UTF-16 or binary data");
}

}  // namespace
}  // namespace roadbook
