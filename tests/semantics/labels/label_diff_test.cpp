#include "semantics/labels/label_diff.hpp"

#include <numbers>

#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_classes.hpp"
#include "tests/semantics/label_store_fixture.hpp"

// Compares the reported changes between two versions of a map with known edits.

namespace roadbook {
namespace {

class LabelDiff : public test::LabelStoreTest {
 protected:
  // Ann draws `count` labels. `before_` keeps this version of the map.
  void begin(int count) {
    LabelStore store(map_);
    for (int i = 0; i < count; ++i) store.create(space(store, 2.5 * i), "ann");
    before_ = store.events();
  }
  [[nodiscard]] std::vector<std::string> told() const {
    std::vector<std::string> lines;
    for (const LabelDifference& d : label_differences(before_, read_label_events(map_))) {
      std::string line = std::to_string(d.label.id) + " " + to_text(d.kind) + " by " + d.who;
      for (const LabelFieldChange& f : d.fields) line += ", " + f.field + " by " + f.who;
      lines.push_back(line);
    }
    return lines;
  }
  static Label moved(const Label& label, double x_m) {
    Label other = label;
    other.T_vehicle_label.translation().x() += x_m;
    return other;
  }

  std::vector<LabelEvent> before_;
};

TEST_F(LabelDiff, GivesPlantedEditsBackAndNothingElse) {
  begin(8);
  {
    LabelStore store(map_);
    Label other_class = *store.find(2);
    other_class.kind = "crossing";
    store.change(other_class, "bob");
    store.remove(3, 1, "bob");
    store.change(moved(*store.find(4), 0.3), "bob");
    Label noted = *store.find(4);
    noted.note = "disabled";
    store.change(noted, "cid");
    Label larger = *store.find(5);
    larger.length_m += 0.05;
    larger.anchor.t_ns = store.map().keyframes[4].t_ns;
    store.change(larger, "ann");
    Label rejected = *store.find(6);
    rejected.kind = rejected_kind(rejected.kind);
    store.change(rejected, "bob");
    store.create(space(store, 30.0), "cid");
  }
  EXPECT_EQ(told(), (std::vector<std::string>{"2 changed by bob, kind by bob", "3 deleted by bob",
                                              "4 changed by cid, middle by bob, note by cid",
                                              "5 changed by ann, anchor by ann, length_m by ann",
                                              "6 changed by bob, kind by bob", "9 added by cid"}));
  const auto all = label_differences(before_, read_label_events(map_));
  EXPECT_EQ(all[0].fields[0].from, "parking_space");
  EXPECT_EQ(all[0].fields[0].to, "crossing");
  EXPECT_NEAR(all[2].fields[0].to[0].get<double>() - all[2].fields[0].from[0].get<double>(), 0.3,
              1e-9);
  EXPECT_EQ(all[1].t_ns, LabelStore(map_).find(3)->t_ns);
  EXPECT_GT(all[1].t_ns, before_.back().label.t_ns);
}

TEST_F(LabelDiff, SaysNothingOfWhatHasComeToNothing) {
  begin(4);
  {
    LabelStore store(map_);
    Label turned = *store.find(4);
    turned.T_vehicle_label.linear() =
        Eigen::AngleAxisd(std::numbers::pi - 1e-9, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    store.change(turned, "ann");
    before_ = store.events();
  }
  {
    LabelStore store(map_);
    store.change(*store.find(1), "bob");  // seen again at the same place
    store.change(moved(*store.find(2), 0.3), "bob");
    store.undo("bob");
    store.remove(3, 1, "bob");
    store.undo("bob");
    const Label drawn = store.create(space(store, 30.0), "bob");
    store.remove(drawn.id, drawn.version, "ann");
    Label turned = *store.find(4);  // past pi, where headings continue at -pi
    turned.T_vehicle_label.rotate(Eigen::AngleAxisd(2e-9, Eigen::Vector3d::UnitZ()));
    store.change(turned, "bob");
  }
  EXPECT_EQ(told(), std::vector<std::string>{});
}

// The poses of the labels' anchors move. This is a shift (`label_shifts`), not a change.
TEST_F(LabelDiff, DoesNotTakeAMapThatHasMovedForAChange) {
  begin(4);
  Map map = load_map(map_);
  for (MapFrame& frame : map.map_frames)
    frame.T_map_frame.translation() += Eigen::Vector3d(2, 1, 0);
  MapFileBuilder(map_, "moved").finish(map, {});
  {
    LabelStore store(map_);
    store.change(*store.find(1), "bob");
  }
  EXPECT_EQ(told(), std::vector<std::string>{});
}

TEST_F(LabelDiff, TellsWhatWasDeletedThenAndIsThereAgain) {
  begin(2);
  {
    LabelStore store(map_);
    store.remove(2, 1, "ann");
    before_ = store.events();
    Label back = *store.find(2);
    back.kind = "crossing";
    store.change(back, "bob");
  }
  EXPECT_EQ(told(), std::vector<std::string>{"2 restored by bob, kind by bob"});
}

// Two people work on copies of the same map, and each draws a label with id 3.
TEST_F(LabelDiff, OfMapsThatWereLabelledApartOneNumberIsTwoLabels) {
  begin(2);
  const auto copy = folder_ / "copy.gpkg";
  std::filesystem::copy_file(map_, copy);
  {
    LabelStore theirs(copy);
    theirs.create(space(theirs, 30.0), "bob");
    before_ = theirs.events();
    LabelStore mine(map_);
    mine.create(space(mine, 40.0), "ann");
  }
  EXPECT_EQ(told(), (std::vector<std::string>{"3 added by ann", "3 deleted by "}));
}

}  // namespace
}  // namespace roadbook
