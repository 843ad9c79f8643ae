#include "semantics/labels/label_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "semantics/labels/label_check.hpp"
#include "tests/semantics/label_store_fixture.hpp"

namespace roadbook {
namespace {

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
