#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"
#include "speedmap/property_map/property_mapper.hpp"
#include "tests/speedmap/small_property_map.hpp"

namespace roadbook {
namespace {

using test::small_map;

TEST(PropertyMap, LabelsOfTheGeometricPoolMayComeInAnyOrder) {
  PropertyMapOptions options;
  options.semantics = SemanticModel::kGeometricPool;
  PropertyMap one = small_map(options), other = small_map(options);
  std::vector<std::pair<PathPlace, int>> labels;
  Random random(7);
  for (int i = 0; i < 300; ++i)
    labels.push_back({{random.uniform(0.0, 20.0), random.uniform(-3.0, 3.0)},
                      static_cast<int>(random.below(3))});
  for (const auto& [v, c] : labels) EXPECT_TRUE(one.add_label(v, c));
  for (std::size_t i = labels.size(); i-- > 0;) other.add_label(labels[i].first, labels[i].second);
  for (std::size_t l = 0; l < one.knots().size(); ++l)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(one.belief(l)[i], other.belief(l)[i], 1e-12 * one.belief(l)[i]);
}

TEST(PropertyMap, KnotsOutOfReachStayAsTheyWere) {
  PropertyMap map = small_map({});
  const PathPlace v{10.3, 0.4};
  for (int i = 0; i < 20; ++i) map.add_label(v, 2);
  EXPECT_EQ(map.add_value(0, v, 0.5).status, PropertyUpdate::kDone);
  for (std::size_t l = 0; l < map.knots().size(); ++l) {
    const PathPlace knot = map.knots().places()[l];
    const bool reached = std::hypot(knot.s_m - v.s_m, knot.e_m - v.e_m) < 2.0;
    EXPECT_EQ(map.belief(l)[2] != map.prior().counts[2], reached);
  }
}

TEST(PropertyMap, AMillionRandomUpdatesLeaveNoNanAndNothingNegative) {
  for (const auto semantics :
       {SemanticModel::kGeometricPool, SemanticModel::kLinearPool, SemanticModel::kDiscrete}) {
    PropertyMapOptions options;
    options.semantics = semantics;
    options.confusion = {0.9, 0.05, 0.05, 0.05, 0.9, 0.05, 0.05, 0.05, 0.9};
    PropertyMap map = small_map(options);
    Random random(8);
    for (int i = 0; i < 330000; ++i) {
      const PathPlace v{random.uniform(0.0, 20.0), random.uniform(-3.0, 3.0)};
      if (i % 2 == 0)
        map.add_label(v, static_cast<int>(random.below(3)), random.uniform(0.0, 3.0));
      else
        map.add_value(0, v, random.uniform(0.0, 1.5));
    }
    for (const NormalGamma& ng : map.property(0)) EXPECT_TRUE(ng.proper());
    std::vector<double> u(3);
    for (std::size_t l = 0; l < map.knots().size(); ++l) {
      map.knot_shares(l, u);
      for (const double share : u) EXPECT_TRUE(share >= 0.0 && share <= 1.0);
      const PropertyMoments moments = map.knot_moments(0, l);
      EXPECT_TRUE(std::isfinite(moments.mean) && moments.variance > 0.0);
    }
  }
}

TEST(PropertyMap, GradientsAndHessiansAgreeWithDifferences) {
  PropertyMap map = small_map({});
  Random random(9);
  for (int i = 0; i < 2000; ++i) {
    const PathPlace v{random.uniform(0.0, 20.0), random.uniform(-3.0, 3.0)};
    map.add_label(v, v.s_m < 8.0 ? 0 : v.e_m > 0.0 ? 1 : 2);
    if (i % 4 == 0) map.add_value(0, v, v.s_m < 8.0 ? 0.6 : v.e_m > 0.0 ? 0.9 : 0.4);
  }
  const double h = 1e-5;
  for (int i = 0; i < 100; ++i) {
    const PathPlace v{random.uniform(1.0, 19.0), random.uniform(-2.5, 2.5)};
    const auto at = map.moments_with_derivatives(0, v);
    ASSERT_TRUE(at);
    for (int k = 0; k < 2; ++k) {
      const PathPlace up{v.s_m + (k == 0 ? h : 0.0), v.e_m + (k == 1 ? h : 0.0)};
      const PathPlace down{v.s_m - (k == 0 ? h : 0.0), v.e_m - (k == 1 ? h : 0.0)};
      const auto forward = map.moments_with_derivatives(0, up);
      const auto back = map.moments_with_derivatives(0, down);
      EXPECT_NEAR(at->d_mean[k], (forward->mean - back->mean) / (2.0 * h), 1e-8);
      EXPECT_NEAR(at->d_variance[k], (forward->variance - back->variance) / (2.0 * h), 1e-8);
      EXPECT_LT((at->dd_mean.col(k) - (forward->d_mean - back->d_mean) / (2.0 * h)).norm(), 1e-6);
      EXPECT_LT(
          (at->dd_variance.col(k) - (forward->d_variance - back->d_variance) / (2.0 * h)).norm(),
          1e-6);
    }
  }
}

// One value in twenty is anything at all.
TEST(PropertyMap, GrossOutliersWidenTheClassesOnlyWhereTheyAreNotExpected) {
  const auto widest_class = [](double outlier_weight) {
    PropertyMapOptions options;
    options.outlier_weight = outlier_weight;
    PropertyMap map = small_map(options);
    Random random(10);
    const std::vector<double> truth = {0.6, 0.95, 0.45};
    const std::vector<PathPlace> places = {{3.0, 0.0}, {10.0, 0.0}, {17.0, 0.0}};
    for (std::size_t c = 0; c < 3; ++c)
      for (int i = 0; i < 500; ++i) map.add_label(places[c], static_cast<int>(c));
    for (std::size_t i = 0; i < 3000; ++i) {
      const bool outlier = random.uniform() < 0.05;
      const double y = random.normal(truth[i % 3], 0.04);
      map.add_value(0, places[i % 3], outlier ? random.uniform(0.0, 1.5) : y);
    }
    double widest = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      widest = std::max(widest, std::sqrt(map.property(0)[c].expected_variance()));
      if (outlier_weight > 0.0) {
        EXPECT_NEAR(map.property(0)[c].mu, truth[c], 0.01);
      }
    }
    return widest;
  };
  // The remaining effect of the outliers lies within the classes: some per cent of their width.
  EXPECT_NEAR(widest_class(0.05), 0.04, 0.008);
  EXPECT_GT(widest_class(0.0), 0.08);
}

TEST(PropertyMap, HalfOfWhatIsKnownIsForgottenAfterAHalfLife) {
  PropertyMapOptions options;
  options.half_life_s = 60.0;
  options.knot_half_life_s = 30.0;
  PropertyMap map = small_map(options);
  map.set_property(0, {{0.6, 40.0, 21.0, 0.1}, {0.9, 40.0, 21.0, 0.1}, {0.4, 40.0, 21.0, 0.1}});
  const std::vector<double> a = {9.0, 5.0, 1.0};
  map.set_belief(7, a, 8.0);
  map.forget(60.0);
  EXPECT_NEAR(map.property(0)[0].lambda, 20.0, 1e-12);
  EXPECT_NEAR(map.property(0)[0].alpha, 11.0, 1e-12);
  EXPECT_NEAR(map.property(0)[0].expected_variance(), 0.1 / 20.0, 1e-12);
  EXPECT_NEAR(map.belief(7)[0], 1.0 + 8.0 / 4.0, 1e-12);
  EXPECT_NEAR(map.knot_evidence(7), 2.0, 1e-12);
  map.forget(1e6);
  EXPECT_NEAR(map.property(0)[0].lambda, 2.0, 1e-9);
  EXPECT_GT(map.property(0)[0].alpha, 1.0);
}

TEST(PropertyMap, OnlyFiniteBeliefsAreTakenAndNoCountsOfZero) {
  for (const auto semantics : {SemanticModel::kGeometricPool, SemanticModel::kDiscrete}) {
    PropertyMapOptions options;
    options.semantics = semantics;
    options.confusion = {0.9, 0.05, 0.05, 0.05, 0.9, 0.05, 0.05, 0.05, 0.9};
    PropertyMap map = small_map(options);
    const bool discrete = semantics == SemanticModel::kDiscrete;
    const std::vector<double> none = {0.0, 1.0, 1.0};  // of discrete classes: a logarithm
    EXPECT_THROW(map.set_belief(3, std::vector<double>{1.0, NAN, 1.0}, 0.0), InvalidOption);
    EXPECT_THROW(map.set_belief(3, std::vector<double>{1.0, INFINITY, 1.0}, 0.0), InvalidOption);
    if (discrete)
      EXPECT_NO_THROW(map.set_belief(3, none, 0.0));
    else
      EXPECT_THROW(map.set_belief(3, none, 0.0), InvalidOption);
  }
}

TEST(PropertyMap, ASecondPropertyHasItsOwnClassesAndSharesTheLabels) {
  PropertyMapPrior prior = test::small_prior();
  PropertyPrior roughness = prior.properties[0];
  roughness.name = "roughness";
  roughness.unit = "mm";
  roughness.max = 60.0;
  for (NormalGamma& ng : roughness.classes) ng = {20.0, 1.0, 2.0, 100.0};
  prior.properties.push_back(roughness);
  PropertyMap map(test::small_knots(), prior);
  for (int i = 0; i < 50; ++i) map.add_label({5.0, 0.0}, 0);
  for (int i = 0; i < 50; ++i) map.add_label({15.0, 0.0}, 1);
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    map.add_value(1, {5.0, 0.0}, random.normal(40.0, 2.0));
    map.add_value(1, {15.0, 0.0}, random.normal(10.0, 1.0));
  }
  // 200 values of 2 and 1 mm: three standard errors.
  EXPECT_NEAR(map.property(1)[0].mu, 40.0, 0.45);
  EXPECT_NEAR(map.property(1)[1].mu, 10.0, 0.25);
  EXPECT_GT(map.moments(1, {5.0, 0.0})->mean, map.moments(1, {15.0, 0.0})->mean + 20.0);
  EXPECT_EQ(map.property(0)[0].mu, map.prior().properties[0].classes[0].mu);
}

TEST(PropertyMap, BadInputIsRefusedAndLeavesTheMapUnchanged) {
  PropertyMap map = small_map({});
  map.add_label({5.0, 0.0}, 1);
  const PropertyMap before = map;
  EXPECT_THROW(map.add_label({5.0, 0.0}, 3), BadInput);
  EXPECT_THROW(map.add_label({5.0, 0.0}, -1), BadInput);
  EXPECT_THROW(map.add_label({NAN, 0.0}, 1), BadInput);
  EXPECT_THROW(map.add_label({5.0, 0.0}, 1, -1.0), BadInput);
  EXPECT_THROW(map.add_label({5.0, 0.0}, 1, NAN), BadInput);
  EXPECT_THROW(map.add_value(0, {5.0, 0.0}, 40.0), BadInput);
  EXPECT_THROW(map.add_value(0, {5.0, 0.0}, NAN), BadInput);
  EXPECT_FALSE(map.add_label({5.0, 9.0}, 1));
  EXPECT_EQ(map.add_value(0, {5.0, 9.0}, 0.7).status, PropertyUpdate::kUncovered);
  for (std::size_t l = 0; l < map.knots().size(); ++l)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(map.belief(l)[i], before.belief(l)[i]);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(map.property(0)[i].mu, before.property(0)[i].mu);
  try {
    map.add_value(0, {5.0, 0.0}, 40.0);
  } catch (const BadInput& error) {
    EXPECT_STREQ(error.what(), "error: friction: got 40.000000, want 0.000000 to 1.500000");
  }
}

TEST(PropertyMap, PriorsThatHaveNoVarianceAreRefused) {
  PropertyMapPrior prior = test::small_prior();
  prior.properties[0].classes[1].alpha = 1.0;
  EXPECT_THROW(PropertyMap(test::small_knots(), prior), InvalidOption);
  prior = test::small_prior();
  prior.properties[0].classes[1].lambda = -1.0;
  EXPECT_THROW(PropertyMap(test::small_knots(), prior), InvalidOption);
  prior = test::small_prior();
  prior.counts[0] = 0.0;
  EXPECT_THROW(PropertyMap(test::small_knots(), prior), InvalidOption);
  PropertyMapOptions options;
  options.semantics = SemanticModel::kDiscrete;
  EXPECT_THROW(small_map(options), InvalidOption);
  options.confusion = {0.9, 0.1, 0.1, 0.1, 0.9, 0.1, 0.1, 0.1, 0.9};
  EXPECT_THROW(small_map(options), InvalidOption);
}

// The prior swaps the classes and has a high confidence in them.
TEST(PropertyMapper, AWrongAndConfidentPriorIsRepairedFromTheLog) {
  PropertyMapPrior prior = test::small_prior();
  prior.properties[0].classes = {
      {0.95, 90.0, 90.0, 0.2}, {0.35, 90.0, 90.0, 0.2}, {0.70, 90.0, 90.0, 0.2}};
  PropertyMapper mapper(PropertyMap(test::small_knots(), prior));
  Random random(12);
  const std::vector<double> truth = {0.6, 0.95, 0.45};
  for (int i = 0; i < 1500; ++i) {
    const PathPlace v{random.uniform(0.0, 20.0), random.uniform(-3.0, 3.0)};
    const std::size_t c = v.s_m < 7.0 ? 0 : v.s_m < 14.0 ? 1 : 2;
    mapper.map().add_label(v, static_cast<int>(c));
    if (i > 500) mapper.add_value(0, v, random.normal(truth[c], 0.05));
    mapper.travelled(0.1 * i);
  }
  EXPECT_GT(mapper.refreshes(), 5);
  // 300 values a class with 5 % from across its border: below 0.03.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(mapper.map().property(0)[i].mu, truth[i], 0.03);
}

// Values fit the classes, then the road changes. The refresh is due at once, not after 50 m.
TEST(PropertyMapper, ValuesThatBecomeImprobableMakeARefreshDueEarly) {
  PropertyMapPrior prior = test::small_prior();
  prior.properties[0].classes = {
      {0.6, 90.0, 90.0, 0.2}, {0.9, 90.0, 90.0, 0.2}, {0.4, 90.0, 90.0, 0.2}};
  for (const double then : {0.9, 0.3}) {
    RefreshOptions options;
    options.early_until_m = 0.0;
    PropertyMapper mapper(PropertyMap(test::small_knots(), prior), options);
    EXPECT_TRUE(mapper.travelled(10.0));
    Random random(4, "refresh");
    const auto drive = [&](double mean) {
      for (int i = 0; i < 40; ++i)
        mapper.add_value(0, {random.uniform(0.0, 20.0), 0.0}, random.normal(mean, 0.05));
      return mapper.travelled(20.0);
    };
    for (int s = 0; s <= 20; ++s) mapper.map().add_label({1.0 * s, 0.0}, 1, 50.0);
    EXPECT_FALSE(drive(0.9));
    EXPECT_EQ(drive(then), then != 0.9);
  }
}

}  // namespace
}  // namespace roadbook
