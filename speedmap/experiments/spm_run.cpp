#include "speedmap/experiments/spm_run.hpp"

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "roadnet/paths/path_sign.hpp"

namespace roadbook {
namespace {

double or_else(double value, double other) { return value > 0.0 ? value : other; }

// The truth's moments at its knots, once per map and not at every score.
std::vector<PropertyMoments> knot_truth(const SpmTruth& truth) {
  std::vector<PropertyMoments> moments;
  for (const PathPlace& place : truth.map.knots().places())
    moments.push_back(*truth.map.moments(0, place));
  return moments;
}

double mean_kl(const std::vector<PathPlace>& places,
               const std::vector<PropertyMoments>& truth,
               const PropertyMap& map,
               double until_m) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t l = 0; l < truth.size(); ++l) {
    if (places[l].s_m > until_m) continue;
    sum += normal_kl(truth[l], *map.moments(0, places[l]));
    ++count;
  }
  return sum / count;
}

void score_horizons(const SpmExperimentOptions& options,
                    const SpmTruth& truth,
                    const PropertyMap& map,
                    double s0_m,
                    SpmMapRun& run) {
  const auto probe = spm_horizon(probe_horizon(options), s0_m);
  run.probe.add(moments_along(truth.map, probe), moments_along(map, probe));
  const auto drivable = spm_horizon(drivable_horizon(options), s0_m);
  run.drivable.add(moments_along(truth.map, drivable), moments_along(map, drivable));
}

double worst_class_error(const SpmTruth& truth, const PropertyMap& map) {
  double worst = 0.0;
  for (std::size_t i = 0; i < map.classes(); ++i)
    worst = std::max(worst, std::abs(map.property(0)[i].mu - truth.map.property(0)[i].mu));
  return worst;
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

void SpmErrors::add(const std::vector<PropertyMoments>& truth,
                    const std::vector<PropertyMoments>& got) {
  double absolute = 0.0;
  double square = 0.0;
  double density = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double offset = got[i].mean - truth[i].mean;
    absolute += std::abs(offset);
    square += offset * offset;
    // Expectation of -log N(y; got) over a y with the truth's moments.
    density += 0.5 * (std::log(2.0 * std::numbers::pi * got[i].variance) +
                      (truth[i].variance + offset * offset) / got[i].variance);
  }
  const double n = static_cast<double>(truth.size());
  mean_abs.push_back(absolute / n);
  rms.push_back(std::sqrt(square / n));
  nll.push_back(density / n);
}

SpmHorizonShape probe_horizon(const SpmExperimentOptions& options) {
  return {options.horizon_amplitude_m, options.horizon_wavelength_m, options.horizon_points};
}

SpmHorizonShape drivable_horizon(const SpmExperimentOptions& options) {
  return {options.horizon_amplitude_m, options.drivable_wavelength_m, options.horizon_points};
}

std::vector<PathPlace> spm_horizon(const SpmHorizonShape& shape, double s0_m) {
  std::vector<PathPlace> places;
  for (int n = 1; n <= shape.points; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / shape.wavelength_m;
    places.push_back({s0_m + n, from_paper_sign(shape.amplitude_m * std::cos(angle))});
  }
  return places;
}

std::vector<PropertyMoments> moments_along(const PropertyMap& map,
                                           const std::vector<PathPlace>& places) {
  std::vector<PropertyMoments> moments;
  for (const PathPlace& v : places) {
    const auto at = map.moments(0, v);
    ROADBOOK_ASSERT(at);
    moments.push_back(*at);
  }
  return moments;
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
      PropertyMap(spm_knots(options, or_else(method.knot_spacing_m, options.spacing_m),
                            or_else(method.kernel_width_m, options.kernel_width_m)),
                  spm_prior(options, truth, index), method.map),
      method.refresh);
  SpmMapRun run;
  run.kl_all_start = mean_kl(truth.map.knots().places(), want, mapper.map(), 1e300);
  Player player{record, method, mapper, run};
  const std::vector<double> starts = spm_horizon_starts(options);
  std::size_t horizon = 0;
  for (int i = 0; i * options.score_every_m <= options.score_until_m; ++i) {
    const double distance = i * options.score_every_m;
    for (; horizon < starts.size() && starts[horizon] <= distance; ++horizon) {
      player.play_until(starts[horizon]);
      score_horizons(options, truth, mapper.map(), starts[horizon], run);
    }
    // Nothing has been seen at distance 0: the prior's score.
    if (distance > 0.0) player.play_until(distance);
    run.distance_m.push_back(distance);
    run.kl.push_back(
        mean_kl(truth.map.knots().places(), want, mapper.map(), options.score_until_m));
  }
  run.kl_all_end = mean_kl(truth.map.knots().places(), want, mapper.map(), 1e300);
  run.worst_class_error = worst_class_error(truth, mapper.map());
  run.locked = run.worst_class_error > 0.1;
  return run;
}

void play(const SpmRecord& record,
          const SpmMethod& method,
          double until_m,
          PropertyMapper& mapper) {
  SpmMapRun run;
  Player{record, method, mapper, run}.play_until(until_m);
}

}  // namespace roadbook
