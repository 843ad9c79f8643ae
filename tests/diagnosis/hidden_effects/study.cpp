#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "tests/diagnosis/hidden_effects/column_study.hpp"
#include "tests/diagnosis/hidden_effects/noise_study.hpp"
#include "tests/diagnosis/hidden_effects/study_cases.hpp"
#include "tests/support/found_causes.hpp"

// hidden_effects_study MODE DRIVES SEED THREADS [NAME]: nulls | lasting | lasting_effects | effects
// | pairs | removed | outside | correlated | columns | idle_columns | noise_pairs | noise_sizes |
// patches; of effects only those whose name holds NAME, of nulls the scatter of the poses [m]
// instead of 0.02. One line an effect, and every drive that went wrong.

namespace roadbook::test {
namespace {

struct Job {
  HiddenDriveOptions hidden;
  std::vector<std::string> without;
};

std::vector<Outcome> run_all(const std::vector<Job>& jobs, int threads) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("roadbook_study_" + std::to_string(::getpid()));
  std::vector<Outcome> outcomes(jobs.size());
  parallel_for(jobs.size(), threads, [&](std::size_t i) {
    const auto drive = folder / std::to_string(i);
    outcomes[i] = run_hidden(jobs[i].hidden, drive, jobs[i].without);
    std::filesystem::remove_all(drive);
  });
  std::filesystem::remove_all(folder);
  return outcomes;
}

Job job_of(const EffectRange& range, std::uint64_t seed, std::uint64_t index) {
  Job job;
  job.hidden.seed = Random(seed, "study " + range.name, index)() >> 1U;
  job.hidden.secret[range.name] = draw_size(range, job.hidden.seed);
  return job;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void study_nulls(std::size_t drives, std::uint64_t seed, int threads, double pose_sigma_m) {
  std::vector<Job> jobs(drives);
  for (std::size_t i = 0; i < drives; ++i) {
    jobs[i].hidden.seed = Random(seed, "study null", i)() >> 1U;
    jobs[i].hidden.pose_sigma_m = pose_sigma_m;
  }
  std::size_t alarms = 0;
  double seconds = 0.0;
  for (const Outcome& o : run_all(jobs, threads)) {
    seconds += o.seconds;
    if (o.found.causes.empty() && o.found.unknown.empty()) continue;
    ++alarms;
    std::printf("  %s\n", o.to_line().c_str());
  }
  std::printf("null: %zu alarms of %zu, %.3f s a drive\n", alarms, drives,
              seconds / static_cast<double>(drives));
}

// Drives without an effect whose poses have errors that last.
void study_lasting(std::size_t drives, std::uint64_t seed, int threads) {
  for (const double time_s : {0.3, 1.0, 3.0, 10.0}) {
    std::vector<Job> jobs(drives);
    for (std::size_t i = 0; i < drives; ++i)
      jobs[i].hidden = drive_with_lasting_errors(time_s, Random(seed, "study lasting", i)() >> 1U);
    std::size_t alarms = 0, named = 0;
    double seconds = 0.0;
    for (const Outcome& o : run_all(jobs, threads)) {
      seconds += o.seconds;
      const bool correlation = o.cause("poses.correlation") != nullptr;
      named += correlation ? 1 : 0;
      if (o.found.unknown.empty() && o.found.causes.size() == (correlation ? 1U : 0U)) continue;
      ++alarms;
      std::printf("  %.3f m, %.4f rad: %s\n", o.hidden.pose_sigma_m, o.hidden.pose_sigma_rad,
                  o.to_line().c_str());
    }
    std::printf(
        "errors that last %.1f s: %zu alarms of %zu, correlation named %zu, %.3f s a drive\n",
        time_s, alarms, drives, named, seconds / static_cast<double>(drives));
    std::fflush(stdout);
  }
}

struct Tally {
  std::size_t drives = 0, first = 0, set = 0, unnamed = 0, wrong = 0, extra = 0;
  std::size_t strong = 0, strong_set = 0, covered = 0, intervals = 0, set_size = 0, sets = 0;
  std::vector<double> ratios, z;
  double seconds = 0.0;
};

void add(const Outcome& o, const std::string& effect, Tally& t) {
  ++t.drives;
  t.seconds += o.seconds;
  const bool named = !o.found.causes.empty() || !o.found.unknown.empty();
  const bool right = o.in_set(effect);
  t.first += o.named_first(effect) ? 1 : 0;
  t.set += right ? 1 : 0;
  t.unnamed += named ? 0 : 1;
  t.wrong += named && !right ? 1 : 0;
  if (o.strength >= 8.0) {
    ++t.strong;
    t.strong_set += right ? 1 : 0;
  }
  const std::size_t count = o.found.causes.size() + o.found.unknown.size();
  if (right && count > 1) t.extra += count - 1;
  if (!o.found.causes.empty()) {
    ++t.sets;
    t.set_size += 1 + o.found.causes.front().inseparable.size();
  }
  const FoundCause* cause = o.cause(effect);
  if (cause != nullptr) {
    const double size = o.hidden.secret.at(effect);
    ++t.intervals;
    t.covered += size >= cause->low && size <= cause->high ? 1 : 0;
    t.z.push_back((cause->size - size) / sigma_of(*cause));
    if (o.strength > 0.0) t.ratios.push_back(cause->gain.total / o.oracle_gain);
  }
  if (!right || count > 1) std::printf("  %s\n", o.to_line().c_str());
}

void print(const std::string& name, const Tally& t) {
  double square = 0.0;
  for (const double z : t.z) square += z * z / static_cast<double>(t.z.size());
  std::printf(
      "%-28s n %zu first %zu set %zu unnamed %zu wrong %zu extra %zu strong %zu/%zu cover %zu/%zu "
      "z %.2f set size %.2f gain/oracle %.3f (3 %%: %.3f) %.3f s\n",
      name.c_str(), t.drives, t.first, t.set, t.unnamed, t.wrong, t.extra, t.strong_set, t.strong,
      t.covered, t.intervals, std::sqrt(square),
      static_cast<double>(t.set_size) / static_cast<double>(std::max<std::size_t>(t.sets, 1)),
      quantile(t.ratios, 0.5), quantile(t.ratios, 0.03),
      t.seconds / static_cast<double>(std::max<std::size_t>(t.drives, 1)));
  std::fflush(stdout);
}

void study_effects(std::size_t drives, std::uint64_t seed, int threads, const std::string& only) {
  Tally all;
  for (const EffectRange& range : practical_ranges()) {
    if (range.name.find(only) == std::string::npos) continue;
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < drives; ++i) jobs.push_back(job_of(range, seed, i));
    Tally tally;
    for (const Outcome& o : run_all(jobs, threads)) {
      add(o, range.name, tally);
      add(o, range.name, all);
    }
    print(range.name, tally);
  }
  print("all", all);
}

// One effect of the mean or of the gyro's noise together with errors of the poses that last
// `time_s`. The correlation of the poses, which is there too, is no additional name.
void study_lasting_effects(std::size_t drives,
                           std::uint64_t seed,
                           int threads,
                           const std::string& only) {
  for (const double time_s : {0.3, 1.0, 3.0, 10.0}) {
    Tally tally;
    std::size_t showable = 0;
    for (const EffectRange& range : practical_ranges()) {
      if (range.name.starts_with("poses.") || range.name.find(only) == std::string::npos) continue;
      std::vector<Job> jobs(drives);
      for (std::size_t i = 0; i < drives; ++i) {
        Job job = job_of(range, seed, i);
        jobs[i].hidden = drive_with_lasting_errors(time_s, job.hidden.seed);
        jobs[i].hidden.secret[range.name] = job.hidden.secret[range.name];
      }
      for (Outcome& o : run_all(jobs, threads)) {
        std::erase_if(o.found.causes,
                      [](const FoundCause& c) { return c.effect == "poses.correlation"; });
        showable += o.strength >= 5.0 || o.strength == 0.0 ? 1 : 0;
        add(o, range.name, tally);
      }
    }
    std::printf("errors that last %.1f s: %zu of five standard errors or noise\n", time_s,
                showable);
    print("all", tally);
  }
}

void study_pairs(std::size_t drives, std::uint64_t seed, int threads) {
  const auto& ranges = practical_ranges();
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < drives; ++i) {
    Random random(seed, "study pair", i);
    const std::size_t a = random.below(ranges.size());
    std::size_t b = random.below(ranges.size() - 1);
    b += b >= a ? 1 : 0;
    Job job = job_of(ranges[a], seed + 1, i);
    job.hidden.secret[ranges[b].name] = draw_size(ranges[b], job.hidden.seed);
    jobs.push_back(job);
  }
  std::size_t both = 0;
  for (const Outcome& o : run_all(jobs, threads)) {
    std::size_t named = 0;
    for (const auto& [name, size] : o.hidden.secret) {
      const bool there =
          std::any_of(o.found.causes.begin(), o.found.causes.end(), [&](const FoundCause& c) {
            return c.effect == name || std::find(c.inseparable.begin(), c.inseparable.end(),
                                                 name) != c.inseparable.end();
          });
      named += there ? 1 : 0;
    }
    both += named == 2 ? 1 : 0;
    if (named < 2 || o.found.causes.size() + o.found.unknown.size() > 2)
      std::printf("  %s\n", o.to_line().c_str());
  }
  std::printf("pairs: both named in %zu of %zu\n", both, drives);
}

// Removes the true cause from the catalogue and counts the other causes that the diagnosis names.
void study_removed(std::size_t drives, std::uint64_t seed, int threads) {
  std::size_t silent = 0, all = 0;
  for (const EffectRange& range : practical_ranges()) {
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < drives; ++i) {
      jobs.push_back(job_of(range, seed, i));
      jobs.back().without = {range.name};
    }
    std::size_t wrong = 0;
    for (const Outcome& o : run_all(jobs, threads)) {
      ++all;
      const bool flagged = !o.found.unknown.empty() || !o.found.unexplained.empty();
      if (!o.found.causes.empty() && !flagged) {
        ++wrong;
        std::printf("  %s\n", o.to_line().c_str());
      }
    }
    silent += wrong;
    std::printf("%-28s silent wrong names %zu of %zu\n", range.name.c_str(), wrong, drives);
  }
  std::printf("removed: silent wrong names in %zu of %zu\n", silent, all);
}

// Effects that no catalogue lists.
void study_outside(std::size_t drives, std::uint64_t seed, int threads) {
  std::size_t right = 0, all = 0;
  for (const OutsideEffect& outside : outside_effects()) {
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < drives; ++i) jobs.push_back(job_of(outside.range, seed, i));
    std::size_t here = 0;
    for (const Outcome& o : run_all(jobs, threads)) {
      const bool good = o.unknown_but_right(outside);
      here += good ? 1 : 0;
      if (!good || !o.found.causes.empty()) std::printf("  %s\n", o.to_line().c_str());
    }
    all += drives;
    right += here;
    std::printf("%-28s unknown, right hook and covariate %zu of %zu\n", outside.range.name.c_str(),
                here, drives);
    std::fflush(stdout);
  }
  std::printf("outside: %zu of %zu\n", right, all);
}

// The errors of the reference poses are autocorrelated. Measures the coverage of the intervals and
// the false alarm rate.
void study_correlated(std::size_t drives, std::uint64_t seed, int threads) {
  const auto& ranges = practical_ranges();
  std::vector<Job> jobs;
  std::vector<std::string> effects;
  for (std::size_t i = 0; i < drives; ++i) {
    Random random(seed, "study correlated", i);
    const EffectRange& range = ranges[random.below(28)];
    jobs.push_back(job_of(range, seed, i));
    jobs.back().hidden.secret["poses.correlation"] = random.uniform(0.5, 0.95);
    effects.push_back(range.name);
  }
  std::size_t in_set = 0, further = 0, covered = 0, intervals = 0, rho = 0, rhos = 0;
  double square = 0.0;
  const auto outcomes = run_all(jobs, threads);
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const Outcome& o = outcomes[i];
    in_set += o.in_set(effects[i]) ? 1 : 0;
    std::size_t others = o.found.unknown.size();
    for (const FoundCause& c : o.found.causes) {
      const double size = o.hidden.secret.contains(c.effect) ? o.hidden.secret.at(c.effect) : 0.0;
      others += !c.noise && c.effect != effects[i] ? 1 : 0;
      if (c.effect == "poses.correlation") {
        ++rhos;
        rho += size >= c.low && size <= c.high ? 1 : 0;
      } else if (c.effect == effects[i] && c.effect != "wheels0.wet_patch") {
        ++intervals;
        covered += size >= c.low && size <= c.high ? 1 : 0;
        square += std::pow((c.size - size) / sigma_of(c), 2);
      }
    }
    further += others > 0 ? 1 : 0;
    std::printf("  %s\n", o.to_line().c_str());
  }
  std::printf(
      "correlated poses: in set %zu of %zu, drives with further names %zu, intervals %zu of %zu "
      "(z %.2f), correlation held %zu of %zu\n",
      in_set, drives, further, covered, intervals,
      std::sqrt(square / static_cast<double>(std::max<std::size_t>(intervals, 1))), rho, rhos);
}

// Wet patches of several sizes and radii on a smooth oval: are sizes and intervals right, and is
// nothing else said?
void study_patches(std::size_t drives, std::uint64_t seed, int threads) {
  for (const double radius : {1.5, 2.0, 3.0, 4.0})
    for (const double size : {0.03, 0.05, 0.10, -0.10}) {
      std::vector<Job> jobs(drives);
      for (std::size_t i = 0; i < drives; ++i) {
        HiddenDriveOptions& hidden = jobs[i].hidden;
        hidden.seed = Random(seed, "study patch", i)() >> 1U;
        hidden.oval = true;
        hidden.puddle_radius_m = radius;
        hidden.secret["wheels0.wet_patch"] = size;
      }
      std::size_t named = 0, covered = 0, alone = 0;
      double seconds = 0.0, mean = 0.0, square = 0.0;
      for (const Outcome& o : run_all(jobs, threads)) {
        seconds += o.seconds / static_cast<double>(drives);
        alone += o.found.causes.size() + o.found.unknown.size() == 1 ? 1 : 0;
        std::printf("  %s\n", o.to_line().c_str());
        const FoundCause* cause = o.cause("wheels0.wet_patch");
        if (cause == nullptr) continue;
        ++named;
        mean += cause->size;
        square += std::pow((cause->size - size) / sigma_of(*cause), 2);
        covered += size >= cause->low && size <= cause->high ? 1 : 0;
      }
      const double n = static_cast<double>(std::max<std::size_t>(named, 1));
      std::printf(
          "radius %.1f m, size %5.2f: named %zu of %zu, alone %zu, mean %.4f, cover %zu, z %.2f, "
          "%.3f s\n",
          radius, size, named, drives, alone, mean / n, covered, std::sqrt(square / n), seconds);
      std::fflush(stdout);
    }
}

}  // namespace
}  // namespace roadbook::test

int main(int count, char** words) {
  if (count < 5) {
    std::fprintf(stderr,
                 "usage: %s "
                 "nulls|lasting|lasting_effects|effects|pairs|removed|outside|correlated|columns|"
                 "idle_columns|"
                 "noise_pairs|noise_sizes|patches DRIVES SEED THREADS [NAME | POSE_SIGMA_M]\n",
                 words[0]);
    return 1;
  }
  const std::string mode = words[1];
  const auto drives = static_cast<std::size_t>(std::atoll(words[2]));
  const auto seed = static_cast<std::uint64_t>(std::atoll(words[3]));
  const int threads = std::atoi(words[4]);
  if (mode == "nulls")
    roadbook::test::study_nulls(
        drives, seed, threads,
        count > 5 ? std::atof(words[5]) : roadbook::test::HiddenDriveOptions{}.pose_sigma_m);
  if (mode == "lasting") roadbook::test::study_lasting(drives, seed, threads);
  if (mode == "lasting_effects")
    roadbook::test::study_lasting_effects(drives, seed, threads, count > 5 ? words[5] : "");
  if (mode == "effects")
    roadbook::test::study_effects(drives, seed, threads, count > 5 ? words[5] : "");
  if (mode == "pairs") roadbook::test::study_pairs(drives, seed, threads);
  if (mode == "removed") roadbook::test::study_removed(drives, seed, threads);
  if (mode == "outside") roadbook::test::study_outside(drives, seed, threads);
  if (mode == "columns" || mode == "idle_columns")
    roadbook::test::study_columns(drives, seed, threads, mode == "columns");
  if (mode == "noise_pairs") roadbook::test::study_noise_pairs(drives, seed, threads);
  if (mode == "noise_sizes") roadbook::test::study_noise_sizes(drives, seed, threads);
  if (mode == "patches") roadbook::test::study_patches(drives, seed, threads);
  if (mode == "correlated") roadbook::test::study_correlated(drives, seed, threads);
  return 0;
}
