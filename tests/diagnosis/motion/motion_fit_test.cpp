#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/motion/motion_model.hpp"
#include "diagnosis/motion/wet_place_search.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

// Drives of one vehicle exchange sizes after one step each.
TEST(MotionFit, OneIterationMovesADiscByOneStepOnly) {
  test::HiddenDriveOptions options;
  options.seed = 3;
  options.secret["wheels0.wet_patch"] = 0.07;
  Observations obs = observe(test::streams_of(test::record_drive(options)));
  MotionModel model = nominal_model(obs);
  model.accepted = slipping_places(obs, model);
  ASSERT_EQ(model.accepted.size(), 1U);
  Candidate& disc = model.accepted[0].candidate;
  disc.place_x += 1.5 * std::cos(disc.place_heading);
  disc.place_y += 1.5 * std::sin(disc.place_heading);
  const Candidate off = disc;
  const auto moved_m = [&](int iterations) {
    MotionModel fitted = model;
    fit_model(obs, fitted, iterations);
    const Candidate& now = fitted.accepted[0].candidate;
    return std::hypot(now.place_x - off.place_x, now.place_y - off.place_y);
  };
  EXPECT_LT(moved_m(1), 0.5 + 1e-9);
  EXPECT_GT(moved_m(2), 1.0);
}

}  // namespace
}  // namespace roadbook
