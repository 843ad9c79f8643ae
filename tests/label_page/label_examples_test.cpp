#include "apps/label_examples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "apps/label_server/label_place.hpp"
#include "base/error.hpp"
#include "semantics/label_classes.hpp"
#include "semantics/label_oracle.hpp"
#include "semantics/label_store.hpp"
#include "tests/label_page/lot.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSpace = "parking_space";

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
  for (std::size_t i = 0; i < count; ++i) hang(spaces[i], kSpace);
  OrientedBox aisle = spaces.front();
  aisle.centre.y() = 0.0;
  hang(aisle, rejected_kind(kSpace));
}

TEST(LabelExamples, AMapsLabelsTeachTheDetectorOfTheNextMapAndStayWithIt) {
  const BoxLearnerOptions options;
  const fs::path first = lot_file("first");
  EXPECT_THROW((void)examples_of_map(first, options), BadInput) << "nothing is labelled";
  label_spaces(first, 6);
  const ExamplesByKind taught = examples_of_map(first, options);
  ASSERT_EQ(taught.count(kSpace), 1U);
  const BoxExamples& of_spaces = taught.at(kSpace);
  EXPECT_NEAR(of_spaces.length_m, 5.0, 1e-9);
  EXPECT_EQ(std::count(of_spaces.labels.begin(), of_spaces.labels.end(), 1), 12) << "both ways";

  const fs::path second = lot_file("second");
  LabelStore(second).write_table(examples_table(taught));
  const ExamplesByKind stored = stored_examples(second);
  ASSERT_EQ(stored.count(kSpace), 1U);
  EXPECT_EQ(stored.at(kSpace).features, of_spaces.features);
  EXPECT_EQ(stored.at(kSpace).labels, of_spaces.labels);

  // Nothing is drawn there, and its spaces are found.
  BoxLearner learner(read_label_place(second).image, options);
  learner.start_from(stored.at(kSpace));
  ASSERT_TRUE(learner.learn());
  const BoxScore score = score_boxes(learner.found(), test::spaces_of({}), 0.5);
  EXPECT_GT(score.precision, 0.9);
  EXPECT_GT(score.recall, 0.9);

  // What the second map was given, it gives on.
  EXPECT_EQ(examples_of_map(second, options).at(kSpace).labels, of_spaces.labels);
}

}  // namespace
}  // namespace roadbook
