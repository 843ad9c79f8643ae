#include <gtest/gtest.h>

#include "mapping/store/map_file.hpp"
#include "tests/apps/friction_place.hpp"
#include "tests/workflows/recorded_messages.hpp"
#include "tests/workflows/thrown_problem.hpp"
#include "workflows/find_roads.hpp"
#include "workflows/learn_friction.hpp"
#include "workflows/overhead_of_map.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// The functions that read the images of a map's drive.
TEST(LearnedPlace, OverheadAndFrictionAreThoseOfTheVerbs) {
  const test::FrictionPlace place;
  RoadsRequest roads;
  roads.map = place.file();
  (void)find_roads(roads, NoMessages());
  fs::copy_file(place.file(), place.path("verb.gpkg"));
  const auto verb = [&](const std::string& command) {
    const auto result = place.run("roadbook " + command + " -m verb.gpkg -q");
    EXPECT_EQ(result.status, 0) << result.err;
  };

  OverheadRequest overhead;
  overhead.map = place.file();
  overhead.options.resolution_m = 0.1;
  test::RecordedMessages messages;
  const OverheadResult image = overhead_of_map(overhead, messages);
  EXPECT_GT(image.summary.covered_m2, 50.0);
  EXPECT_EQ(image.summary.image.parent_path(), place.path("place_overhead"));
  EXPECT_EQ(image.vehicles.size(), 1U);
  EXPECT_FALSE(messages.stages.empty());
  EXPECT_TRUE(messages.notes.empty());
  verb("overhead --resolution-m 0.1");
  EXPECT_EQ(map_digest(place.file()), map_digest(place.path("verb.gpkg")));
  EXPECT_EQ(test::read_text(image.summary.image),
            test::read_text(place.path("verb_overhead") / image.summary.image.filename()));

  FrictionRequest friction;
  friction.map = place.file();
  friction.drive = place.path("road");
  friction.slice = place.path("slice.json");
  messages.stages.clear();
  const FrictionResult learned = learn_friction(friction, messages);
  EXPECT_GT(learned.summary.frames, 0U);
  EXPECT_EQ(learned.friction.sessions, std::vector<std::string>{"road"});
  EXPECT_FALSE(learned.speeds_older);
  EXPECT_FALSE(messages.stages.empty());
  verb("friction road --slice verb.json");
  EXPECT_EQ(map_digest(place.file()), map_digest(place.path("verb.gpkg")));

  // Errors name the field and leave the map unchanged.
  const std::string before = map_digest(place.file());
  friction.slice = place.path("slice.txt");
  EXPECT_EQ(test::thrown_problem([&] { (void)learn_friction(friction, messages); }).field,
            "--slice");
  fs::rename(place.path("road"), place.path("elsewhere"));
  const Problem absent = test::thrown_problem([&] { (void)overhead_of_map(overhead, messages); });
  EXPECT_EQ(absent.field, "drives");
  EXPECT_EQ(absent.file, place.file().string());
  ASSERT_EQ(messages.warnings.size(), 1U);
  EXPECT_EQ(messages.warnings.front().field, "drive of session road");
  EXPECT_EQ(map_digest(place.file()), before);
}

}  // namespace
}  // namespace roadbook
