#include "speedmap/experiments/spm_experiment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <string>

#include "base/parallel.hpp"
#include "speedmap/property_map/gaussian_process.hpp"

namespace roadbook {
namespace {

// Everything that one map gives, kept apart so that maps may run in any order.
struct MapResult {
  std::vector<SpmMapRun> runs;             ///< per method
  std::vector<SpmErrors> probe, drivable;  ///< per baseline
  double pixels_per_frame = 0.0;
};

struct History {
  std::vector<PathPlace> places;
  std::vector<double> values;
};

History values_before(const SpmRecord& record, double s0_m, double history_m) {
  History history;
  for (const SpmValue& value : record.values)
    if (value.distance_m > s0_m - history_m && value.distance_m < s0_m) {
      history.places.push_back(value.place);
      history.values.push_back(value.friction);
    }
  return history;
}

std::size_t baseline_count() { return spm_kalman_walks().size() + 1; }

std::string baseline_name(std::size_t i) {
  if (i == spm_kalman_walks().size()) return "GP";
  std::string walk = std::to_string(spm_kalman_walks()[i]);
  walk.erase(walk.find_last_not_of('0') + 1);
  return "KF, random walk " + walk;
}

void run_baselines(const SpmExperimentOptions& options,
                   const SpmTruth& truth,
                   const SpmRecord& record,
                   MapResult& result) {
  result.probe.resize(baseline_count());
  result.drivable.resize(baseline_count());
  for (const double s0 : spm_horizon_starts(options)) {
    const History history = values_before(record, s0, options.history_m);
    const GaussianProcess gp = GaussianProcess::fit(history.places, history.values);
    for (const bool probe : {true, false}) {
      const auto places =
          spm_horizon(probe ? probe_horizon(options) : drivable_horizon(options), s0);
      const auto want = moments_along(truth.map, places);
      auto& errors = probe ? result.probe : result.drivable;
      for (std::size_t i = 0; i + 1 < baseline_count(); ++i) {
        const KalmanEstimate kf =
            kalman_constant(history.values, options.kalman_sigma, spm_kalman_walks()[i]);
        std::vector<PropertyMoments> got;
        for (std::size_t n = 0; n < places.size(); ++n) {
          // The random walk continues over the horizon, at the rate of the measurements.
          const double steps = static_cast<double>(n + 1) * options.friction_hz / options.speed_mps;
          const double walk = spm_kalman_walks()[i];
          got.push_back({kf.mean, kf.variance + steps * walk * walk +
                                      options.kalman_sigma * options.kalman_sigma});
        }
        errors[i].add(want, got);
      }
      std::vector<PropertyMoments> got;
      for (const PathPlace& v : places) {
        const GaussianProcess::Prediction at = gp.predict(v);
        got.push_back({at.mean, at.variance});
      }
      errors.back().add(want, got);
    }
  }
}

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void append(SpmErrors& to, const SpmErrors& from) {
  append(to.mean_abs, from.mean_abs);
  append(to.rms, from.rms);
  append(to.nll, from.nll);
}

SpmMethodScore score_of(const std::string& name,
                        std::size_t method,
                        const std::vector<MapResult>& maps) {
  SpmMethodScore score;
  score.method = name;
  for (const MapResult& map : maps) {
    const SpmMapRun& run = map.runs[method];
    score.distance_m = run.distance_m;
    score.kl.push_back(run.kl);
    score.kl_all_start.push_back(run.kl_all_start);
    score.kl_all_end.push_back(run.kl_all_end);
    score.locked += run.locked ? 1 : 0;
    score.improved += run.kl.back() < run.kl.front() ? 1 : 0;
    score.rejected += run.rejected;
  }
  return score;
}

}  // namespace

const std::vector<double>& spm_kalman_walks() {
  static const std::vector<double> walks = {0.001, 0.003, 0.01, 0.03, 0.1};
  return walks;
}

SpmExperiment run_spm_experiment(const SpmExperimentOptions& options,
                                 const std::vector<SpmMethod>& methods,
                                 bool baselines,
                                 int num_threads,
                                 const Progress& progress) {
  options.check();
  const PathFrame road = spm_road(options);
  std::vector<MapResult> maps(static_cast<std::size_t>(options.maps));
  std::mutex reporting;
  std::size_t done = 0;
  parallel_for(maps.size(), num_threads, [&](std::size_t index) {
    const SpmTruth truth = spm_truth(options, index);
    const SpmRecord record = spm_record(options, road, truth, index, options.score_until_m);
    MapResult& map = maps[index];
    for (const SpmFrame& frame : record.frames)
      map.pixels_per_frame += static_cast<double>(frame.places.size());
    map.pixels_per_frame /= static_cast<double>(record.frames.size());
    for (const SpmMethod& method : methods)
      map.runs.push_back(run_spm(options, truth, record, method, index));
    if (baselines) run_baselines(options, truth, record, map);
    const std::scoped_lock lock(reporting);
    report(progress, "maps", ++done, maps.size());
  });

  SpmExperiment result;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    result.methods.push_back(score_of(methods[i].name, i, maps));
    result.horizons.push_back({methods[i].name, {}});
    result.drivable.push_back({methods[i].name, {}});
    for (const MapResult& map : maps) {
      append(result.horizons.back().errors, map.runs[i].probe);
      append(result.drivable.back().errors, map.runs[i].drivable);
    }
  }
  for (std::size_t i = 0; baselines && i < baseline_count(); ++i) {
    result.horizons.push_back({baseline_name(i), {}});
    result.drivable.push_back({baseline_name(i), {}});
    for (const MapResult& map : maps) {
      append(result.horizons.back().errors, map.probe[i]);
      append(result.drivable.back().errors, map.drivable[i]);
    }
  }
  result.horizons_per_map = static_cast<int>(spm_horizon_starts(options).size());
  for (const MapResult& map : maps)
    result.pixels_per_frame += map.pixels_per_frame / static_cast<double>(maps.size());
  return result;
}

int maps_below_half(const std::vector<SpmHorizonScore>& horizons,
                    std::size_t method,
                    std::size_t first_baseline,
                    int horizons_per_map) {
  const auto median = [&](std::size_t which, std::ptrdiff_t map) {
    const auto begin = horizons[which].errors.rms.begin() + map * horizons_per_map;
    return quantile({begin, begin + horizons_per_map}, 0.5);
  };
  const auto maps =
      static_cast<std::ptrdiff_t>(horizons[method].errors.rms.size()) / horizons_per_map;
  int below = 0;
  for (std::ptrdiff_t map = 0; map < maps; ++map) {
    bool all = true;
    for (std::size_t i = first_baseline; i < horizons.size(); ++i)
      all &= median(method, map) < 0.5 * median(i, map);
    below += all ? 1 : 0;
  }
  return below;
}

MeanInterval mean_interval95(const std::vector<double>& values) {
  // 97.5 % points of Student's t for 1 to 30 degrees of freedom; beyond, the normal's.
  constexpr std::array<double, 30> t = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                                        2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
                                        2.110,  2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064,
                                        2.060,  2.056, 2.052, 2.048, 2.045, 2.042};
  MeanInterval result;
  if (values.empty()) return result;
  const double n = static_cast<double>(values.size());
  for (const double value : values) result.mean += value / n;
  if (values.size() < 2) return result;
  double square = 0.0;
  for (const double value : values) square += (value - result.mean) * (value - result.mean);
  const std::size_t degrees = values.size() - 1;
  result.half = (degrees <= t.size() ? t[degrees - 1] : 1.96) * std::sqrt(square / (n - 1.0) / n);
  return result;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace roadbook
