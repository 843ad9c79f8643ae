#include "workflows/labels/label_examples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "semantics/detector/label_oracle.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "workflows/labels/label_oracle_run.hpp"
#include "workflows/labels/label_place.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

fs::path lot_file(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / "label_examples" / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  test::write_lot(folder / "lot.gpkg", {});
  return folder / "lot.gpkg";
}

// The first spaces, and a rejected place.
void label_spaces(const fs::path& file, std::size_t count) {
  LabelStore store(file);
  const std::vector<OrientedBox> spaces = test::spaces_of({});
  const auto hang = [&](const OrientedBox& box, const std::string& kind) {
    Label label = label_of_box(store.map(), {0, store.map().keyframes.front().t_ns, 0}, box);
    label.kind = kind;
    store.create(label, "ann");
  };
  for (std::size_t i = 0; i < count; ++i) hang(spaces[i], test::kSpace);
  OrientedBox aisle = spaces.front();
  aisle.centre.y() = 0.0;
  hang(aisle, rejected_kind(test::kSpace));
}

TEST(LabelExamples, AMapsLabelsTeachTheDetectorOfTheNextMapAndStayWithIt) {
  const BoxLearnerOptions options;
  const fs::path first = lot_file("first");
  EXPECT_THROW((void)examples_of_map(first, options), BadInput) << "nothing is labelled";
  label_spaces(first, 6);
  const ExamplesByKind taught = examples_of_map(first, options);
  ASSERT_EQ(taught.count(test::kSpace), 1U);
  const BoxExamples& of_spaces = taught.at(test::kSpace);
  EXPECT_NEAR(of_spaces.length_m, 5.0, 1e-9);
  EXPECT_EQ(std::count(of_spaces.labels.begin(), of_spaces.labels.end(), 1), 12) << "both ways";

  const fs::path second = lot_file("second");
  LabelStore(second).write_table(examples_table(taught));
  const ExamplesByKind stored = stored_examples(second);
  ASSERT_EQ(stored.count(test::kSpace), 1U);
  EXPECT_EQ(stored.at(test::kSpace).features, of_spaces.features);
  EXPECT_EQ(stored.at(test::kSpace).labels, of_spaces.labels);

  // Nothing is drawn there, and its spaces are found.
  BoxLearner learner(read_label_place(second).image, options);
  learner.start_from(stored.at(test::kSpace));
  ASSERT_TRUE(learner.learn());
  const BoxScore score = score_boxes(learner.found(), test::spaces_of({}), 0.5);
  EXPECT_GT(score.precision, 0.9);
  EXPECT_GT(score.recall, 0.9);

  // The second map passes on the examples that it received.
  EXPECT_EQ(examples_of_map(second, options).at(test::kSpace).labels, of_spaces.labels);
}

TEST(LabelExamples, AnExampleThatIsNoWholeNumberOfValuesIsRefused) {
  const fs::path file = lot_file("damaged");
  const auto problem_of = [&](const Bytes& feature) {
    PlainTable table = examples_table({});
    table.rows.push_back({std::string(test::kSpace), std::int64_t{1}, 5.0, 2.5, feature});
    LabelStore(file).write_table(table);
    try {
      (void)stored_examples(file);
    } catch (const BadInput& fault) {
      return std::string(fault.what());
    }
    return std::string();
  };
  EXPECT_EQ(problem_of(Bytes(8, 0)), "");
  EXPECT_NE(problem_of(Bytes(7, 0)).find("box_examples.feature: got 7 bytes"), std::string::npos);
  EXPECT_NE(problem_of({}).find("feature: got 0 bytes"), std::string::npos);
  EXPECT_NE(problem_of(Bytes(4, 0xff)).find("no number"), std::string::npos);
}

TEST(LabelExamples, WhatIsNoMapHoldsNoClassifierAndTheErrorSaysSo) {
  const fs::path file = fs::path(testing::TempDir()) / "label_examples" / "model.yaml";
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "weights: [1, 2]\n";
  for (const fs::path& other : {file, file.parent_path() / "no_such.gpkg"}) {
    try {
      (void)examples_of_map(other, {});
      FAIL() << other;
    } catch (const BadInput& fault) {
      const std::string line = fault.what();
      EXPECT_NE(line.find("--classifier: got "), std::string::npos) << line;
      EXPECT_NE(line.find("want a map (.gpkg)"), std::string::npos) << line;
    }
  }
}

TEST(LabelExamples, AClassifierThatIsNotThereIsToldBeforeADriveIsRead) {
  const fs::path map = lot_file("oracle");
  OracleRequest request;
  request.map = map;
  request.drive = map.parent_path() / "no_such_drive";
  request.classifier = map.parent_path() / "no_such.gpkg";
  const auto told = [&] {
    try {
      (void)run_oracle(request, NoMessages());
    } catch (const BadInput& fault) {
      return std::string(fault.what());
    }
    return std::string();
  };
  EXPECT_NE(told().find("no_such.gpkg: --classifier"), std::string::npos) << told();
  request.classifier.clear();
  EXPECT_NE(told().find("no_such_drive"), std::string::npos) << told();
}

}  // namespace
}  // namespace roadbook
