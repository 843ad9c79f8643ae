#include "apps/evaluation/occupancy/beam_fit_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr double kStudyMax_m = 20.0;
constexpr double kStudySigma_m = 0.05;
constexpr int kStudyBeams = 10000;

RangeMixture fit_drawn_beams(std::uint64_t seed, std::uint64_t draw, const BeamMixture& truth) {
  Random random(seed, "beam fit", draw);
  RangeModel model;
  model.max_m = kStudyMax_m;
  model.sigma_m = kStudySigma_m;
  std::vector<BeamSample> samples;
  for (int i = 0; i < kStudyBeams; ++i) {
    BeamSample s{0.1 * (i / 40), 0.0, random.uniform(2.0, 15.0)};
    const double part = random.uniform(), within = random.uniform();
    s.read_m = predict_range(model, truth, s.expected_m, part, within, random.normal());
    samples.push_back(s);
  }
  RangeFitOptions options;
  options.parts = {true, true, true, false};
  options.wide = false;
  options.to_the_maximum = true;
  return fit_range_mixture(samples, kStudyMax_m, options);
}

}  // namespace

BeamFitStudy study_beam_fit(std::uint64_t seed, int draws, int num_threads) {
  constexpr int kFits = 10;
  BeamFitStudy study;
  study.truth = {0.10, 0.05, 0.05, 0.5};
  study.sigma_m = kStudySigma_m;
  study.draws = draws;
  std::vector<RangeMixture> fits(static_cast<std::size_t>(std::max(draws, kFits)));
  parallel_for(fits.size(), num_threads,
               [&](std::size_t i) { fits[i] = fit_drawn_beams(seed, i, study.truth); });
  const std::array<double, 3> shares{study.truth.shortened, study.truth.maximum,
                                     study.truth.crosstalk};
  for (std::size_t i = 0; i < kFits; ++i) {
    for (std::size_t k = 0; k < shares.size(); ++k)
      study.worst_share = std::max(study.worst_share, std::abs(fits[i].share[k] - shares[k]));
    study.worst_share = std::max(study.worst_share, std::abs(fits[i].hit() - study.truth.hit()));
    study.worst_sigma =
        std::max(study.worst_sigma, std::abs(fits[i].sigma_m / kStudySigma_m - 1.0));
  }
  const auto held = [&](const auto& value, const auto& sigma, double truth) {
    int count = 0;
    for (int i = 0; i < draws; ++i) {
      const RangeMixture& m = fits[static_cast<std::size_t>(i)];
      count += std::abs(value(m) - truth) < 1.96 * sigma(m) ? 1 : 0;
    }
    return static_cast<double>(count) / std::max(draws, 1);
  };
  const auto held_share = [&](std::size_t k) {
    return held([k](const RangeMixture& m) { return m.share[k]; },
                [k](const RangeMixture& m) { return m.sigma[k]; }, shares[k]);
  };
  study.held_short = held_share(kShort);
  study.held_maximum = held_share(kMaximum);
  study.held_crosstalk = held_share(kCrosstalk);
  study.held_hit = held([](const RangeMixture& m) { return m.hit(); },
                        [](const RangeMixture& m) { return m.sigma_hit; }, study.truth.hit());
  study.held_sigma = held([](const RangeMixture& m) { return m.sigma_m; },
                          [](const RangeMixture& m) { return m.sigma_sigma_m; }, kStudySigma_m);
  study.held_rate =
      held([](const RangeMixture& m) { return m.short_rate_per_m; },
           [](const RangeMixture& m) { return m.sigma_rate; }, study.truth.short_rate_per_m);
  return study;
}

}  // namespace roadbook
