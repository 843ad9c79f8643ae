#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "speedmap/experiments/spm_studies.hpp"

namespace roadbook {
namespace {

constexpr double kUntil = 300.0;  ///< [m] driven
constexpr std::array<double, 9> kConfusion = {0.85, 0.12, 0.03, 0.03, 0.90, 0.07, 0.02, 0.25, 0.73};

struct LabelMethod {
  const char* name;
  SemanticModel semantics;
  bool confusion;
  double weight;
};
constexpr std::array<LabelMethod, 8> kMethods = {{
    {"(9)", SemanticModel::kGeometricPool, false, 1.0},
    {"(9), label worth 0.4", SemanticModel::kGeometricPool, false, 0.4},
    {"linear pool", SemanticModel::kLinearPool, false, 1.0},
    {"linear pool, confusion", SemanticModel::kLinearPool, true, 1.0},
    {"linear pool, label worth 0.4", SemanticModel::kLinearPool, false, 0.4},
    {"discrete", SemanticModel::kDiscrete, true, 1.0},
    {"discrete, label worth 0.1", SemanticModel::kDiscrete, true, 0.1},
    {"discrete, label worth 0.03", SemanticModel::kDiscrete, true, 0.03},
}};

int drawn_label(int true_class, double uniform) {
  for (int c = 0; c < 2; ++c)
    if ((uniform -= kConfusion[static_cast<std::size_t>(3 * true_class + c)]) < 0.0) return c;
  return 2;
}

// Labels of a drive over the truth's knots: those of the nearest knot, confused.
SpmRecord confused(const SpmRecord& seen,
                   const SpmTruth& truth,
                   bool blobs,
                   std::uint64_t seed,
                   std::uint64_t drive) {
  SpmRecord record = seen;
  Random independent(seed, "spm.label_noise", drive);
  Interpolation near;
  for (SpmFrame& frame : record.frames)
    for (std::size_t i = 0; i < frame.places.size(); ++i) {
      const PathPlace& v = frame.places[i];
      interpolate(truth.map.knots(), v, near);
      const auto best = std::max_element(near.weights.begin(), near.weights.end());
      const auto knot = static_cast<std::size_t>(
          near.knots[static_cast<std::size_t>(best - near.weights.begin())]);
      double uniform = independent.uniform();
      if (blobs) {
        const auto cell = [](double x, double size) {
          return static_cast<std::uint64_t>(std::floor(x / size) + 4096.0);
        };
        const std::uint64_t blob =
            (cell(v.s_m, 3.0) << 40U) | (cell(v.e_m, 1.0) << 20U) | cell(frame.distance_m, 10.0);
        uniform = Random(seed + drive, "spm.blob", blob).uniform();
      }
      frame.labels[i] = drawn_label(truth.knot_class[knot], uniform);
    }
  return record;
}

PropertyMap labelled(const SpmTruth& truth, const SpmRecord& record, const LabelMethod& method) {
  PropertyMapPrior prior = truth.map.prior();
  prior.counts = {1.0, 5.0, 1.0};
  PropertyMapOptions options;
  options.semantics = method.semantics;
  options.prior_mean_sigma = 0.0;  // frictions are known
  if (method.confusion) options.confusion.assign(kConfusion.begin(), kConfusion.end());
  PropertyMap map(truth.map.knots(), prior, options);
  for (const SpmFrame& frame : record.frames)
    for (std::size_t i = 0; i < frame.places.size(); ++i)
      map.add_label(frame.places[i], frame.labels[i], method.weight);
  return map;
}

// Knots that have been seen from near and far.
bool judged(const PathPlace& place) { return place.s_m > 10.0 && place.s_m < kUntil - 10.0; }

void score_classes(const SpmTruth& truth, const PropertyMap& map, SpmLabelScore& score) {
  std::array<double, 10> count{}, confidence{}, right{};
  std::array<double, 3> u{};
  double n = 0.0;
  Interpolation near;
  for (std::size_t l = 0; l < truth.knot_class.size(); ++l) {
    const PathPlace& place = map.knots().places()[l];
    if (!judged(place)) continue;
    map.knot_shares(l, u);
    const auto best = static_cast<std::size_t>(std::max_element(u.begin(), u.end()) - u.begin());
    const auto bin = std::min<std::size_t>(9, static_cast<std::size_t>(10.0 * u[best]));
    const auto is = static_cast<std::size_t>(truth.knot_class[l]);
    count[bin] += 1.0;
    confidence[bin] += u[best];
    right[bin] += best == is ? 1.0 : 0.0;
    score.class_nll -= std::log(std::max(u[is], 1e-12));
    double friction = 0.0;
    interpolate(map.knots(), place, near);
    for (std::size_t k = 0; k < near.size(); ++k)
      friction += near.weights[k] *
                  map.property(0)[static_cast<std::size_t>(
                                      truth.knot_class[static_cast<std::size_t>(near.knots[k])])]
                      .mu;
    score.mean_error += std::abs(map.moments(0, place)->mean - friction);
    n += 1.0;
  }
  score.class_nll /= n;
  score.mean_error /= n;
  for (std::size_t bin = 0; bin < 10; ++bin)
    score.class_ece += std::abs(confidence[bin] - right[bin]) / n;
}

// The z-test between two drives with independent errors.
void score_counts(const PropertyMap& a, const PropertyMap& b, SpmLabelScore& score) {
  double square = 0.0;
  double outside = 0.0;
  double n = 0.0;
  for (std::size_t l = 0; l < a.knots().size(); ++l) {
    if (!judged(a.knots().places()[l])) continue;
    std::array<double, 2> u{}, variance{};
    for (const std::size_t k : {0U, 1U}) {
      const auto counts = (k == 0 ? a : b).belief(l);
      const double A = counts[0] + counts[1] + counts[2];
      u[k] = counts[1] / A;
      variance[k] = u[k] * (1.0 - u[k]) / (A + 1.0);
    }
    const double z = (u[0] - u[1]) / std::sqrt(variance[0] + variance[1]);
    square += z * z;
    outside += std::abs(z) > 1.96 ? 1.0 : 0.0;
    n += 1.0;
  }
  score.z_sd = std::sqrt(square / n);
  score.z_outside95 = outside / n;
}

}  // namespace

std::vector<SpmLabelScore> spm_label_study(const SpmExperimentOptions& options,
                                           int maps,
                                           int num_threads) {
  const PathFrame road = spm_road(options);
  std::vector<std::vector<SpmLabelScore>> of_map(static_cast<std::size_t>(maps));
  parallel_for(of_map.size(), num_threads, [&](std::size_t index) {
    const SpmTruth truth = spm_truth(options, index);
    const SpmRecord seen = spm_record(options, road, truth, index, kUntil);
    for (const bool blobs : {false, true}) {
      const SpmRecord first = confused(seen, truth, blobs, options.seed, 2 * index);
      const SpmRecord second = confused(seen, truth, blobs, options.seed, 2 * index + 1);
      for (const LabelMethod& method : kMethods) {
        SpmLabelScore score{method.name, blobs, 0.0, 0.0, 0.0, 0.0, 0.0};
        const PropertyMap map = labelled(truth, first, method);
        score_classes(truth, map, score);
        if (method.semantics != SemanticModel::kDiscrete)
          score_counts(map, labelled(truth, second, method), score);
        of_map[index].push_back(score);
      }
    }
  });
  std::vector<SpmLabelScore> scores = of_map.front();
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto mean = [&](double SpmLabelScore::*field) {
      double sum = 0.0;
      for (const auto& one : of_map) sum += one[i].*field / maps;
      return sum;
    };
    scores[i] = {scores[i].method,
                 scores[i].blobs,
                 mean(&SpmLabelScore::class_nll),
                 mean(&SpmLabelScore::class_ece),
                 mean(&SpmLabelScore::mean_error),
                 mean(&SpmLabelScore::z_sd),
                 mean(&SpmLabelScore::z_outside95)};
  }
  return scores;
}

}  // namespace roadbook
