#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/random.hpp"
#include "diagnosis/views/view_problem.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/diagnosis/hidden_effects/seed_of_today.hpp"
#include "tests/diagnosis/hidden_views/study_case.hpp"
#include "tests/mapping/store/small_map.hpp"

// Residuals of views correlate if whole images are shifted or turned, and only then.

namespace roadbook::test {
namespace {

constexpr double kNotWhite = 1e-6;

HiddenViewOptions drive_of_today(const std::string& name,
                                 std::uint64_t i,
                                 double shift_px = 0.0,
                                 double length_m = 120.0) {
  HiddenViewOptions o;
  o.seed = Random(seed_of_today(), "white views " + name, i)() >> 1U;
  o.length_m = length_m;
  o.outliers = i % 2 == 0 ? 0.0 : 0.02;
  o.images_shift_px = shift_px;
  return o;
}

// p-values of each camera by the nominal model.
std::vector<double> whiteness(const HiddenViewOptions& hidden) {
  const Folder folder;
  write_hidden_views(hidden, folder / "views");
  const ViewProblem problem(
      view_data(load_map(folder / "views/map.gpkg"), 0, Drive::open(folder / "views/drive")));
  std::vector<double> all;
  for (const auto& [camera, p] : problem.project(problem.nominal(), {}).innovations.whiteness_p)
    all.push_back(p);
  return all;
}

// Kolmogorov-Smirnov test against the uniform distribution; no false alarm.
void expect_uniform(std::vector<double> all) {
  std::sort(all.begin(), all.end());
  const auto n = static_cast<double>(all.size());
  double farthest = 0.0;  // of their distribution from the uniform one
  for (std::size_t i = 0; i < all.size(); ++i)
    farthest = std::max({farthest, (static_cast<double>(i) + 1.0) / n - all[i],
                         all[i] - static_cast<double>(i) / n});
  EXPECT_GT(all.front(), kNotWhite);
  EXPECT_LT(farthest, std::sqrt(std::log(2.0 / 1e-5) / (2.0 * n)));  // p = 1e-5
}

// The same with corner errors that are equal in neighbouring views: these are not errors of the
// camera.
TEST(ViewWhiteness, OfDrivesWithoutACauseIsUniform) {
  for (const double wander_px : {0.0, 0.5}) {
    SCOPED_TRACE(wander_px);
    std::vector<double> all;
    for (std::uint64_t i = 0; i < 8; ++i) {
      HiddenViewOptions hidden = drive_of_today("null", i, 0.0, 50.0);
      hidden.corners_wander_px = wander_px;
      const std::vector<double> p = whiteness(hidden);
      EXPECT_EQ(p.size(), 4U);
      all.insert(all.end(), p.begin(), p.end());
    }
    expect_uniform(all);
  }
}

TEST(ViewWhiteness, ImagesThatAreShiftedByAThirdOfAPixelAreToldOfNearlyEveryCamera) {
  for (std::uint64_t i = 0; i < 2; ++i) {
    SCOPED_TRACE(i);
    const std::vector<double> p = whiteness(drive_of_today("shifted", i, 0.3));
    EXPECT_GE(std::count_if(p.begin(), p.end(), [](double one) { return one < kNotWhite; }), 3);
  }
}

// A milliradian moves a view by a third of a pixel, some outwards and some inwards.
TEST(ViewWhiteness, ImagesThatAreTurnedAndStretchedAreToldOfNearlyEveryCamera) {
  for (std::uint64_t i = 0; i < 2; ++i) {
    SCOPED_TRACE(i);
    HiddenViewOptions hidden = drive_of_today("turned", i);
    hidden.images_turn = 1e-3;
    const std::vector<double> p = whiteness(hidden);
    EXPECT_GE(std::count_if(p.begin(), p.end(), [](double one) { return one < kNotWhite; }), 3);
  }
}

TEST(ViewWhiteness, WhatIsFoundInImagesThatAreShiftedDoesNotMakeThemWhite) {
  const Folder folder;
  const ViewOutcome o = run_hidden_views(drive_of_today("diagnosed", 0, 1.0), folder / "views");
  for (const char* camera : {"cam0", "cam1", "cam2", "cam3"}) {
    const std::string said = std::string("autocorrelation in ") + camera + " (reprojection)";
    EXPECT_EQ(std::count(o.found.unexplained.begin(), o.found.unexplained.end(), said), 1)
        << o.to_line();
  }
}

// Errors common to an image are not independent evidence: no false effect may be reported.
TEST(ViewWhiteness, ImagesThatAreShiftedHaveNoOtherCause) {
  for (const auto& [seed, shift_px] : {std::pair(6U, 0.3), {5U, 1.0}}) {
    HiddenViewOptions hidden = drive_of_today("named", 1, shift_px);
    hidden.seed = seed;
    const Folder folder;
    const ViewOutcome o = run_hidden_views(hidden, folder / "views");
    EXPECT_EQ(o.extra(), 0U) << o.to_line();
  }
}

// A catalogued effect is no correlation once it is in the model.
TEST(ViewWhiteness, ComesBackOnceTheCauseIsFound) {
  const Folder folder;
  HiddenViewOptions hidden = drive_of_today("cause", 0);
  hidden.secret = {{"cam1.centre", 4.0}};
  const ViewOutcome o = run_hidden_views(hidden, folder / "views");
  const auto least = [](const std::vector<ChannelCheck>& checks) {
    double p = 1.0;
    for (const ChannelCheck& c : checks)
      if (c.channel == "reprojection") p = std::min(p, c.whiteness_p);
    return p;
  };
  EXPECT_LT(least(o.found.before), kNotWhite) << o.to_line();
  EXPECT_GT(least(o.found.after), kNotWhite) << o.to_line();
}

}  // namespace
}  // namespace roadbook::test
