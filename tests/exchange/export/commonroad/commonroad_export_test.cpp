#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <set>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"
#include "exchange/export/planner/lanelets.hpp"
#include "tests/exchange/planner_place.hpp"
#include "tests/exchange/planner_routes.hpp"
#include "tests/roadnet/random_lots.hpp"

// check_commonroad.py checks the CommonRoad scenarios. If $ROADBOOK_COMMONROAD_XSD names the schema
// (XML_commonRoad_XSD.xsd of commonroad-io), xmllint checks them as well.

namespace roadbook {
namespace {

using test::lines_with;
using test::number_in;

std::string check_scenario(const std::filesystem::path& file, int* status = nullptr) {
  return test::run_script("check_commonroad.py " + file.string(), status);
}

std::filesystem::path scenario_of(const std::filesystem::path& map,
                                  const ExportOptions& options = {},
                                  ExportNotes* notes = nullptr) {
  const auto out = map.parent_path() / "scenario.xml";
  export_map(map, "commonroad", out, options, notes);
  return out;
}

std::string faults_in(const std::string& text) {
  std::string faults;
  for (const auto& words : lines_with(text, "problem")) {
    for (const std::string& word : words) faults += word + " ";
    faults += "\n";
  }
  return faults;
}

std::map<std::string, std::size_t> count_types(const std::string& text) {
  std::map<std::string, std::size_t> types;
  for (const auto& l : lines_with(text, "lanelet")) ++types[l[1]];
  return types;
}

TEST(CommonRoadExport, AScenarioHasNoFaultForACheckerOfItsOwn) {
  const test::PlannerPlace place;
  ExportNotes notes;
  const auto file = scenario_of(place.map, {}, &notes);
  int status = -1;
  const std::string text = check_scenario(file, &status);
  EXPECT_EQ(status, 0) << faults_in(text);
  const PlannerMap planner(place.map);
  std::size_t roads = 0;
  std::size_t turns = 0;
  for (const Lanelet& lanelet : lanelets_of(planner).lanelets)
    (lanelet.piece >= 0 ? roads : turns) += lanelet.both_ways ? 2 : 1;
  const auto types = count_types(text);
  EXPECT_EQ(types.at("urban"), roads);
  EXPECT_EQ(types.at("intersection,urban"), turns);
  EXPECT_EQ(types.at("parking"), test::spaces_of_place().size() - 1);
  EXPECT_EQ(types.at("crosswalk"), test::crossings_of_place().size());
  EXPECT_GT(number_in(lines_with(text, "goal").at(0)[0]), 5.0);
  std::map<std::string, std::size_t> left_out;
  for (const ExportNote& note : notes) left_out[note.what] = note.count;
  EXPECT_EQ(left_out["links of parking spaces to lanes"], test::kLinkedSpaces);
  EXPECT_EQ(left_out["parking spaces"], 1U);
  EXPECT_EQ(left_out["heights of lanelets"], roads + turns);
}

// Checks the limits and lengths of the lanelets. The opposite direction has a separate id.
TEST(CommonRoadExport, LimitsAreThoseOfTheSpeedProfile) {
  const test::PlannerPlace place;
  const std::string text = check_scenario(scenario_of(place.map));
  std::map<std::string, std::vector<std::string>> lanelets;
  for (const auto& l : lines_with(text, "lanelet")) lanelets[l[0]] = l;
  const PlannerMap planner(place.map);
  for (const Lanelet& lanelet : lanelets_of(planner).lanelets) {
    std::vector<std::uint64_t> ids{lanelet.id};
    if (lanelet.both_ways) ids.push_back(id_of_way_back(lanelet));
    for (const std::uint64_t id : ids) {
      const auto& words = lanelets.at(std::to_string(id));
      EXPECT_LE(number_in(words[2]), lanelet.speed);
      EXPECT_NEAR(number_in(words[2]), lanelet.speed, 2e-4);
      EXPECT_NEAR(number_in(words[3]), lanelet.bounds.centre_length_m(), 0.02);
    }
  }
}

TEST(CommonRoadExport, LaneletsOfTwoWaysShareTheirBounds) {
  const test::PlannerPlace place;
  const std::string text = check_scenario(scenario_of(place.map));
  std::map<std::string, std::vector<std::string>> left;
  std::map<std::string, std::vector<std::string>> right;
  for (const auto& p : lines_with(text, "left")) left[p[0]].push_back(p[1] + " " + p[2]);
  for (const auto& p : lines_with(text, "right")) right[p[0]].push_back(p[1] + " " + p[2]);
  std::size_t both = 0;
  for (const Lanelet& lanelet : lanelets_of(PlannerMap(place.map)).lanelets) {
    if (!lanelet.both_ways) continue;
    ++both;
    const std::string back = std::to_string(id_of_way_back(lanelet));
    EXPECT_EQ(left.at(std::to_string(lanelet.id)).front(), right.at(back).back());
    EXPECT_EQ(right.at(std::to_string(lanelet.id)).back(), left.at(back).front());
  }
  EXPECT_GT(both, 5U);
}

TEST(CommonRoadExport, AMapWithAnOriginIsTurnedToEastAndNorth) {
  const test::PlannerPlace place;
  ExportOptions options;
  options.origin = GeoOrigin{47.3769, 8.5417, 90.0};
  const std::string plain = check_scenario(scenario_of(place.map));
  int status = -1;
  const std::string turned = check_scenario(scenario_of(place.map, options), &status);
  EXPECT_EQ(status, 0) << faults_in(turned);
  const auto a = lines_with(plain, "left");
  const auto b = lines_with(turned, "left");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(number_in(b[i][1]), -number_in(a[i][2]), 2e-4);
    EXPECT_NEAR(number_in(b[i][2]), number_in(a[i][1]), 2e-4);
  }
}

TEST(CommonRoadExport, EachCountryHasItsOwnSign) {
  const test::Folder folder;
  const auto map = test::map_with_paths(folder);
  for (const std::string& country : commonroad_countries()) {
    ExportOptions options;
    options.country = country;
    int status = -1;
    const std::string text = check_scenario(scenario_of(map, options), &status);
    EXPECT_EQ(status, 0) << country << faults_in(text);
  }
  ExportOptions options;
  options.country = "GBR";
  EXPECT_THROW(scenario_of(map, options), InvalidOption);
}

TEST(CommonRoadExport, ScenariosOfRandomCarParksHaveNoFault) {
  for (int shape = 0; shape < test::kLotShapes; ++shape) {
    const test::Lot lot = test::random_lot(shape, 3);
    SCOPED_TRACE(lot.name);
    const test::Folder folder;
    int status = -1;
    const std::string text = check_scenario(
        scenario_of(test::map_of_passes(folder, test::drive_lot(lot, 3, 0.1, 0.2, 3))), &status);
    EXPECT_EQ(status, 0) << faults_in(text).substr(0, 2000);
  }
}

TEST(CommonRoadExport, TheCheckerFindsEachFault) {
  const test::PlannerPlace place;
  const auto file = scenario_of(place.map);
  const std::vector<std::pair<std::string, std::string>> faults{
      {"cr_no_problem", "no planning problem"},
      {"cr_no_limit", "no speed limit"},
      {"cr_foreign_sign", "no speed limit that its country"},
      {"cr_zero_limit", "no speed limit"},
      {"cr_no_type", "types"},
      {"cr_uneven_bounds", "points to the left"},
      {"cr_one_sided", "does not name it"},
      {"cr_no_links", "but is no successor"},
      {"cr_moved", "begins elsewhere"},
      {"cr_order", "in order"},
      {"cr_swapped", "left bound lies to the right"},
      {"cr_dangling", "nothing has id"},
      {"cr_same_id", "ids are not unique"},
      {"cr_version", "no CommonRoad 2020a"},
      {"cr_hasty", "the goal takes"}};
  std::vector<std::string> names;
  for (const auto& fault : faults) names.push_back(fault.first);
  test::break_export(file, names);
  for (const auto& [name, said] : faults) {
    SCOPED_TRACE(name);
    const auto broken = file.parent_path() / name;
    int status = -1;
    const std::string text = check_scenario(broken, &status);
    EXPECT_NE(status, 0);
    EXPECT_NE(faults_in(text).find(said), std::string::npos) << faults_in(text).substr(0, 500);
  }
}

TEST(CommonRoadExport, AScenarioIsValidByTheSchema) {
  const char* const schema = std::getenv("ROADBOOK_COMMONROAD_XSD");
  if (schema == nullptr) GTEST_SKIP() << "$ROADBOOK_COMMONROAD_XSD names no schema";
  const test::PlannerPlace place;
  for (const bool on_earth : {false, true}) {
    ExportOptions options;
    if (on_earth) options.origin = GeoOrigin{47.3769, 8.5417, 30.0};
    const std::string said = test::output_of("xmllint --noout --schema " + std::string(schema) +
                                             " " + scenario_of(place.map, options).string());
    EXPECT_NE(said.find("scenario.xml validates"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace roadbook
