#include "semantics/detector/search_prior.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/random.hpp"
#include "semantics/detector/gp_laplace.hpp"

namespace roadbook {

namespace {

constexpr double kSurestLogit = 6.0;  // larger logits (1 in 400) count as this one

void add_later_half(const std::vector<SearchAnswer>& answers, std::vector<SearchAnswer>& to) {
  constexpr std::size_t kFewest = 100;
  const std::size_t count = answers.size();
  const std::size_t first = std::min(count / 2, count - std::min(count, kFewest));
  for (std::size_t a = first; a < count; ++a)
    to.push_back({std::clamp(answers[a].logit, -kSurestLogit, kSurestLogit), answers[a].positive});
}

// Precision of the prior of the shift. Only answers of both classes determine how often a search is
// right. Rounds without pedestrians say nothing about rounds with pedestrians.
double precision_of_prior(double rarer) {
  constexpr double kEnough = 10.0;  // known to about a third: the prior's deviation of 2 is wide
  return 0.25 * std::max(1.0, kEnough / rarer);
}

// Newton's iterations for a concave function: a sum of logistic log likelihoods and a parabola.
double likeliest_shift(const std::vector<SearchAnswer>& answers) {
  const auto positives = std::count_if(answers.begin(), answers.end(),
                                       [](const SearchAnswer& answer) { return answer.positive; });
  const auto rarer = std::min<std::ptrdiff_t>(positives, std::ssize(answers) - positives);
  if (rarer == 0) return 0.0;
  const double precision = precision_of_prior(static_cast<double>(rarer));
  double shift = 0.0;
  for (int i = 0; i < 100; ++i) {
    double slope = -precision * shift;
    double curvature = precision;
    for (const SearchAnswer& answer : answers) {
      const double p = logistic(answer.logit + shift);
      slope += (answer.positive ? 1.0 : 0.0) - p;
      curvature += p * (1.0 - p);
    }
    // One step is at most the prior's standard deviation, because the logistic function is flat far
    // from zero.
    const double step = std::clamp(slope / curvature, -2.0, 2.0);
    shift += step;
    if (std::abs(step) < 1e-10) break;
  }
  return shift;
}

}  // namespace

double prior_shift(const std::vector<SearchAnswer>& answers) {
  return prior_shift_of(std::span(&answers, 1));
}

double prior_shift_of(std::span<const std::vector<SearchAnswer>> sources) {
  std::vector<SearchAnswer> recent;
  for (const auto& answers : sources) add_later_half(answers, recent);
  return likeliest_shift(recent);
}

double calibration_error(const std::vector<std::pair<double, bool>>& said) {
  constexpr int kBins = 10;
  std::array<double, kBins> off{};
  for (const auto& [probability, so] : said) {
    const auto bin =
        static_cast<std::size_t>(std::min(kBins - 1, static_cast<int>(kBins * probability)));
    off[bin] += probability - (so ? 1.0 : 0.0);
  }
  double sum = 0.0;
  for (const double o : off) sum += std::abs(o);
  return said.empty() ? 0.0 : sum / static_cast<double>(said.size());
}

ChanceOfCalibration chance_of_calibration(const std::vector<std::pair<double, bool>>& said,
                                          std::uint64_t seed) {
  constexpr std::size_t kDraws = 1000;
  Random random(seed);
  std::vector<std::pair<double, bool>> drawn = said;
  std::vector<double> errors;
  for (std::size_t d = 0; d < kDraws; ++d) {
    for (auto& [probability, so] : drawn) so = random.uniform() < probability;
    errors.push_back(calibration_error(drawn));
  }
  std::sort(errors.begin(), errors.end());
  return {std::accumulate(errors.begin(), errors.end(), 0.0) / kDraws,
          errors[kDraws * 95 / 100 - 1]};
}

}  // namespace roadbook
