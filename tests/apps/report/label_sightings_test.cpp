#include "semantics/labels/label_sightings.hpp"

#include <gtest/gtest.h>

#include "exchange/layers/friction_layers.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/semantics/two_drives_files.hpp"
#include "workflows/report/label_report.hpp"

// Tests further anchors of labels: from the images to the map file, and from the map file to the
// report's figures about the map.

namespace roadbook {
namespace {

class LabelSightings : public ::testing::Test {
 protected:
  // The wheels of the second session have this scale error, so its poses in the map run ahead of
  // the true poses.
  void bend(double share) {
    truth_ = drives_.poses();
    test::bend_second_drive(drives_, share);
  }
  void label_some() {
    MapFileBuilder(map_, "two").finish(drives_.map, {});
    auto spaces = drives_.spaces();
    std::vector<Label> some;
    for (std::size_t i = 4; i < spaces.size(); i += 2) some.push_back(spaces[i]);
    LabelStore(map_).create_all(some, "ann");
  }
  // Stores labels of the first session's images, then finds these labels in the images of the
  // second session.
  void label_and_look_again() {
    label_some();
    LabelStore store(map_);
    SightingRecord record;
    look_for_sightings(store.map(), store.labels(), drives_.images(truth_), record);
    store.write_table(label_sightings_table(record.sightings()));
  }
  [[nodiscard]] LabelAgreement reported() const {
    return collect_labels(map_, load_map(map_), {})->agreement;
  }

  test::ScratchFolder folder_;
  std::filesystem::path map_ = folder_.path() / "two.gpkg";
  test::TwoDrives drives_;
  std::vector<Eigen::Isometry3d> truth_;
};

// The labels lie 5 to 35 m beyond the start of the bend of 2 %, so they are off by 10 to 70 cm,
// with a median of 40 cm.
TEST_F(LabelSightings, FromTheMapFileTellOfABendOfTheMap) {
  bend(0.02);
  label_and_look_again();
  const LabelAgreement agreement = reported();
  EXPECT_GE(agreement.sightings.size(), 8U);
  EXPECT_TRUE(agreement.contradicts());
  EXPECT_NEAR(agreement.median_m, 0.4, 0.15);
}

TEST_F(LabelSightings, OfAMapThatIsRightBearItOutAndGoWithTheShapeTheyWereFoundFor) {
  bend(0.0);
  label_and_look_again();
  const LabelAgreement agreement = reported();
  ASSERT_GE(agreement.sightings.size(), 8U);
  EXPECT_FALSE(agreement.contradicts());
  EXPECT_LT(agreement.median_m, 0.06);  // the position of paint in an image is known to 5 cm
  {
    LabelStore store(map_);
    Label label = *store.find(agreement.sightings.front().id);
    label.T_vehicle_label.translation().x() += 0.3;
    store.change(label, "bob");
  }
  EXPECT_EQ(reported().sightings.size(), agreement.sightings.size() - 1);
}

TEST_F(LabelSightings, StayWhereAMapGoesOnWithItsDrives) {
  bend(0.0);
  label_and_look_again();
  const std::size_t before = reported().sightings.size();
  MapFinishOptions keep;
  keep.keep_tables = learning_tables();
  MapFileBuilder(map_, "three").finish(drives_.map, {}, keep);
  EXPECT_EQ(reported().sightings.size(), before);
}

// The program reads a map file and folders of recordings. It must find on disk the same sightings
// as the library finds in memory.
TEST_F(LabelSightings, AreFoundByTheProgramInTheRecordingsOfAMap) {
  bend(0.02);
  test::write_recordings(drives_, truth_, folder_.path());
  label_some();
  const auto before = read_label_events(map_);
  const auto seen = test::run_command("roadbook label -m two.gpkg --look-again", folder_.path());
  ASSERT_EQ(seen.status, 0) << seen.err;
  EXPECT_NE(seen.out.find("the map is distorted"), std::string::npos) << seen.out;
  const LabelAgreement agreement = reported();
  EXPECT_NE(seen.out.find(std::to_string(agreement.sightings.size()) +
                          " sightings of labels in other sessions"),
            std::string::npos)
      << seen.out;
  SightingRecord in_memory;
  look_for_sightings(load_map(map_), read_labels(map_), drives_.images(truth_), in_memory);
  EXPECT_EQ(label_sightings_table(read_label_sightings(MapLayers(map_))).rows,
            label_sightings_table(in_memory.sightings()).rows);
  EXPECT_GE(agreement.sightings.size(), 8U);
  EXPECT_EQ(read_label_events(map_).size(), before.size());

  // One recording is missing now; the sightings found in it before are kept.
  std::filesystem::rename(folder_.path() / "drive1", folder_.path() / "away");
  const auto alone = test::run_command("roadbook label -m two.gpkg --look-again", folder_.path());
  EXPECT_EQ(alone.status, 2);
  EXPECT_NE(
      alone.err.find("two.gpkg: drives: got too few, want the recordings of at least two sessions"),
      std::string::npos)
      << alone.err;
  EXPECT_EQ(reported().sightings.size(), agreement.sightings.size());
  const auto given =
      test::run_command("roadbook label -m two.gpkg --look-again --drive away", folder_.path());
  EXPECT_EQ(given.status, 0) << given.err;
  EXPECT_EQ(reported().sightings.size(), agreement.sightings.size());
}

TEST_F(LabelSightings, AreNotLookedForWhereThereIsNothingToLookFor) {
  test::write_lot(map_, {});
  const auto none = test::run_command("roadbook label -m two.gpkg --look-again", folder_.path());
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("two.gpkg: labels: got too few, want at least one label on the ground"),
            std::string::npos)
      << none.err;
  {
    LabelStore store(map_);
    const OrientedBox box = test::spaces_of({}).front();
    const auto corners = box.corners();
    Label label =
        label_of_box(store.map(), *anchor_for(store.map(), {corners.begin(), corners.end()}), box);
    label.kind = test::kSpace;
    store.create(label, "ann");
  }
  const auto alone = test::run_command("roadbook label -m two.gpkg --look-again", folder_.path());
  EXPECT_EQ(alone.status, 2);
  EXPECT_NE(alone.err.find("two.gpkg: sessions: got too few, want at least two"), std::string::npos)
      << alone.err;
}

}  // namespace
}  // namespace roadbook
