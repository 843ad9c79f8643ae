#include "semantics/label_sightings.hpp"

#include <gtest/gtest.h>

#include "apps/report/label_section.hpp"
#include "exchange/friction_layers.hpp"
#include "mapping/map_build.hpp"
#include "semantics/label_store.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/label_page/lot.hpp"
#include "tests/semantics/two_drives.hpp"

// Further anchors of labels from the images to the map file, and from there to what the report says
// of the map.

namespace roadbook {
namespace {

class LabelSightings : public ::testing::Test {
 protected:
  // The second session's wheels were so much off: its poses in the map run ahead of the true ones.
  void bend(double share) {
    truth_ = drives_.poses();
    for (std::size_t k = 0; k < truth_.size(); ++k)
      if (drives_.map.keyframes[k].session == 1)
        drives_.map.map_frames[k].T_map_frame.translation().x() +=
            share * (truth_[k].translation().x() + 4.0);
  }
  // Labels of the first session's images, stored; then what the second one's show of them.
  void label_and_look_again() {
    MapBuild(map_, "two").finish(drives_.map, {});
    auto spaces = drives_.spaces();
    LabelStore store(map_);
    std::vector<Label> some;
    for (std::size_t i = 4; i < spaces.size(); i += 2) some.push_back(spaces[i]);
    store.create_all(some, "ann");
    store.write_table(
        label_sightings_table(find_sightings(store.map(), store.labels(), drives_.images(truth_))));
  }
  [[nodiscard]] LabelAgreement reported() const {
    return collect_labels(map_, load_map(map_), {})->agreement;
  }

  test::ScratchFolder folder_;
  std::filesystem::path map_ = folder_.path() / "two.gpkg";
  test::TwoDrives drives_;
  std::vector<Eigen::Isometry3d> truth_;
};

// Labels lie 5 to 35 m from where the bend of 2 % begins: 10 to 70 cm, in the median 40 cm.
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
  EXPECT_LT(agreement.median_m, 0.06);  // where an image shows paint is known to 5 cm
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
  MapBuild(map_, "three").finish(drives_.map, {}, keep);
  EXPECT_EQ(reported().sightings.size(), before);
}

TEST_F(LabelSightings, AreNotLookedForWhereThereIsNothingToLookFor) {
  test::write_lot(map_, {});
  const auto none = test::run_command("roadbook label -m two.gpkg --look-again", folder_.path());
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("two.gpkg: labels: got too few, want one on the ground"),
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
  EXPECT_NE(alone.err.find("two.gpkg: sessions: got too few, want two or more"), std::string::npos)
      << alone.err;
}

}  // namespace
}  // namespace roadbook
