#include "speedmap/spm_run.hpp"

#include <cmath>
#include <numbers>

#include "roadnet/path_sign.hpp"

namespace roadbook {
namespace {

// The truth's moments at its knots, once per map and not at every score.
std::vector<PropertyMoments> knot_truth(const SpmTruth& truth) {
  std::vector<PropertyMoments> moments;
  for (const PathPlace& place : truth.map.knots().places())
    moments.push_back(*truth.map.moments(0, place));
  return moments;
}

double mean_kl(const std::vector<PropertyMoments>& truth, const PropertyMap& map, double until_m) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t l = 0; l < truth.size(); ++l) {
    if (map.knots().places()[l].s_m > until_m) continue;
    sum += normal_kl(truth[l], *map.moments(0, map.knots().places()[l]));
    ++count;
  }
  return sum / count;
}

void score_horizon(const SpmExperimentOptions& options,
                   const SpmTruth& truth,
                   const PropertyMap& map,
                   double s0_m,
                   SpmMapRun& run) {
  double error = 0.0;
  double nll = 0.0;
  const auto places = spm_horizon(options, s0_m);
  for (const PathPlace& v : places) {
    const PropertyMoments want = *truth.map.moments(0, v);
    const PropertyMoments got = *map.moments(0, v);
    error += std::abs(got.mean - want.mean);
    // Expected -log N(y; got) over y of the truth's moments.
    const double offset = got.mean - want.mean;
    nll += 0.5 * (std::log(2.0 * std::numbers::pi * got.variance) +
                  (want.variance + offset * offset) / got.variance);
  }
  run.horizon_error.push_back(error / static_cast<double>(places.size()));
  run.horizon_nll.push_back(nll / static_cast<double>(places.size()));
}

bool locked_in(const SpmTruth& truth, const PropertyMap& map) {
  for (std::size_t i = 0; i < map.classes(); ++i)
    if (std::abs(map.property(0)[i].mu - truth.map.property(0)[i].mu) > 0.1) return true;
  return false;
}

// Everything the vehicle sees and feels at one instant, in the order of time.
struct Player {
  const SpmRecord& record;
  const SpmMethod& method;
  PropertyMapper& mapper;
  SpmMapRun& run;
  std::size_t frame = 0;
  std::size_t value = 0;

  void play_until(double distance_m) {
    while (true) {
      const bool more_frames = frame < record.frames.size();
      const bool more_values = value < record.values.size();
      const double next_frame = more_frames ? record.frames[frame].distance_m : 1e300;
      const double next_value = more_values ? record.values[value].distance_m : 1e300;
      const double next = std::min(next_frame, next_value);
      if (next > distance_m) return;
      if (next_frame <= next_value) {
        const SpmFrame& seen = record.frames[frame++];
        for (std::size_t i = 0; i < seen.places.size(); ++i)
          mapper.map().add_label(seen.places[i], seen.labels[i], method.label_weight);
      } else {
        const SpmValue& felt = record.values[value++];
        if (mapper.add_value(0, felt.place, felt.friction).status == PropertyUpdate::kRejected)
          ++run.rejected;
      }
      if (next > 0.0 && mapper.travelled(next)) ++run.refreshes;
    }
  }
};

}  // namespace

double normal_kl(const PropertyMoments& truth, const PropertyMoments& estimate) {
  const double offset = truth.mean - estimate.mean;
  const double ratio = truth.variance / estimate.variance;
  return 0.5 * (ratio - 1.0 - std::log(ratio) + offset * offset / estimate.variance);
}

std::vector<PathPlace> spm_horizon(const SpmExperimentOptions& options, double s0_m) {
  std::vector<PathPlace> places;
  for (int n = 1; n <= options.horizon_points; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / options.horizon_wavelength_m;
    places.push_back({s0_m + n, from_document_sign(options.horizon_amplitude_m * std::cos(angle))});
  }
  return places;
}

std::vector<double> spm_horizon_starts(const SpmExperimentOptions& options) {
  std::vector<double> starts;
  for (int i = 0;; ++i) {
    const double s0 = options.horizon_from_m + i * options.horizon_every_m;
    if (s0 > options.horizon_to_m) return starts;
    starts.push_back(s0);
  }
}

SpmMapRun run_spm(const SpmExperimentOptions& options,
                  const SpmTruth& truth,
                  const SpmRecord& record,
                  const SpmMethod& method,
                  std::uint64_t index) {
  const std::vector<PropertyMoments> want = knot_truth(truth);
  PropertyMapper mapper(
      PropertyMap(truth.map.knots(), spm_prior(options, truth, index, method.calibrated_prior),
                  method.map),
      method.refresh);
  SpmMapRun run;
  run.kl_all_start = mean_kl(want, mapper.map(), 1e300);
  Player player{record, method, mapper, run};
  const std::vector<double> starts = spm_horizon_starts(options);
  std::size_t horizon = 0;
  for (int i = 0; i * options.score_every_m <= options.score_until_m; ++i) {
    const double distance = i * options.score_every_m;
    for (; horizon < starts.size() && starts[horizon] <= distance; ++horizon) {
      player.play_until(starts[horizon]);
      score_horizon(options, truth, mapper.map(), starts[horizon], run);
    }
    // Nothing has been seen at distance 0: the prior's score.
    if (distance > 0.0) player.play_until(distance);
    run.distance_m.push_back(distance);
    run.kl.push_back(mean_kl(want, mapper.map(), options.score_until_m));
  }
  run.kl_all_end = mean_kl(want, mapper.map(), 1e300);
  run.locked = locked_in(truth, mapper.map());
  return run;
}

std::vector<SpmMethod> spm_methods(const SpmExperimentOptions&) {
  std::vector<SpmMethod> methods;
  SpmMethod literal;
  literal.name = "literal prior, printed (13)";
  literal.calibrated_prior = false;
  literal.map.semantics = SemanticModel::kGeometricPool;
  literal.map.normal_gamma = NormalGammaProjection::kPrinted;
  literal.map.dirichlet = DirichletProjection::kPrinted;
  literal.map.outlier_weight = 0.0;
  literal.map.gate_counts = 0.0;
  literal.refresh.enabled = false;
  methods.push_back(literal);

  SpmMethod predictive = literal;
  predictive.name = "literal prior, predictive + trace";
  predictive.map.normal_gamma = NormalGammaProjection::kPredictive;
  predictive.map.dirichlet = DirichletProjection::kTrace;
  methods.push_back(predictive);

  SpmMethod calibrated = literal;
  calibrated.name = "calibrated prior and gate, printed (13)";
  calibrated.calibrated_prior = true;
  calibrated.map.gate_counts = 5.0;
  methods.push_back(calibrated);

  calibrated = predictive;
  calibrated.name = "calibrated prior and gate, predictive + trace";
  calibrated.calibrated_prior = true;
  calibrated.map.gate_counts = 5.0;
  methods.push_back(calibrated);

  calibrated.name = "+ batch refresh";
  calibrated.refresh.enabled = true;
  calibrated.refresh.drop_nat = 0.0;
  methods.push_back(calibrated);

  calibrated.name = "+ linear pool";
  calibrated.map.semantics = SemanticModel::kLinearPool;
  methods.push_back(calibrated);
  return methods;
}

}  // namespace roadbook
