#include <cmath>

#include "semantics/labels/label_classes.hpp"
#include "tests/exchange/import/foreign_files.hpp"

// COCO files of other programs: fields that change what an annotation means.

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

class ForeignCoco : public test::ForeignFiles {
 protected:
  static std::string reason(const LabelImport& made) {
    return made.left_out.empty() ? std::string("nothing") : to_line(made.left_out[0].reason);
  }
  // Imports a good annotation, which is stored, together with an odd one. Returns the message about
  // the odd one.
  std::string said_of(const Json& more) {
    Json odd = {{"bbox", bbox_px(test::spaces_of(lot_)[0])}, {"segmentation", Json::array()}};
    odd.update(more);
    const LabelImport made = take("coco", coco({{{"bbox", bbox_px(space_)}}, odd}));
    EXPECT_EQ(total(made), 2U);
    EXPECT_EQ(made.count_left_out(), 1U) << more;
    EXPECT_EQ(labels().size(), 1U) << more;
    return reason(made);
  }
  // Direction of the only box, 0 to 180 degrees.
  double direction_deg() {
    const double degrees = only_box().heading * 180.0 / M_PI;
    return degrees - 180.0 * std::floor(degrees / 180.0);
  }
};

// CVAT turns clockwise in the image. The box is along y (90 degrees); a turn by 30 degrees gives 60
// degrees.
TEST_F(ForeignCoco, ABoxIsTurnedClockwiseAboutItsMiddle) {
  const LabelImport made =
      take("coco", coco({{{"bbox", bbox_px(space_)},
                          {"segmentation", Json::array()},
                          {"attributes", {{"occluded", false}, {"rotation", 30.0}}}}}));
  EXPECT_EQ(made.stored, 1U);
  const OrientedBox box = only_box();
  EXPECT_LT((box.centre - space_.centre).norm(), 1e-6);
  EXPECT_NEAR(box.length_m, 5.0, 1e-6);
  EXPECT_NEAR(box.width_m, 2.5, 1e-6);
  EXPECT_NEAR(direction_deg(), 60.0, 1e-6);
}

TEST_F(ForeignCoco, ATurnMayBeNegativeOrMoreThanAFullOne) {
  for (const double turn : {-330.0, 390.0, 210.0}) {
    clear_map();
    take("coco", coco({{{"bbox", bbox_px(space_)}, {"attributes", {{"rotation", turn}}}}}));
    EXPECT_NEAR(direction_deg(), 60.0, 1e-6) << turn;
  }
}

TEST_F(ForeignCoco, APolygonThatRepeatsTheBoxIsTurnedAndOneThatIsTurnedAlreadyIsNot) {
  const auto c = space_.corners();
  const Json upright = ring_px({c.begin(), c.end()});
  LabelImport made = take("coco", coco({{{"bbox", bbox_px(space_)},
                                         {"segmentation", Json::array({upright})},
                                         {"attributes", {{"rotation", 30.0}}}}}));
  EXPECT_NEAR(direction_deg(), 60.0, 1e-6);
  EXPECT_TRUE(made.notes.empty());
  clear_map();
  OrientedBox turned = space_;
  turned.heading -= 30.0 * M_PI / 180.0;
  const auto t = turned.corners();
  made = take("coco", coco({{{"bbox", bbox_px(space_)},
                             {"segmentation", Json::array({ring_px({t.begin(), t.end()})})},
                             {"attributes", {{"rotation", 30.0}}}}}));
  EXPECT_NEAR(direction_deg(), 60.0, 1e-6);
  EXPECT_TRUE(made.notes.empty());
}

TEST_F(ForeignCoco, ATurnBesideAnotherPolygonIsTold) {
  const LabelImport made = take(
      "coco", coco({{{"segmentation", Json::array({ring_px({{1, -1}, {4, -1}, {4, 1}, {2, 2}})})},
                     {"attributes", {{"rotation", 10.0}}}}}));
  EXPECT_EQ(made.stored, 1U);
  ASSERT_EQ(made.notes.size(), 1U);
  EXPECT_TELLS(to_line(made.notes[0]), "annotations[0].attributes.rotation: got 10");
}

TEST_F(ForeignCoco, TurnsThatNoStandardTellsAreLeftOut) {
  EXPECT_TELLS(said_of({{"attributes", {{"angle", 12.5}}}}),
               "annotations[1].attributes.angle: got 12.5 (annotation id 101)");
  EXPECT_TELLS(said_of({{"rotation", 30}}), "annotations[1].rotation: got 30");
  EXPECT_TELLS(said_of({{"attributes", {{"Theta", 0.3}}}}), "attributes.Theta: got 0.3");
  EXPECT_TELLS(said_of({{"bbox", {200, 200, 60, 120, 0.5}}}), "bbox: got a fifth number, 0.5");
  EXPECT_TELLS(said_of({{"attributes", {{"shape", "box"}, {"heading_rad", 1.2}}}}),
               "attributes.heading_rad: got 1.2 of an upright bbox");
}

TEST_F(ForeignCoco, FieldsThatTurnNothingChangeNothing) {
  const LabelImport made = take(
      "coco", coco({{{"bbox", bbox_px(space_)},
                     {"ignore", 0},
                     {"iscrowd", 0},
                     {"rotation", 0},
                     {"attributes",
                      {{"occluded", true}, {"orientation", "parallel"}, {"rotation", 0.0}}}}}));
  EXPECT_EQ(made.stored, 1U);
  EXPECT_TRUE(made.left_out.empty() && made.notes.empty());
}

TEST_F(ForeignCoco, GroupsAndWhatIsToBeIgnoredAreLeftOutAndCounted) {
  EXPECT_TELLS(said_of({{"iscrowd", 1}}), "annotations[1].iscrowd: got 1 (annotation id 101)");
  EXPECT_TELLS(said_of({{"iscrowd", true}}), "iscrowd: got true");
  EXPECT_TELLS(said_of({{"attributes", {{"is_crowd", true}}}}), "attributes.is_crowd: got true");
  EXPECT_TELLS(said_of({{"attributes", {{"IsGroupOf", "1"}}}}), "attributes.IsGroupOf: got \"1\"");
  EXPECT_TELLS(said_of({{"ignore", 1}}), "annotations[1].ignore: got 1");
  EXPECT_TELLS(said_of({{"iscrowd", 1}, {"segmentation", {{"counts", {3, 4}}, {"size", {9, 9}}}}}),
               "iscrowd: got 1");
}

TEST_F(ForeignCoco, MasksPartsAndKeyPointsAreLeftOut) {
  EXPECT_TELLS(said_of({{"segmentation", {{"counts", "abc"}, {"size", {9, 9}}}}}),
               "annotations[1].segmentation: got a run-length mask (annotation id 101)");
  EXPECT_TELLS(said_of({{"segmentation", {{9, 9, 60, 9, 60, 60}, {90, 90, 99, 90, 99, 99}}}}),
               "segmentation: got 2 parts");
  EXPECT_TELLS(said_of({{"keypoints", {9, 9, 2, 60, 60, 2}}, {"num_keypoints", 2}}),
               "keypoints: got points");
}

TEST_F(ForeignCoco, SharesInPlaceOfPixelsAreLeftOut) {
  EXPECT_TELLS(said_of({{"bbox", {0.2, 0.3, 0.1, 0.2}}}),
               "annotations[1].bbox: got numbers from 0 to 1 (annotation id 101), want pixels");
}

// If no annotation is usable, the import must fail.
TEST_F(ForeignCoco, AFileOfGroupsAloneIsRefused) {
  EXPECT_TELLS(refusal("coco", coco({{{"bbox", bbox_px(space_)}, {"iscrowd", 1}}}).dump()),
               "error: " + file_.string() + ": annotations[0].iscrowd: got 1");
  EXPECT_TRUE(labels().empty());
}

TEST_F(ForeignCoco, ARectangleStaysABoxWhateverCornersAProgramAdds) {
  const auto c = space_.corners();
  const auto between = [&](int i, int k, double share) -> Eigen::Vector2d {
    return c[static_cast<std::size_t>(i)] +
           share * (c[static_cast<std::size_t>(k)] - c[static_cast<std::size_t>(i)]);
  };
  const std::vector<std::vector<Eigen::Vector2d>> rings{
      {c[0], c[1], c[2], c[3], c[0]},                                     // closed
      {c[0], c[1], c[1], c[2], c[3]},                                     // a corner twice
      {c[0], c[0], c[1], c[2], c[2], c[2], c[3], c[0], c[0]},             // both
      {c[0], between(0, 1, 0.3), c[1], between(1, 2, 0.5), c[2], c[3]},   // corners on a side
      {between(3, 0, 0.5), c[0], c[1], c[2], c[3], between(3, 0, 0.49)},  // begins on a side
      {c[0], c[1], between(1, 2, 0.002), c[2], c[3]},                     // a double click
      {c[3], c[2], c[1], c[0], c[3]}};                                    // the other way round
  for (const auto& ring : rings) {
    clear_map();
    take("coco", coco({{{"segmentation", Json::array({ring_px(ring)})}}}));
    const OrientedBox box = only_box();
    EXPECT_LT((box.centre - space_.centre).norm(), 0.01);
    EXPECT_NEAR(box.length_m, 5.0, 0.02);
    EXPECT_NEAR(box.width_m, 2.5, 0.02);
  }
}

// A pixel is 4 cm. Each corner has an error of up to 2 cm in both directions, so the corners are
// not a rectangle within 2 cm.
TEST_F(ForeignCoco, ABoxRoundedToWholePixelsIsABox) {
  for (int i = 0; i < 12; ++i) {
    clear_map();
    OrientedBox turned = space_;
    turned.heading += 0.13 * i;
    const auto c = turned.corners();
    Json ring = ring_px({c.begin(), c.end()});
    for (auto& value : ring) value = std::round(value.get<double>());
    take("coco", coco({{{"segmentation", Json::array({ring})}}}));
    const OrientedBox box = only_box();
    EXPECT_LT((box.centre - space_.centre).norm(), 0.03) << i;
    EXPECT_NEAR(box.length_m, 5.0, 0.06) << i;
    EXPECT_NEAR(std::remainder(box.heading - turned.heading, M_PI), 0.0, 0.02) << i;
  }
}

TEST_F(ForeignCoco, AShapeThatIsNoRectangleStaysAPolygon) {
  // 30 cm out of the rectangle, in whole pixels and in many digits.
  for (const double off : {7.0, 7.123456}) {
    clear_map();
    take("coco", coco({{{"segmentation", {{100, 100, 160, 100, 160, 200, 100, 200 + off}}}}}));
    ASSERT_EQ(labels().size(), 1U);
    EXPECT_EQ(labels()[0].shape, LabelShape::kPolygon) << off;
    EXPECT_EQ(labels()[0].corners_vehicle.size(), 4U);
  }
}

TEST_F(ForeignCoco, ClassesNamedNotAreStoredUnderASafeName) {
  Json other = {{"bbox", bbox_px(test::spaces_of(lot_)[0])}, {"category_id", 2}};
  const LabelImport made =
      take("coco", coco({{{"bbox", bbox_px(space_)}}, other}, {test::kSpace, "not_reserved"}));
  EXPECT_EQ(made.stored, 2U);
  EXPECT_EQ(labels()[1].kind, "is_not_reserved");
  ASSERT_EQ(made.notes.size(), 1U);
  EXPECT_TELLS(to_line(made.notes[0]), "class: got 'not_reserved', want 'is_not_reserved'");
  // The same file again: known under that name.
  const LabelImport again =
      take("coco", coco({{{"bbox", bbox_px(space_)}}, other}, {test::kSpace, "not_reserved"}));
  EXPECT_EQ(again.already, 2U);
}

TEST_F(ForeignCoco, ARejectionOfAClassOfTheMapIsLeftOutWithAWord) {
  Json other = {{"bbox", bbox_px(test::spaces_of(lot_)[0])}, {"category_id", 2}};
  const LabelImport made =
      take("coco", coco({{{"bbox", bbox_px(space_)}}, other}, {test::kSpace, "not_parking_space"}));
  EXPECT_EQ(made.stored, 1U);
  EXPECT_EQ(total(made), 2U);
  EXPECT_TELLS(reason(made), "annotations[1].segmentation: got class 'not_parking_space'");
}

TEST_F(ForeignCoco, AClassIsKnownInAnotherCaseOrInThePlural) {
  for (const char* name : {"Parking_Space", "parking spaces", "PARKING-SPACE", "ParkingSpace"}) {
    clear_map();
    const LabelImport made = take("coco", coco({{{"bbox", bbox_px(space_)}}}, {name}));
    ASSERT_EQ(made.stored, 1U);
    EXPECT_EQ(labels()[0].kind, test::kSpace);
    ASSERT_EQ(made.notes.size(), 1U) << name;
    EXPECT_TELLS(to_line(made.notes[0]), "want 'parking_space': it is taken as that");
  }
}

TEST_F(ForeignCoco, TheOverheadImageIsFoundAmongSeveral) {
  Json file = coco({{{"bbox", bbox_px(space_)}},
                    {{"bbox", {1, 1, 5, 5}}, {"image_id", 8}},
                    {{"bbox", {1, 1, 5, 5}}, {"image_id", 8}}});
  Json street = file["images"][0];
  street["id"] = 8;
  street["width"] = 640;
  street["file_name"] = "street.jpg";
  file["images"].insert(file["images"].begin(), street);
  const LabelImport made = take("coco", file);
  EXPECT_EQ(made.stored, 1U);
  EXPECT_EQ(made.count_left_out(), 2U);
  EXPECT_TELLS(reason(made), "annotations of image 8: got 2");
  // If two images have the same size, only the name decides. Without a matching name, the import
  // fails.
  file["images"][0]["width"] = file["images"][1]["width"];
  EXPECT_EQ(take("coco", file).already, 1U);
  file["images"][1]["file_name"] = "top.png";
  EXPECT_TELLS(refusal("coco", file.dump()), "images: got street.jpg, top.png, want one that has");
}

TEST_F(ForeignCoco, WholeNumbersMayBeWrittenAsTablesWriteThem) {
  Json file = coco({{{"bbox", bbox_px(space_)}}});
  file["annotations"][0]["category_id"] = 1.0;
  file["annotations"][0]["image_id"] = 7.0;
  file["images"][0]["width"] = file["images"][0]["width"].get<double>();
  EXPECT_EQ(take("coco", file).stored, 1U);
}

}  // namespace
}  // namespace roadbook
