#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "semantics/overhead/overhead.hpp"
#include "tests/semantics/overhead_scene.hpp"

// The balance of exposure between the images of an overhead image.

namespace roadbook {
namespace {

using test::bytes_of;
using test::drive_over;
using test::quick_overhead;
using test::read_band;
using test::Scratch;

// Uniform ground of grey 100, seen by cameras with gains that differ by up to a factor of 1.6.
// After the balance, only rounding of grey values causes steps.
TEST(Overhead, ExposureStepsBetweenImagesAreBalanced) {
  const Scratch out("exposure");
  const auto plain = [](double, double) { return 100.0; };
  OverheadInput input = drive_over({.grey = plain}, 4, 1.6);
  Random random(3);
  for (OverheadView& view : input.views) {
    for (auto& image : view.images) {
      const double gain = random.uniform(0.75, 1.2);
      cv::Mat darker;
      image().convertTo(darker, CV_8U, gain);
      image = [darker] { return darker; };
    }
  }
  const auto spread = [&](bool balance) {
    OverheadOptions options = quick_overhead();
    options.balance_exposure = balance;
    const auto s = make_overhead(input, out.path() / (balance ? "on" : "off"), options);
    double low = 255;
    double high = 0;
    for (const double grey : read_band(s.image)) {
      if (grey == 0) continue;
      low = std::min(low, grey);
      high = std::max(high, grey);
    }
    return high - low;
  };
  EXPECT_GT(spread(false), 15.0);
  EXPECT_LT(spread(true), 5.0);
}

// A camera that looks ahead. Its images are brighter far away on the first half of the way, and
// darker on the second half. Gains that follow the overlaps rise to the middle and fall again.
OverheadInput glaring_drive() {
  constexpr int kViews = 48;
  OverheadInput input;
  input.rigs = {test::four_fisheyes(240, 180)};
  input.rigs[0].cameras.resize(1);
  for (int i = 0; i < kViews; ++i) {
    OverheadView view;
    view.T_map_vehicle.translation().x() = 0.5 * i;
    cv::Mat image =
        test::render(input.rigs[0].cameras[0], view.T_map_vehicle, {.grey = test::lines});
    for (int row = 0; row < image.rows; ++row) {
      const double far = (0.5 * image.rows - row) / image.rows;
      const cv::Mat of_row = image.row(row);
      of_row.convertTo(of_row, CV_8U, std::exp((i < kViews / 2 ? 2.0 : -2.0) * far));
    }
    view.images.emplace_back([image] { return image; });
    input.views.push_back(std::move(view));
  }
  return input;
}

TEST(Overhead, ABalanceThatSaturatesTheGroundIsDropped) {
  const Scratch out("glare");
  const OverheadInput input = glaring_drive();
  OverheadOptions options = quick_overhead();
  options.balance_exposure = false;
  const auto recorded = make_overhead(input, out.path() / "recorded", options);
  EXPECT_FALSE(recorded.exposure.balanced);
  EXPECT_TRUE(recorded.warnings.empty());

  options.balance_exposure = true;
  const auto held = make_overhead(input, out.path() / "held", options);
  EXPECT_TRUE(held.exposure.balanced);
  EXPECT_LE(held.exposure.saturated, recorded.exposure.saturated + 0.01);

  options.gains = {.prior_share = 1e-6, .most_gain = 100.0};  // the gains are not limited
  const auto dropped = make_overhead(input, out.path() / "dropped", options);
  EXPECT_FALSE(dropped.exposure.balanced);
  EXPECT_GT(dropped.exposure.saturated, dropped.exposure.saturated_recorded + 0.01);
  EXPECT_EQ(dropped.exposure.saturated_recorded, recorded.exposure.saturated);
  ASSERT_EQ(dropped.warnings.size(), 1U);
  EXPECT_EQ(dropped.warnings[0].field, "exposure balance");
  EXPECT_EQ(bytes_of(dropped.image), bytes_of(recorded.image));
  EXPECT_EQ(bytes_of(dropped.variance), bytes_of(recorded.variance));
}

}  // namespace
}  // namespace roadbook
