#include "semantics/labels/label_store.hpp"

#include <gtest/gtest.h>

#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/semantics/label_store_fixture.hpp"

namespace roadbook {
namespace {

using test::LabelStoreTest;

TEST_F(LabelStoreTest, LabelsComeBackAfterReopeningWithTheirHistory) {
  {
    LabelStore store(map_);
    const Label first = store.create(space(store, 1.0), "ann");
    EXPECT_EQ(first.id, 1);
    EXPECT_EQ(first.version, 1);
    Label moved = first;
    moved.width_m = 2.6;
    EXPECT_EQ(store.change(moved, "bob").version, 2);
    const Label second = store.create(space(store, 4.0), "ann");
    store.remove(second.id, second.version, "ann");
  }
  const LabelStore store(map_);
  ASSERT_EQ(store.labels().size(), 1U);
  EXPECT_EQ(store.labels().front().width_m, 2.6);
  EXPECT_EQ(store.labels().front().who, "bob");
  EXPECT_EQ(store.labels(true).size(), 2U);
  ASSERT_EQ(store.events().size(), 4U);
  EXPECT_EQ(store.events(3).front().action, LabelAction::kDelete);
  EXPECT_TRUE(check_map(map_).problems.empty());
  EXPECT_EQ(read_labels(map_).size(), 1U);
}

TEST_F(LabelStoreTest, AChangeOfAnOlderVersionIsAConflictThatShowsTheNewest) {
  LabelStore store(map_);
  const Label label = store.create(space(store, 1.0), "ann");
  Label by_ann = label;
  by_ann.width_m = 2.6;
  store.change(by_ann, "ann");
  Label by_bob = label;
  by_bob.width_m = 2.4;
  try {
    store.change(by_bob, "bob");
    FAIL() << "no conflict";
  } catch (const LabelConflict& conflict) {
    EXPECT_EQ(conflict.current.width_m, 2.6);
    EXPECT_EQ(conflict.current.version, 2);
  }
  EXPECT_EQ(store.find(label.id)->width_m, 2.6);
}

TEST_F(LabelStoreTest, UndoAndRedoWalkThroughEachPersonsOwnChanges) {
  LabelStore store(map_);
  const Label a = store.create(space(store, 1.0), "ann");
  const Label b = store.create(space(store, 4.0), "bob");
  Label wider = a;
  wider.width_m = 3.0;
  store.change(wider, "ann");
  store.remove(b.id, b.version, "bob");

  EXPECT_EQ(store.undo("ann").at(0).width_m, 2.5);
  EXPECT_EQ(store.undo("ann").at(0).state, LabelState::kDeleted);  // undoes its creation
  EXPECT_TRUE(store.undo("ann").empty());
  EXPECT_EQ(store.redo("ann").at(0).state, LabelState::kActive);
  EXPECT_EQ(store.redo("ann").at(0).width_m, 3.0);
  EXPECT_TRUE(store.redo("ann").empty());
  EXPECT_EQ(store.undo("bob").at(0).state, LabelState::kActive);
  EXPECT_EQ(store.undo("ann").at(0).width_m, 2.5);
  store.create(space(store, 8.0), "ann");
  EXPECT_TRUE(store.redo("ann").empty());  // ann has made another change since
  EXPECT_EQ(store.labels().size(), 3U);
}

TEST_F(LabelStoreTest, WhatSomebodyElseHasChangedSinceIsNotTakenBack) {
  LabelStore store(map_);
  Label label = store.create(space(store, 1.0), "ann");
  label.width_m = 2.7;
  store.change(label, "bob");
  EXPECT_THROW((void)store.undo("ann"), LabelConflict);
}

// Returns the label for which an undo is refused.
Label refused_for(LabelStore& store, const std::string& request, const StepBack& step = {}) {
  try {
    (void)store.undo("ann", request, step);
  } catch (const LabelConflict& conflict) {
    return conflict.current;
  }
  ADD_FAILURE() << request << " was not refused";
  return {};
}

// Ann draws two labels in one step. Bob then changes one of them.
TEST_F(LabelStoreTest, StepsThatCannotBeTakenBackMayBePassedOver) {
  LabelStore store(map_);
  Label other = store.create(space(store, 9.0), "ann", "other");
  Label first = store.create(space(store, 1.0), "ann", "first");
  first.note = "narrow";
  first = store.change(first, "ann", "changed");
  const auto both = store.create_all({space(store, 4.0), space(store, 7.0)}, "ann", "both");
  Label second = both[1];
  second.width_m = 2.7;
  second = store.change(second, "bob");
  const Label told = refused_for(store, "u1");
  EXPECT_EQ(told.id, second.id);
  const StepBack past{.passed = {{told.id, told.version}}};
  EXPECT_EQ(store.undo("ann", "u2", past).at(0).note, "");
  EXPECT_EQ(store.undo("ann", "u3", past).at(0).state, LabelState::kDeleted);
  EXPECT_EQ(store.redo("ann", "r3").at(0).state, LabelState::kActive);
  EXPECT_EQ(store.redo("ann", "r2").at(0).note, "narrow");
  // The same undo works again. When bob undoes his change, ann can undo the step that was passed
  // over.
  EXPECT_EQ(store.undo("ann", "u4", past).at(0).id, first.id);
  EXPECT_EQ(store.undo("bob").at(0).width_m, 2.5);
  EXPECT_EQ(store.undo("ann", "u5", past).at(0).id, first.id);
  EXPECT_EQ(store.undo("ann", "u6", past).size(), 2U);
  EXPECT_EQ(store.undo("ann", "u7", past).at(0).id, other.id);
  EXPECT_TRUE(store.undo("ann", "u8", past).empty());
}

TEST_F(LabelStoreTest, OnlyWhatWasToldIsPassedOver) {
  LabelStore store(map_);
  Label first = store.create(space(store, 1.0), "ann", "1");
  Label second = store.create(space(store, 4.0), "ann", "2");
  const Label third = store.create(space(store, 7.0), "ann", "3");
  Label changed = third;
  changed.note = "bob's";
  const Label bobs = store.change(changed, "bob");
  StepBack past{.passed = {{third.id, third.version}}};
  EXPECT_EQ(refused_for(store, "u1", past).id, third.id) << "of another version";
  past.passed = {{bobs.id, bobs.version}};
  second.note = "bob's";
  second = store.change(second, "bob");
  EXPECT_EQ(refused_for(store, "u2", past).id, second.id);
  past.passed.emplace_back(second.id, second.version);
  past.last = "2";
  EXPECT_THROW((void)store.undo("ann", "u3", past), LabelStepElsewhere);
  past.last = "1";
  EXPECT_EQ(store.undo("ann", "u4", past).at(0).id, first.id);
  EXPECT_TRUE(store.undo("ann", "u5", past).empty());
}

// Each undo reverts two changes. Bob has since changed the label of one of the newest two changes.
// The two changes before them are on the label of the other.
TEST_F(LabelStoreTest, WhatLiesUnderAStepThatStandsIsPassedOverWithIt) {
  LabelStore store(map_);
  Label one = store.create(space(store, 1.0), "cid");
  Label two = store.create(space(store, 4.0), "ann");
  two.note = "narrow";
  two = store.change(two, "ann");
  two.width_m = 2.7;
  two = store.change(two, "ann");
  one.note = "ann's";
  one = store.change(one, "ann");
  one.note = "bob's";
  one = store.change(one, "bob");
  EXPECT_TRUE(store.undo("ann", "u", {.count = 2, .passed = {{one.id, one.version}}}).empty());
  EXPECT_EQ(store.find(two.id)->note, "narrow");
}

TEST_F(LabelStoreTest, WhatSomebodyElseHasChangedAndPutBackIsTakenBack) {
  LabelStore store(map_);
  Label label = store.create(space(store, 1.0), "ann");
  label.note = "narrow";
  store.change(label, "bob");
  EXPECT_EQ(store.undo("bob").at(0).note, "");
  EXPECT_EQ(store.undo("ann").at(0).state, LabelState::kDeleted);
}

// An undo does not show the label to a person. It restores the `seen` value from before the change.
TEST_F(LabelStoreTest, UndoBringsBackWhatWasSeen) {
  Label label;
  {
    LabelStore store(map_);
    label = store.create(space(store, 1.0), "ann");
  }
  Map moved = load_map(map_);
  moved.map_frames[3].T_map_frame.translation().x() += 0.5;
  MapFileBuilder(map_, "again").finish(moved, {});
  LabelStore store(map_);
  const auto seen_x = [&] { return store.find(label.id)->seen->middle.x(); };
  EXPECT_DOUBLE_EQ(seen_x(), label.seen->middle.x());
  store.change(*store.find(label.id), "ann");  // at the same place
  EXPECT_NEAR(seen_x(), label.seen->middle.x() + 0.5, 1e-9);
  store.undo("ann");
  EXPECT_DOUBLE_EQ(seen_x(), label.seen->middle.x());
  store.redo("ann");
  EXPECT_NEAR(seen_x(), label.seen->middle.x() + 0.5, 1e-9);
  store.remove(label.id, store.find(label.id)->version, "ann");
  store.undo("ann");
  store.undo("ann");
  EXPECT_DOUBLE_EQ(seen_x(), label.seen->middle.x());
}

TEST_F(LabelStoreTest, TheSameRequestSentTwiceIsStoredOnceAlsoAcrossARestart) {
  std::int64_t id = 0;
  {
    LabelStore store(map_);
    id = store.create(space(store, 1.0), "ann", "r-1").id;
    EXPECT_EQ(store.create(space(store, 1.0), "ann", "r-1").id, id);
  }
  LabelStore store(map_);
  EXPECT_EQ(store.create(space(store, 1.0), "ann", "r-1").id, id);
  EXPECT_EQ(store.labels().size(), 1U);
}

TEST_F(LabelStoreTest, WhatOneRequestStoredIsTakenBackAndBroughtAgainAsOneStepAlsoAfterARestart) {
  {
    LabelStore store(map_);
    store.create(space(store, 0.0), "ann", "one");
    const auto row = std::vector<Label>{space(store, 1.0), space(store, 4.0), space(store, 7.0)};
    EXPECT_EQ(store.create_all(row, "ann", "row").size(), 3U);
    EXPECT_EQ(store.create_all(row, "ann", "row").size(), 3U);  // as if the answer was lost
    EXPECT_EQ(store.labels().size(), 4U);
  }
  LabelStore store(map_);
  EXPECT_EQ(store.undo("ann", "u").size(), 3U);
  EXPECT_EQ(store.undo("ann", "u").size(), 3U);  // sent again: no further undo
  EXPECT_EQ(store.labels().size(), 1U);
  EXPECT_EQ(store.redo("ann", "v").size(), 3U);
  EXPECT_EQ(store.labels().size(), 4U);
  EXPECT_EQ(store.undo("ann").size(), 3U);
  EXPECT_EQ(store.undo("ann").size(), 1U);
  EXPECT_TRUE(store.labels().empty());
}

TEST_F(LabelStoreTest, RefusesWhatIsNoLabelAndLeavesTheMapAsItWas) {
  LabelStore store(map_);
  const Label good = space(store, 1.0);
  Label bad = good;
  bad.kind.clear();
  EXPECT_THROW(store.create(bad, "ann"), BadInput);
  bad = good;
  bad.width_m = -1.0;
  EXPECT_THROW(store.create(bad, "ann"), BadInput);
  bad = good;
  bad.anchor.t_ns = 5;
  EXPECT_THROW(store.create(bad, "ann"), BadInput);
  bad = good;
  bad.id = 99;
  EXPECT_THROW(store.change(bad, "ann"), BadInput);
  bad = good;
  bad.shape = LabelShape::kPolygon;
  bad.corners_vehicle = {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_THROW(store.create(bad, "ann"), BadInput);
  EXPECT_TRUE(store.events().empty());
}

}  // namespace
}  // namespace roadbook
