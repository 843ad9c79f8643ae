#include <gtest/gtest.h>

#include "tests/exchange/export/lanelet2/lanelet2_files.hpp"
#include "tests/exchange/planner_place.hpp"

// The checker of the tests finds the faults that it is there for.

namespace roadbook {
namespace {

using test::check_osm;
using test::problems_of;
using test::written;

struct OsmFault {
  const char* name;
  const char* said;  // by the checker
};

void expect_found(const std::filesystem::path& file,
                  const std::string& profile,
                  const std::vector<OsmFault>& faults) {
  std::vector<std::string> names;
  for (const OsmFault& fault : faults) names.emplace_back(fault.name);
  test::break_export(file, names);
  for (const OsmFault& fault : faults) {
    SCOPED_TRACE(fault.name);
    const auto broken = file.parent_path() / fault.name;
    int status = -1;
    const std::string text = check_osm(broken, profile, &status);
    EXPECT_NE(status, 0);
    EXPECT_NE(problems_of(text).find(fault.said), std::string::npos)
        << problems_of(text).substr(0, 500);
  }
}

TEST(Lanelet2Checker, TheCheckerFindsEachFaultOfAPlainFile) {
  const test::PlannerPlace place;
  expect_found(written(place.map, "lanelet2"), "",
               {{"no_limit", "no speed_limit"},
                {"zero_limit", "read 0 km/h"},
                {"private", "do not know location private"},
                {"no_subtype", "no subtype"},
                {"unknown_tag", "tag roadbook:part is unknown"},
                {"local_tags", "tag local_x is unknown"},
                {"unknown_line", "type painted is unknown"},
                {"ring", "a ring in one lanelet"},
                {"unshared", "too close and not shared"},
                {"too_close", "too close and not shared"},
                {"too_long", "at most 50 m"},
                {"no_length", "no length"},
                {"bent", "a bound bends with"},
                {"same_id", "id is not unique"},
                {"area_participant", "tag participant:vehicle is unknown"},
                {"open_area", "no ring"},
                {"rule_in_plain", "does not parse"},
                {"walking_cars", "no lanelet lets vehicles pass"}});
}

TEST(Lanelet2Checker, TheCheckerFindsEachFaultOfAnAutowareFile) {
  const test::PlannerPlace place;
  expect_found(written(place.map, "autoware"), "autoware",
               {{"unturned", "not where latitude and longitude are"},
                {"no_local", "no local_x, local_y"},
                {"no_height", "no ele"},
                {"two_ways", "does not know one_way=no"},
                {"three_nodes", "has two nodes, not 3"},
                {"turned_space", "no lanelet within 5 m that it faces"},
                {"no_width", "has a width"},
                {"no_lot", "in no parking_lot"},
                {"open_lot", "parking_lot is an area"},
                {"far_space", "in no parking_lot"},
                {"no_turn_direction", "a turn without turn_direction"},
                {"wrong_turn_direction", "turn_direction right turns by"},
                {"straight_turn", "turn_direction straight turns by"},
                {"no_rule", "no regulatory element refers to it"},
                {"rule_without_walk", "needs one refers"},
                {"rule_without_outline", "needs one refers"},
                {"road_without_rule", "without its rule"},
                {"no_limit", "no speed_limit"},
                {"private", "do not know location private"}});
}

}  // namespace
}  // namespace roadbook
