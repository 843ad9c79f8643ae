#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/motion/motion_problem.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

constexpr int kCalibrations = 24;

LibraryOptions named_only() {
  LibraryOptions options;
  options.places = false;
  options.grammar = false;
  return options;
}

// Without a hidden effect every score is standard normal.
TEST(Calibration, ScoresOfDrivesWithoutACauseAreStandardNormal) {
  std::map<std::string, std::pair<double, double>> sums;
  for (int i = 0; i < kCalibrations; ++i) {
    test::HiddenDriveOptions options;
    options.seed = 400 + static_cast<std::uint64_t>(i);
    options.length_m = 150.0;
    const MotionProblem problem(observe(test::streams_of(test::record_drive(options))),
                                EffectSizes{}, named_only());
    const CauseModel model = problem.nominal();
    const ScoreTable table(model, problem.project(model, problem.candidates(model)));
    for (std::size_t c = 0; c < table.candidates().size(); ++c) {
      const Score s = table.score(c);
      const double z = std::copysign(std::sqrt(s.statistic), s.size[0]);
      auto& sum = sums[table.candidates()[c].name];
      sum.first += z;
      sum.second += z * z;
    }
  }
  EXPECT_EQ(sums.size(), motion_effects().size());
  for (const auto& [name, sum] : sums) {
    const double mean = sum.first / kCalibrations;
    const double square = sum.second / kCalibrations;
    // Four standard errors of a mean and of a mean square of 24 standard normals.
    EXPECT_LT(std::abs(mean), 4.0 / std::sqrt(kCalibrations)) << name;
    EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / kCalibrations)) << name;
  }
}

// With one effect in the independent simulation, its column recovers size and sign.
TEST(Calibration, EveryColumnRecoversWhatAnIndependentSimulationHides) {
  for (std::size_t i = 0; i < motion_effects().size(); ++i) {
    const std::string name(motion_effects()[i].name);
    SCOPED_TRACE(name);
    test::HiddenDriveOptions options;
    options.seed = 900 + i;
    for (const auto& range : test::practical_ranges())
      if (range.name == name) options.secret[name] = (i % 2 == 0 ? 1.0 : -1.0) * range.high;
    ASSERT_EQ(options.secret.size(), 1U);
    const MotionProblem problem(observe(test::streams_of(test::record_drive(options))),
                                EffectSizes{}, named_only());
    CauseModel model = problem.nominal();
    for (const Candidate& c : problem.project(model, problem.candidates(model)).candidates)
      if (c.name == name) accept(model, c);
    ASSERT_EQ(model.accepted.size(), 1U);
    problem.fit(model, 5);
    const double sigma = 1.0 / std::sqrt(model.information(0, 0));
    // With 21 effects, a random error exceeds 3.5 standard errors in one of a hundred runs with
    // other seeds.
    EXPECT_NEAR(model.accepted[0].size[0], options.secret[name], 3.5 * sigma);
    EXPECT_LT(3.5 * sigma, 0.7 * std::abs(options.secret[name])) << "the test would not tell";
  }
}

}  // namespace
}  // namespace roadbook
