#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "apps/label_server/anchor_views.hpp"
#include "apps/label_server/label_wire.hpp"
#include "apps/label_server/learning.hpp"
#include "base/random.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "mapping/store/existing_map.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "workflows/labels/label_examples.hpp"
#include "workflows/labels/label_place.hpp"
#include "workflows/labels/people_record.hpp"
#include "workflows/people/people_store.hpp"

// What was taught and learnt stays in the map when it is built again from its drives.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

class MapRebuild : public ::testing::Test {
 protected:
  MapRebuild() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    test::write_lot(map_, {});
  }
  ~MapRebuild() override { fs::remove_all(folder_); }
  /// As `roadbook map` does where the map is there already: of its drive (digest "0"), or of
  /// others.
  void build_again(const std::vector<std::string>& digests = {"0"}) const {
    MapFinishOptions options;
    std::vector<Problem> warnings;
    options.keep_tables = tables_that_stay(map_, read_existing_map(map_, digests),
                                           measured_tables(), learning_tables(), warnings);
    MapFileBuilder(map_, "lot").finish(test::lot_map({}), {}, options);
  }

  // one folder a test, because tests run in parallel
  const fs::path folder_ =
      fs::path(testing::TempDir()) /
      (std::string("map_rebuild_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  const fs::path map_ = folder_ / "lot.gpkg";
};

TEST_F(MapRebuild, KeepsWhatWasLearntOfPeople) {
  PersonExamples examples;
  for (const int label : {1, -1, -1}) {
    examples.features.push_back(
        Eigen::VectorXf::Constant(PersonWindow::feature_size(), 0.5F * static_cast<float>(label)));
    examples.labels.push_back(static_cast<std::int8_t>(label));
  }
  examples.answers = {{1.25, true}, {-0.5, false}};
  examples.instants = {"drive 1", "drive 2"};
  PeopleRecord record;
  record.rounds.push_back({1, 77, 0.5, 3, 9, 24, 2});
  record.images.push_back({{0, 1'400'000'000'000'000'000, 2}, {}});
  record.next = 24;
  MapUpdate update(map_);
  write_person_examples(update, examples);
  update.write_table(people_record_table(record));
  update.commit();
  build_again();
  const PersonExamples kept = read_person_examples(MapLayers(map_));
  EXPECT_EQ(kept.features, examples.features);
  EXPECT_EQ(kept.labels, examples.labels);
  EXPECT_EQ(kept.answers, examples.answers);
  EXPECT_EQ(kept.instants, examples.instants);
  const PeopleRecord rounds = read_label_place(map_).people_record;
  EXPECT_EQ(people_record_to_json(rounds), people_record_to_json(record));
}

TEST_F(MapRebuild, KeepsWhatWasLearntOfTheGround) {
  BoxExamples examples;
  examples.length_m = 5.0;
  examples.width_m = 2.5;
  Random random(1, "box features");
  examples.features = Eigen::MatrixXf::NullaryExpr(
      3, 8, [&] { return static_cast<float>(random.uniform(-1.0, 1.0)); });
  examples.labels = {1, -1, -1};
  LearningRecord record;
  record.rounds.push_back({1, test::kSpace, 77, 0.5, 3, 0, 1, 1, 0});
  record.hypotheses.push_back({{{1.0, 2.0}, 0.5, 5.0, 2.5}, {0.0, 1.0, 0.75}});
  record.questions = {0};
  MapUpdate update(map_);
  update.write_table(examples_table({{test::kSpace, examples}}));
  update.write_table(record_table("a picture", record));
  update.commit();
  build_again();
  const ExamplesByKind kept = stored_examples(map_);
  ASSERT_EQ(kept.count(test::kSpace), 1U);
  EXPECT_EQ(kept.at(test::kSpace).features, examples.features);
  EXPECT_EQ(kept.at(test::kSpace).labels, examples.labels);
  const LabelPlace place = read_label_place(map_);
  EXPECT_EQ(place.learnt_picture, "a picture");
  EXPECT_EQ(record_to_json(record_from_text(place.learnt_record)), record_to_json(record));
}

// The overhead image of the new map differs: places found on the old image are void. The training
// examples of the rounds stay valid.
TEST_F(MapRebuild, OnAnotherPictureRoundsStandWithoutTheirPlaces) {
  LearningRecord record;
  record.rounds.push_back({4, test::kSpace, 77, 0.5, 3, 0, 1, 1, 0});
  record.hypotheses.push_back({{{1.0, 2.0}, 0.5, 5.0, 2.5}, {0.0, 1.0, 0.75}});
  record.questions = {0};
  record.shift = -0.5;
  const std::string learnt_on = picture_version(read_label_place(map_).image);
  MapUpdate update(map_);
  update.write_table(record_table(learnt_on, record));
  update.commit();
  const auto as_served = [&] {
    const LabelPlace place = read_label_place(map_);
    return record_on(picture_version(place.image), place.learnt_picture, place.learnt_record);
  };
  EXPECT_EQ(record_to_json(as_served()), record_to_json(record));
  build_again();  // the new map has no overhead image yet
  const LearningRecord left = as_served();
  EXPECT_EQ(record_to_json(left).at("rounds"), record_to_json(record).at("rounds"));
  EXPECT_EQ(left.shift, -0.5);
  EXPECT_TRUE(left.hypotheses.empty());
  EXPECT_TRUE(left.questions.empty());
}

// Rounds name sessions by number, and their places are those of the old map.
TEST_F(MapRebuild, RoundsDoNotGoOverToAMapOfOtherDrivesWhatExamplesTeachDoes) {
  BoxExamples examples;
  examples.length_m = 5.0;
  examples.width_m = 2.5;
  examples.features = Eigen::MatrixXf::Constant(1, 8, 0.25F);
  examples.labels = {1};
  LearningRecord record;
  record.rounds.push_back({1, test::kSpace, 77, 0.5, 3, 0, 1, 1, 0});
  PeopleRecord people;
  people.rounds.push_back({1, 77, 0.5, 3, 9, 24, 2});
  MapUpdate update(map_);
  update.write_table(examples_table({{test::kSpace, examples}}));
  update.write_table(record_table("a picture", record));
  update.write_table(people_record_table(people));
  update.commit();
  build_again({"another"});
  const LabelPlace place = read_label_place(map_);
  EXPECT_EQ(place.learnt_record, "");
  EXPECT_TRUE(place.people_record.rounds.empty());
  EXPECT_EQ(stored_examples(map_).count(test::kSpace), 1U);
}

// Every second keyframe is replaced. Labels with anchors at replaced keyframes still have a place
// and an image.
TEST_F(MapRebuild, ALabelIsShownWhereKeyframesWereChosenAnew) {
  const Map before = test::lot_map({});
  Map after = before;
  after.keyframes.clear();
  for (std::size_t k = 0; k < before.keyframes.size(); k += 2)
    after.keyframes.push_back(before.keyframes[k]);
  const OrientedBox space{{4.0, 5.5}, 1.5, 5.0, 2.5};
  Label label = label_of_box(before, {0, before.keyframes[7].t_ns, 1}, space);
  label.kind = test::kSpace;
  ASSERT_FALSE(keyframe_of(after, label.anchor));
  // The drive goes straight at one speed: what lies between two poses is exact.
  const auto wire = label_to_wire(after, label);
  EXPECT_NEAR(wire.at("x").get<double>(), 4.0, 1e-6);
  EXPECT_NEAR(wire.at("y").get<double>(), 5.5, 1e-6);
  const std::vector<std::optional<Drive>> drives(1);
  const auto was = AnchorViews(&before, &drives).view_of(label);
  EXPECT_EQ(AnchorViews(&after, &drives).view_of(label), was);
  EXPECT_FALSE(was.at("outline").empty());
  // A change on the page keeps the image of the label.
  nlohmann::json body = wire;
  body["x"] = 4.2;
  EXPECT_EQ(label_from_wire(after, body, &label).anchor.t_ns, label.anchor.t_ns);
}

}  // namespace
}  // namespace roadbook
