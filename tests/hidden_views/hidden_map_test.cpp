#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/moved_landmarks.hpp"
#include "mapping/map_file.hpp"
#include "tests/hidden_views/study_case.hpp"
#include "tests/store/small_map.hpp"

// What a map that an earlier drive made gets wrong of the place, as a later drive sees it.

namespace roadbook::test {
namespace {

HiddenViewOptions revisit(std::uint64_t seed, const Secret& secret = {}) {
  HiddenViewOptions o;
  o.seed = seed;
  o.length_m = 60.0;
  o.outliers = 0.01;
  o.earlier = true;
  o.secret = secret;
  return o;
}

TEST(HiddenMap, NamesNothingWhereTheMapIsRight) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const Folder folder;
    const ViewOutcome o = run_hidden_map(revisit(seed), folder / "views");
    EXPECT_EQ(o.extra(), 0U) << o.to_line();
    EXPECT_FALSE(o.found.looked_for.empty());
  }
}

TEST(HiddenMap, LandmarksThatMovedAreCountedAndPlaced) {
  const Folder folder;
  const ViewOutcome o =
      run_hidden_map(revisit(11, {{"map.moved_landmarks", 0.08}}), folder / "views");
  const FoundCause* moved = o.cause("map.moved_landmarks");
  ASSERT_NE(moved, nullptr) << o.to_line();
  EXPECT_EQ(o.extra(), 0U) << o.to_line();
  EXPECT_LE(moved->low, 0.08) << o.to_line();
  EXPECT_GE(moved->high, 0.08) << o.to_line();
  EXPECT_NE(moved->note.find("within"), std::string::npos) << moved->note;
}

TEST(HiddenMap, ScaleAndBendComeOutWithTheirSign) {
  const Secret causes[] = {{{"map.scale", 0.01}}, {{"map.scale", -0.006}}, {{"map.bend", -3e-4}}};
  std::uint64_t seed = 20;
  for (const Secret& secret : causes) {
    const Folder folder;
    const ViewOutcome o = run_hidden_map(revisit(++seed, secret), folder / "views");
    const auto& [name, size] = *secret.begin();
    const FoundCause* cause = o.cause(name);
    ASSERT_NE(cause, nullptr) << o.to_line();
    EXPECT_EQ(o.extra(), 0U) << o.to_line();
    EXPECT_NEAR(cause->size, size, cause->high - cause->low) << o.to_line();
  }
}

}  // namespace
}  // namespace roadbook::test
