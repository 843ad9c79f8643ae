#include "speedmap/property_map/kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "speedmap/property_map/interpolation.hpp"

namespace roadbook {
namespace {

constexpr double kPi = std::numbers::pi;

Knots grid(double spacing, KernelWidth width, bool closed = false) {
  KnotGridOptions options;
  options.length_m = 30.0;
  options.closed = closed;
  options.e_min_m = -4.0;
  options.e_max_m = 4.0;
  options.spacing_s_m = options.spacing_e_m = spacing;
  options.width = width;
  return Knots::grid(options);
}

PathPlace random_place(Random& random) {
  return {random.uniform(0.0, 30.0), random.uniform(-4.0, 4.0)};
}

// The formula as printed in the document, with the inequality of the support corrected.
double printed_kernel(double r) {
  const double a = 2.0 * kPi * r;
  return (2.0 + std::cos(a)) / 3.0 * (1.0 - r) + std::sin(a) / (2.0 * kPi);
}

TEST(Kernel, IsThePrintedFormulaInsideItsSupport) {
  for (double r = 0.0; r < 1.0; r += 0.001)
    EXPECT_NEAR(sparse_kernel(r), printed_kernel(r), 1e-14) << r;
  EXPECT_EQ(sparse_kernel(1.0), 0.0);
  EXPECT_EQ(sparse_kernel(1.5), 0.0);
}

TEST(Kernel, StaysPositiveUpToTheEdgeWhereThePrintedFormTurnsNegative) {
  double previous = 1.0;
  bool printed_negative = false;
  for (double gap = 1e-1; gap > 1e-12; gap *= 0.9) {
    const double k = sparse_kernel(1.0 - gap);
    EXPECT_GT(k, 0.0);
    EXPECT_LT(k, previous);
    previous = k;
    printed_negative |= printed_kernel(1.0 - gap) < 0.0;
  }
  EXPECT_TRUE(printed_negative);
}

// The fifth difference over h tends to the fifth derivative: 0 outside, -1039 inside the edge; the
// fourth derivative is continuous there, so four derivatives may be used and not five.
TEST(Kernel, HasFourContinuousDerivativesAtTheEdgeAndNotFive) {
  // k = theta^5 / (360 pi) (1 + ...): the n-th derivative at theta -> 0 is of order theta^(5-n).
  const double gap = 1e-4;
  const double theta = 2.0 * kPi * gap;
  const double leading = std::pow(theta, 5) / (360.0 * kPi);
  EXPECT_NEAR(sparse_kernel(1.0 - gap) / leading, 1.0, theta * theta);
  const double fifth = -120.0 / (360.0 * kPi) * std::pow(2.0 * kPi, 5);
  EXPECT_NEAR(fifth, -1039.0, 0.5);
}

TEST(Kernel, DerivativesAgreeWithDifferencesOverTheWholeSupport) {
  const double h = 1e-5;
  for (double r = 2e-5; r < 1.0 - 2.0 * h; r += 0.0007) {
    const KernelDerivatives d = sparse_kernel_derivatives(r);
    const double first = (sparse_kernel(r + h) - sparse_kernel(r - h)) / (2.0 * h);
    const double second = (sparse_kernel_derivatives(r + h).first_over_r * (r + h) -
                           sparse_kernel_derivatives(r - h).first_over_r * (r - h)) /
                          (2.0 * h);
    EXPECT_NEAR(d.first_over_r * r, first, 1e-8);
    EXPECT_NEAR(d.bend * r * r + d.first_over_r, second, 1e-7);
  }
}

TEST(Interpolation, IsAPartitionOfUnity) {
  const Knots knots = grid(1.0, {2.0, 2.0});
  Random random(1);
  Interpolation I;
  for (int i = 0; i < 1000; ++i) {
    interpolate(knots, random_place(random), I);
    ASSERT_TRUE(I.covered());
    double sum = 0.0;
    for (const double w : I.weights) sum += w;
    EXPECT_NEAR(sum, 1.0, 1e-14);
  }
}

// The reference tests every knot, without hashing.
TEST(Interpolation, FindsTheKnotsThatASearchThroughAllOfThemFinds) {
  Random random(2);
  for (const bool closed : {false, true})
    for (const KernelWidth width : {KernelWidth{2.0, 2.0}, KernelWidth{3.3, 1.1}}) {
      std::vector<PathPlace> places;
      for (int i = 0; i < 300; ++i) places.push_back(random_place(random));
      const Knots knots(places, width, closed ? std::optional<double>(30.0) : std::nullopt);
      Interpolation I;
      for (int i = 0; i < 500; ++i) {
        const PathPlace v{random.uniform(-10.0, 40.0), random.uniform(-6.0, 6.0)};
        interpolate(knots, v, I);
        std::vector<double> k(places.size());
        double sum = 0.0;
        std::size_t near = 0;
        for (std::size_t l = 0; l < places.size(); ++l) {
          const double x = knots.difference_along(v.s_m, places[l].s_m) / width.s_m;
          const double y = (v.e_m - places[l].e_m) / width.e_m;
          k[l] = sparse_kernel(std::hypot(x, y));
          near += std::hypot(x, y) < 1.0 ? 1 : 0;
          sum += k[l];
        }
        ASSERT_EQ(I.size(), near);
        for (std::size_t n = 0; n < I.size(); ++n)
          EXPECT_NEAR(I.weights[n], k[static_cast<std::size_t>(I.knots[n])] / sum, 1e-11);
      }
    }
}

TEST(Interpolation, DerivativesAgreeWithDifferences) {
  const Knots knots = grid(1.0, {2.0, 2.5});
  Random random(3);
  const double h = 1e-5;
  Interpolation I, forward, back;
  InterpolationDerivatives d, d_forward, d_back;
  for (int i = 0; i < 200; ++i) {
    const PathPlace v = random_place(random);
    interpolate(knots, v, I, d);
    for (int k = 0; k < 2; ++k) {
      const PathPlace step{k == 0 ? h : 0.0, k == 1 ? h : 0.0};
      interpolate(knots, {v.s_m + step.s_m, v.e_m + step.e_m}, forward, d_forward);
      interpolate(knots, {v.s_m - step.s_m, v.e_m - step.e_m}, back, d_back);
      if (forward.knots != I.knots || back.knots != I.knots) continue;
      for (std::size_t n = 0; n < I.size(); ++n) {
        EXPECT_NEAR(d.gradients[n][k], (forward.weights[n] - back.weights[n]) / (2.0 * h), 1e-8);
        const Eigen::Vector2d column = (d_forward.gradients[n] - d_back.gradients[n]) / (2.0 * h);
        EXPECT_LT((d.hessians[n].col(k) - column).norm(), 1e-6);
      }
    }
  }
}

TEST(Interpolation, SaysWhereNothingIsNearInsteadOfDividingByZero) {
  const Knots knots = grid(1.0, {2.0, 2.0});
  Interpolation I;
  for (const PathPlace v : {PathPlace{-2.5, 0.0}, PathPlace{10.0, 6.5}, PathPlace{33.0, 0.0},
                            PathPlace{NAN, 0.0}, PathPlace{1.0, NAN}, PathPlace{INFINITY, 0.0}}) {
    interpolate(knots, v, I);
    EXPECT_FALSE(I.covered());
  }
}

TEST(Knots, RefuseAKernelThatLeavesHolesBetweenThem) {
  EXPECT_THROW(grid(1.0, {0.7, 0.7}), InvalidOption);
  EXPECT_NO_THROW(grid(1.0, {0.72, 0.72}));
  EXPECT_THROW(grid(1.0, {-1.0, 2.0}), InvalidOption);
  EXPECT_THROW(Knots({}, {2.0, 2.0}, std::nullopt), InvalidOption);
  EXPECT_THROW(Knots({{0.0, NAN}}, {2.0, 2.0}, std::nullopt), InvalidOption);
  EXPECT_THROW(Knots({{0.0, 0.0}}, {2.0, 2.0}, 7.0), InvalidOption);
}

}  // namespace
}  // namespace roadbook
