#include "sim/scenario/scenario.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "sim/world/layout.hpp"

namespace roadbook {
namespace {

std::string error_of(const std::string& text) {
  try {
    (void)parse_scenario(text, "lot.yaml");
  } catch (const BadInput& e) {
    return e.what();
  }
  return "";
}

const char* const kLot = R"(name: lot
ground: {low: [0, 0], high: [20, 20]}
lanes:
  - {name: a, points: [[2, 2], [18, 2]]}
route: [a]
)";

TEST(Scenario, ReadsTheSmallestLot) {
  const Scenario scenario = parse_scenario(kLot, "lot.yaml");
  EXPECT_EQ(scenario.lanes.size(), 1U);
  EXPECT_EQ(scenario.laps, std::vector<int>{1});
}

TEST(Scenario, BuiltInPlacesHaveTheirSpaces) {
  EXPECT_EQ(make_layout(load_scenario("stuttgart")).spaces.size(), 164U);
  EXPECT_EQ(make_layout(load_scenario("zurich")).spaces.size(), 80U);
  EXPECT_EQ(load_scenario("zurich").crossings.size(), 2U);
  EXPECT_EQ(load_scenario("zurich").laps.size(), 7U);
  EXPECT_EQ(load_scenario("zurich").laps.front(), 2);
}

TEST(Scenario, NamesThePlaceOfAnUnknownKey) {
  const std::string text = std::string(kLot) + "vehicle: {max_sped: 3}\n";
  EXPECT_EQ(error_of(text),
            "error: lot.yaml:6: vehicle.max_sped: got unknown key, want 'max_speed'");
}

TEST(Scenario, NamesThePlaceOfABadNumber) {
  const std::string text = std::string(kLot) + "vehicle:\n  max_speed: fast\n";
  const std::string error = error_of(text);
  EXPECT_EQ(error.find("error: lot.yaml:7: vehicle.max_speed: got fast, want a number"), 0U)
      << error;
}

TEST(Scenario, RefusesALaneThatDoesNotExist) {
  std::string text = kLot;
  text.replace(text.find("route: [a]"), 10, "route: [b]");
  EXPECT_EQ(error_of(text), "error: lot.yaml:5: route[0]: got b, want one of a");
}

TEST(Scenario, RefusesBrokenYaml) {
  EXPECT_EQ(error_of("name: [a\n").find("error: lot.yaml:"), 0U);
}

TEST(Scenario, SuggestsABuiltInName) {
  try {
    (void)load_scenario("zurch");
    FAIL();
  } catch (const BadInput& e) {
    EXPECT_NE(std::string(e.what()).find("want 'zurich'"), std::string::npos) << e.what();
  }
}

TEST(Scenario, RevisitsFindOtherCarsInTheSamePlaces) {
  ScenarioOptions options;
  const Layout first = make_layout(load_scenario("zurich", options));
  options.visit = 1;
  const Layout second = make_layout(load_scenario("zurich", options));
  ASSERT_EQ(first.spaces.size(), second.spaces.size());
  EXPECT_EQ(first.spaces[7].centre, second.spaces[7].centre);
  std::vector<int> a, b;
  for (const auto& car : first.cars) a.push_back(car.space);
  for (const auto& car : second.cars) b.push_back(car.space);
  EXPECT_NE(a, b);
}

}  // namespace
}  // namespace roadbook
