#include "semantics/labels/label_effort.hpp"

#include <gtest/gtest.h>

// Compares the measured effort with events whose clicks and seconds are counted by hand.

namespace roadbook {
namespace {

// Events of a log at given seconds, as pages and programs write them.
class LabelEffortTest : public ::testing::Test {
 protected:
  std::int64_t add(const std::string& who,
                   double t_s,
                   const std::string& request,
                   Label label,
                   LabelAction action = LabelAction::kCreate,
                   bool together = false) {
    label.who = who;
    label.t_ns = static_cast<std::int64_t>(t_s * 1e9);
    if (label.id == 0) label.id = next_++;
    label.version = 1;
    const auto number = static_cast<std::int64_t>(replay_.events().size()) + 1;
    replay_.take({{number, action, label, 0, together}, request});
    return label.id;
  }
  void row(const std::string& who, double t_s, const std::string& request, int count) {
    for (int i = 0; i < count; ++i)
      add(who, t_s, request, box("space"), LabelAction::kCreate, true);
  }
  static Label box(const std::string& kind, LabelSource source = LabelSource::kDrawn) {
    Label label;
    label.kind = kind;
    label.source = source;
    return label;
  }

  LabelReplay replay_;
  std::int64_t next_ = 1;
};

TEST_F(LabelEffortTest, CountsEachStepOnceWithItsClicks) {
  add("ann", 100.0, "p/1", box("space"));
  row("ann", 110.0, "p/2", 5);  // a filled row
  row("ann", 112.0, "p/3", 1);  // one more space at the spacing of the row
  add("ann", 115.0, "p/4", box("space", LabelSource::kAccepted));
  for (int i = 0; i < 4; ++i)  // accepts all likely hypotheses
    add("ann", 118.0, "p/5", box("space", LabelSource::kAccepted), LabelAction::kCreate, true);
  add("ann", 120.0, "p/6", box("not_space", LabelSource::kAccepted));
  Label polygon = box("crossing");
  polygon.shape = LabelShape::kPolygon;
  polygon.corners_vehicle.resize(5);
  Label crossing = polygon;
  crossing.id = add("ann", 130.0, "p/7", polygon);
  crossing.kind = "bay";
  add("ann", 133.0, "p/8", crossing, LabelAction::kChange);
  crossing.state = LabelState::kDeleted;
  add("ann", 134.0, "p/9", crossing, LabelAction::kDelete);

  const LabelLedger ledger = label_effort(replay_);
  const LabelEffort& space = ledger.classes.at("space");
  EXPECT_EQ(space.labels, 12U);
  EXPECT_EQ(space.drawn, 1U);
  EXPECT_EQ(space.filled, 6U);
  EXPECT_EQ(space.accepted, 5U);
  EXPECT_EQ(space.rejected, 1U);
  EXPECT_EQ(space.all_clicks(), 3U + 1U + 1U + 1U + 1U + 1U);
  EXPECT_EQ(space.clicks.at(LabelStep::kDraw), 3U);
  EXPECT_EQ(space.clicks.at(LabelStep::kFill), 2U);
  EXPECT_EQ(space.clicks.at(LabelStep::kAccept), 2U);
  EXPECT_DOUBLE_EQ(space.seconds, 20.0);
  EXPECT_EQ(ledger.classes.at("crossing").all_clicks(), 6U);
  EXPECT_EQ(ledger.classes.at("crossing").drawn, 1U);
  EXPECT_EQ(ledger.classes.at("crossing").labels, 0U);
  EXPECT_EQ(ledger.classes.at("bay").changes, 2U);
  EXPECT_DOUBLE_EQ(ledger.classes.at("bay").seconds, 4.0);
  EXPECT_EQ(ledger.all.drawn, 2U);
  EXPECT_EQ(ledger.all.all_clicks(), 16U);
  EXPECT_DOUBLE_EQ(ledger.all.seconds, 34.0);
}

TEST_F(LabelEffortTest, TakesTimeFromTheSamePersonAndNoMoreThanAPause) {
  add("ann", 0.0, "p/1", box("space"));
  add("bob", 5.0, "q/1", box("space"));     // his first step: no time
  add("ann", 12.0, "p/2", box("space"));    // 12 s after her last step
  add("bob", 3000.0, "q/2", box("space"));  // after a break: counts as the longest pause
  add("bob", 2990.0, "q/3", box("space"));  // the clock was set back
  EXPECT_DOUBLE_EQ(label_effort(replay_).all.seconds, 12.0 + kLongestPauseS);
}

// Labels from a program need no clicks. They are not a step of the person who started the program.
TEST_F(LabelEffortTest, DoesNotTakeImportedLabelsForDrawn) {
  add("ann", 0.0, "p/1", box("space"));
  for (int i = 0; i < 30; ++i) add("ann", 4.0, "", box("space"), LabelAction::kCreate, true);
  add("ann", 9.0, "p/2", box("space"));
  const LabelEffort space = label_effort(replay_).classes.at("space");
  EXPECT_EQ(space.labels, 32U);
  EXPECT_EQ(space.drawn, 2U);
  EXPECT_EQ(space.filled, 0U);
  EXPECT_EQ(space.imported, 30U);
  EXPECT_EQ(space.all_clicks(), 6U);
  EXPECT_DOUBLE_EQ(space.seconds, 9.0);
}

TEST_F(LabelEffortTest, CountsPeopleInImagesToo) {
  Label window = box("person");
  window.shape = LabelShape::kUpright;
  add("ann", 0.0, "p/1", window, LabelAction::kCreate, true);
  window.source = LabelSource::kAccepted;
  Label image = box("not_person");
  image.shape = LabelShape::kImage;
  for (const Label& label : {window, window, image})  // marks the image as complete
    add("ann", 6.0, "p/2", label, LabelAction::kCreate, true);
  window.kind = "not_person";
  add("ann", 8.0, "p/3", window);
  const LabelEffort person = label_effort(replay_).classes.at("person");
  EXPECT_EQ(person.labels, 3U);
  EXPECT_EQ(person.drawn, 1U);
  EXPECT_EQ(person.filled, 0U);
  EXPECT_EQ(person.accepted, 2U);
  EXPECT_EQ(person.rejected, 1U);
  EXPECT_EQ(person.images, 1U);
  EXPECT_EQ(person.all_clicks(), 2U + 1U + 1U);
  EXPECT_DOUBLE_EQ(person.seconds, 8.0);
}

}  // namespace
}  // namespace roadbook
