#include "exchange/layers/dropped_work.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

using Names = std::vector<std::string>;

TEST(DroppedWork, IsNamedInTheOrderOfItsCommands) {
  const auto dropped =
      dropped_work({"dynamic_map", "friction", "friction_mean", "friction_sigma", "intersections",
                    "lanes", "notes", "overhead", "overhead_count", "people", "speed_map",
                    "speed_sigma", "wear_colours", "wear_mean"},
                   "my place.gpkg");
  Names names;
  Names commands;
  for (const DroppedWork& work : dropped) {
    names.push_back(work.name);
    commands.push_back(work.command);
  }
  EXPECT_EQ(names, (Names{"overhead image", "road network", "friction map", "people", "speed map",
                          "layers of other programs"}));
  EXPECT_EQ(commands,
            (Names{"roadbook overhead -m 'my place.gpkg'", "roadbook roads -m 'my place.gpkg'",
                   "roadbook roads -m 'my place.gpkg'", "roadbook detect -m 'my place.gpkg'",
                   "roadbook speeds -m 'my place.gpkg'", ""}));
  // The rasters of every property belong to the friction map. A table whose name has the same
  // ending does not.
  EXPECT_EQ(dropped[2].layers,
            (Names{"friction", "friction_mean", "friction_sigma", "wear_colours", "wear_mean"}));
  EXPECT_EQ(dropped[4].layers, (Names{"dynamic_map", "speed_map", "speed_sigma"}));
  EXPECT_EQ(dropped[5].layers, Names{"notes"});
}

TEST(DroppedWork, IsNoneWhereOnlyTheDrawnLandmarksWent) {
  EXPECT_TRUE(dropped_work({"landmark_points"}, "place.gpkg").empty());
  EXPECT_TRUE(dropped_work({}, "place.gpkg").empty());
}

}  // namespace
}  // namespace roadbook
