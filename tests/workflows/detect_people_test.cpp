#include "workflows/detect_people.hpp"

#include <gtest/gtest.h>

#include "mapping/store/map_file.hpp"
#include "sim/simulate.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/workflows/recorded_messages.hpp"
#include "tests/workflows/thrown_problem.hpp"
#include "workflows/map_drives.hpp"
#include "workflows/people/people_detect.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

TEST(DetectPeople, StoresTheDetectionsOfTheVerb) {
  const test::ScratchFolder folder;
  SimulateOptions drive;
  drive.max_duration_s = 8.0;
  (void)simulate(load_scenario("zurich", {"small", 1, 0.25}), folder.path() / "drive", drive);
  MapRequest map;
  map.drives = {folder.path() / "drive"};
  map.map = folder.path() / "place.gpkg";
  NoMessages nobody;
  (void)map_drives(map, nobody);
  fs::copy_file(map.map, folder.path() / "verb.gpkg");

  DetectRequest request;
  request.map = map.map;
  request.oracle = {"drive"};
  request.options.every_s = 1.0;
  request.taught_examples = [](const fs::path&) { return PersonExamples(); };
  test::RecordedMessages messages;
  const DetectResult result = detect_people(request, messages);
  EXPECT_FALSE(result.rounds.empty());
  EXPECT_EQ(messages.said.size(), result.rounds.size() + 1);  // one line each, one per session
  EXPECT_FALSE(messages.stages.empty());
  EXPECT_GT(result.positives, 0U);
  EXPECT_LT(result.positives, result.examples);
  ASSERT_EQ(result.sessions.size(), 1U);
  EXPECT_EQ(result.sessions.front().session, "drive");
  ASSERT_TRUE(result.sessions.front().score.has_value());
  EXPECT_GT(result.sessions.front().score->people, 0U);
  EXPECT_EQ(result.digest, load_meta(map.map).digest);

  const auto verb = test::run_command("roadbook detect -m verb.gpkg --oracle drive --every-s 1 -q",
                                      folder.path());
  ASSERT_EQ(verb.status, 0) << verb.err;
  EXPECT_EQ(map_digest(map.map), map_digest(folder.path() / "verb.gpkg"));

  request.oracle = {"nowhere"};
  EXPECT_EQ(test::thrown_problem([&] { (void)detect_people(request, messages); }).field,
            "--oracle");
  request.oracle.clear();
  request.anew = true;  // no example is left
  EXPECT_THROW((void)detect_people(request, messages), Refused);
  EXPECT_EQ(map_digest(map.map), result.digest);
}

TEST(PeopleScore, TheErrorOfFeetIsTheirMedian) {
  PeopleScore score;
  EXPECT_EQ(score.median_error_m(), 0.0);
  score.foot_error_m = {0.3, 0.1, 9.0, 0.2, 0.4};
  EXPECT_EQ(score.median_error_m(), 0.3);
}

}  // namespace
}  // namespace roadbook
