#include "semantics/labels/label_store.hpp"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "base/random.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_sqlite.hpp"
#include "semantics/labels/label_check.hpp"
#include "semantics/labels/label_json.hpp"
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

TEST_F(LabelStoreTest, ManyAtOnceLoseAndDoubleNothing) {
  LabelStore store(map_);
  std::vector<std::thread> people;
  for (int person = 0; person < 4; ++person)
    people.emplace_back([&, person] {
      for (int i = 0; i < 20; ++i)
        store.create(space(store, 0.1 * i), "p" + std::to_string(person));
    });
  for (auto& p : people) p.join();
  std::set<std::int64_t> ids;
  for (const Label& label : store.labels()) ids.insert(label.id);
  EXPECT_EQ(ids.size(), 80U);
  EXPECT_EQ(*ids.rbegin(), 80);
}

// Number of changes of the file. SQLite counts transactions in its header.
std::uint32_t transactions_of(const std::filesystem::path& map) {
  std::array<char, 4> bytes{};
  std::ifstream file(map, std::ios::binary);
  file.seekg(24).read(bytes.data(), bytes.size());
  std::uint32_t count = 0;
  for (const char byte : bytes) count = count << 8U | static_cast<unsigned char>(byte);
  return count;
}

TEST_F(LabelStoreTest, ManyThatWaitForAReaderAreStoredTogether) {
  LabelStore store(map_);
  const std::uint32_t before = transactions_of(map_);
  std::vector<std::thread> people;
  {
    const SqlDatabase reader(map_, SqlMode::kRead);  // another program reads with SQLite
    reader.run("BEGIN");
    static_cast<void>(reader.value("SELECT count(*) FROM map_meta"));
    for (int person = 0; person < 8; ++person)
      people.emplace_back(
          [&, person] { store.create(space(store, 0.1), "p" + std::to_string(person)); });
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(transactions_of(map_), before);
    reader.run("COMMIT");
  }
  for (auto& p : people) p.join();
  EXPECT_EQ(store.labels().size(), 8U);
  EXPECT_LE(transactions_of(map_) - before, 2U);  // the first alone, then the seven that waited
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

TEST(LabelJson, GoesThereAndBack) {
  const Map map = test::label_map(5);
  Label box = label_of_box(map, {0, map.keyframes[2].t_ns, 3}, {{1.0, 4.0}, 0.7, 5.0, 2.5});
  box.kind = "parking_space";
  box.note = "\"</script>";
  Label polygon = label_of_polygon(map, {0, map.keyframes[2].t_ns, 3}, {{0, 0}, {2, 0}, {1, 2}});
  polygon.kind = "crossing";
  for (const Label& label : {box, polygon}) {
    const Label back =
        label_from_json(nlohmann::ordered_json::parse(label_to_json(label).dump()), "test");
    EXPECT_EQ(label_to_json(back).dump(), label_to_json(label).dump());
    EXPECT_EQ(back.T_vehicle_label.translation(), label.T_vehicle_label.translation());
    EXPECT_EQ(back.corners_vehicle, label.corners_vehicle);
  }
}

// Labels of older programs stay readable. Otherwise a map with such labels could not be opened.
TEST(LabelJson, WhatIsNotStoredAnyMoreIsStillRead) {
  const Map map = test::label_map(5);
  const LabelAnchor anchor{0, map.keyframes[2].t_ns, 3};
  const auto kept = [&](std::vector<Eigen::Vector3d> corners, const std::string& kind) {
    Label label = label_of_polygon(map, anchor, {{0, 0}, {2, 0}, {1, 2}});
    label.corners_vehicle = std::move(corners);
    label.kind = kind;
    EXPECT_THROW(check_new_label(label, "test"), BadInput);
    const Label back = label_from_json(label_to_json(label), "test");
    return back.corners_vehicle == label.corners_vehicle && back.kind == kind;
  };
  EXPECT_TRUE(kept({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, "crossing"));  // no area
  EXPECT_TRUE(kept({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}}, "crossing"));
  EXPECT_TRUE(kept({{0, 0, 0}, {2, 0, 0}, {1, 2, 0}}, "cross\ning"));
}

// Replaces every field by every kind of wrong value. The parser must refuse the input or return a
// valid label.
TEST(LabelJson, SurvivesWrongValuesInAnyField) {
  const Map map = test::label_map(5);
  Label label = label_of_polygon(map, {0, map.keyframes[2].t_ns, 3}, {{0, 0}, {2, 0}, {1, 2}});
  label.kind = "crossing";
  const auto good = label_to_json(label);
  const auto wrong = nlohmann::ordered_json::parse(
      R"([null, true, -1, 0, 3.5, 1e300, 18446744073709551615, "", "x", [], {}, [[]], [1, 2, 3], [null], {"t_ns": "x"}])");
  int refused = 0;
  const auto flat = good.flatten();
  for (const auto& [field, value] : flat.items())
    for (const auto& other : wrong) {
      auto damaged = good;
      damaged[nlohmann::ordered_json::json_pointer(field)] = other;
      try {
        check_label(label_from_json(damaged, "test"), "test");
      } catch (const BadInput&) {
        ++refused;
      }
    }
  EXPECT_GT(refused, 10 * static_cast<int>(flat.size()));
  auto more = good;
  more["unknown"] = 1;
  EXPECT_THROW((void)label_from_json(more, "test"), BadInput);
}

}  // namespace
}  // namespace roadbook
