#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "base/random.hpp"
#include "speedmap/experiments/spm_experiment.hpp"
#include "speedmap/property_map/gaussian_process.hpp"
#include "tests/support/source_tree.hpp"

namespace roadbook {
namespace {

SpmExperimentOptions two_maps() {
  SpmExperimentOptions options;
  options.maps = 2;
  return options;
}

// The reference implementation of the corrected formulas reached these levels: KL 0.128 and 0.104,
// horizons 0.053 and 0.046 (on ten different maps).
TEST(Experiment, TheDefaultComesNearerToTheTruthThanTheReference) {
  const SpmExperimentOptions options = two_maps();
  const SpmExperiment result = run_spm_experiment(options, {SpmMethod{}}, false, 2);
  const SpmMethodScore& score = result.methods.front();
  EXPECT_EQ(score.improved, 2);
  EXPECT_EQ(score.locked, 0);
  for (const auto& kl : score.kl) {
    EXPECT_LT(kl.back(), 0.104);
    EXPECT_LT(kl.back(), 0.2 * kl.front());
  }
  EXPECT_LT(quantile(result.horizons.front().errors.mean_abs, 0.5), 0.046);
  EXPECT_NEAR(result.pixels_per_frame, 822.0, 10.0);
}

TEST(Experiment, TheResultDoesNotDependOnTheNumberOfThreads) {
  SpmExperimentOptions options = two_maps();
  options.score_until_m = 100.0;
  options.horizon_to_m = 140.0;
  const SpmExperiment one = run_spm_experiment(options, {SpmMethod{}}, true, 1);
  const SpmExperiment two = run_spm_experiment(options, {SpmMethod{}}, true, 2);
  EXPECT_EQ(one.methods.front().kl, two.methods.front().kl);
  ASSERT_EQ(one.horizons.size(), two.horizons.size());
  for (std::size_t i = 0; i < one.horizons.size(); ++i)
    EXPECT_EQ(one.horizons[i].errors.mean_abs, two.horizons[i].errors.mean_abs);
}

TEST(Experiment, TheTruthHasTheSharesThatItsParametersSay) {
  const SpmExperimentOptions options;
  const SpmTruth truth = spm_truth(options, 3);
  EXPECT_EQ(truth.knot_class.size(), 41860U);
  double gravel = 0.0, wet = 0.0, asphalt = 0.0;
  for (const int c : truth.knot_class) ++(c == 0 ? gravel : c == 1 ? asphalt : wet);
  // Six of thirteen columns lie beyond 3.3 m, the border wanders by 0.8 m; a standard normal is
  // above 1 in 15.9 % (a GP of 12 m on 3.2 km: +- 3 %).
  EXPECT_NEAR(gravel / 41860.0, 6.0 / 13.0, 0.06);
  EXPECT_NEAR(wet / (wet + asphalt), 0.159, 0.04);
}

TEST(Experiment, TheDocumentedFileHoldsTheDefaults) {
  const std::filesystem::path root = test::source_tree();
  const auto read = SpmExperimentOptions::load(root / "docs" / "spm_experiment.yaml");
  SpmExperimentOptions quick = read;
  quick.maps = 1;
  quick.score_until_m = 50.0;
  quick.horizon_from_m = quick.horizon_to_m = 40.0;
  SpmExperimentOptions defaults;
  EXPECT_EQ(read.maps, defaults.maps);
  defaults.maps = 1;
  defaults.score_until_m = 50.0;
  defaults.horizon_from_m = defaults.horizon_to_m = 40.0;
  const auto a = run_spm_experiment(quick, {SpmMethod{}}, true, 1);
  const auto b = run_spm_experiment(defaults, {SpmMethod{}}, true, 1);
  EXPECT_EQ(a.methods.front().kl, b.methods.front().kl);
  EXPECT_EQ(a.horizons.back().errors.nll, b.horizons.back().errors.nll);
}

TEST(Experiment, BadParametersAreRefusedByName) {
  SpmExperimentOptions options;
  options.weave_phase_rad.pop_back();
  EXPECT_THROW(options.check(), InvalidOption);
  options = {};
  options.length_m = 300.0;
  EXPECT_THROW(options.check(), InvalidOption);
}

TEST(GaussianProcess, GradientAgreesWithDifferences) {
  Random random(1);
  std::vector<PathPlace> places;
  std::vector<double> values;
  for (int i = 0; i < 40; ++i) {
    places.push_back({random.uniform(0.0, 50.0), random.uniform(-3.0, 3.0)});
    values.push_back(std::sin(0.2 * places.back().s_m) + 0.1 * random.normal());
  }
  const double h = 1e-5;
  const auto at = [&](int k, double step) {
    double logs[4] = {std::log(6.0), std::log(2.0), std::log(0.7), std::log(0.1)};
    if (k >= 0) logs[k] += step;
    return GaussianProcess(
        places, values,
        {std::exp(logs[0]), std::exp(logs[1]), std::exp(logs[2]), std::exp(logs[3])});
  };
  const Eigen::Vector4d gradient = at(-1, 0.0).gradient();
  for (int k = 0; k < 4; ++k) {
    const double difference = (at(k, h).log_likelihood() - at(k, -h).log_likelihood()) / (2.0 * h);
    EXPECT_NEAR(gradient[k], difference, 1e-5 * (1.0 + std::abs(difference)));
  }
  const GaussianProcess best = GaussianProcess::fit(places, values);
  EXPECT_GT(best.log_likelihood(), at(-1, 0.0).log_likelihood());
  EXPECT_LT(best.gradient().norm(), 0.5);
  EXPECT_NEAR(best.kernel().noise, 0.1, 0.05);
}

TEST(KalmanConstant, WithoutAWalkIsTheMean) {
  const KalmanEstimate x = kalman_constant({0.5, 0.7, 0.9, 0.7}, 0.1, 0.0);
  EXPECT_NEAR(x.mean, 0.7, 1e-7);
  EXPECT_NEAR(x.variance, 0.01 / 4.0, 1e-9);
}

}  // namespace
}  // namespace roadbook
