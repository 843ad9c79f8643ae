#include <cmath>

#include "tests/exchange/import/known_labels.hpp"
#include "tests/support/command_output.hpp"

// Labels that another program has edited, copied or moved come back as edits of the map's labels.

namespace roadbook {
namespace {

using EditedLabels = test::KnownLabels;

TEST_F(EditedLabels, AMovedLabelIsAnEditOfTheSameLabel) {
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

TEST_F(EditedLabels, AnotherClassOrNoteIsAnEditToo) {
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

TEST_F(EditedLabels, ThroughCocoTheyAreEditedAsWell) {
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

TEST_F(EditedLabels, ACopyIsANewLabel) {
  Json file = written("geojson");
  Json copy = of_label(file, 6);
  move(copy, 2.6);
  file["features"].push_back(copy);
  const LabelImport made = take("geojson", file);
  EXPECT_EQ(made.stored, 1U);
  EXPECT_EQ(made.already, 7U);
  EXPECT_EQ(labels().size(), 8U);
}

TEST_F(EditedLabels, WhatSomebodyHasChangedSinceIsNotOverwritten) {
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
TEST_F(EditedLabels, NoTwinLiesOnItsTwin) {
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
TEST_F(EditedLabels, ANumberOfAnotherMapIsNotBelieved) {
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

TEST_F(EditedLabels, ALabelMovedOntoAnotherIsLeftOut) {
  Json file = written("geojson");
  const Eigen::Vector2d apart = middle_of_label(5) - middle_of_label(6);
  move(of_label(file, 6), apart.x() + 0.1);
  const LabelImport made = take("geojson", file);
  EXPECT_EQ(made.changed, 0U);
  ASSERT_EQ(made.count_left_out(), 1U);
  EXPECT_TELLS(to_line(made.left_out[0].reason), "an outline on label 5");
}

}  // namespace
}  // namespace roadbook
