#include "tests/diagnosis/hidden_effects/noise_study.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "tests/support/found_causes.hpp"

namespace roadbook::test {
namespace {

const EffectRange& range_of(const std::string& name) {
  const auto& all = practical_ranges();
  return *std::find_if(all.begin(), all.end(),
                       [&](const EffectRange& r) { return r.name == name; });
}

std::size_t missed_intervals(const Outcome& o) {
  return static_cast<std::size_t>(
      std::count_if(o.found.causes.begin(), o.found.causes.end(), [&](const FoundCause& c) {
        const auto hidden = o.hidden.secret.find(c.effect);
        return hidden != o.hidden.secret.end() &&
               (hidden->second < c.low || hidden->second > c.high);
      }));
}

std::filesystem::path study_folder() {
  return std::filesystem::temp_directory_path() / ("roadbook_study_" + std::to_string(::getpid()));
}

// Runs the drives; `hide` sets the hidden effects of each.
template <typename Hide>
std::vector<Outcome> run_drives(std::size_t drives, int threads, const Hide& hide) {
  std::vector<Outcome> outcomes(drives);
  parallel_for(drives, threads, [&](std::size_t i) {
    const auto drive = study_folder() / std::to_string(i);
    outcomes[i] = run_hidden(hide(i), drive);
    std::filesystem::remove_all(drive);
  });
  std::filesystem::remove_all(study_folder());
  return outcomes;
}

void print_sizes(const std::vector<Outcome>& outcomes) {
  const Secret& secret = outcomes.front().hidden.secret;
  std::size_t wrong = 0;
  for (const Outcome& o : outcomes) wrong += wrong_noise(o) == 0 ? 0 : 1;
  for (const auto& [name, size] : secret) {
    double named = 0.0, sum = 0.0, squares = 0.0;
    std::size_t held = 0;
    for (const Outcome& o : outcomes) {
      const FoundCause* cause = o.cause(name);
      if (cause == nullptr) continue;
      named += 1.0;
      sum += cause->size;
      squares += std::pow((cause->size - size) / sigma_of(*cause), 2);
      held += cause->low <= size && size <= cause->high ? 1 : 0;
    }
    std::printf("%s %g: mean %.4g, rms error over sigma %.2f, held %zu of %.0f\n", name.c_str(),
                size, sum / named, std::sqrt(squares / named), held, named);
  }
  std::printf("  drives with other names, or without one: %zu of %zu\n", wrong, outcomes.size());
  std::fflush(stdout);
}

}  // namespace

std::vector<std::vector<std::string>> noise_pairs() {
  return {
      {"imu0.outliers", "imu0.variance(turn)"},
      {"imu0.outliers", "imu0.correlation"},
      {"imu0.correlation", "imu0.variance(turn)"},
      {"wheels0.outliers", "wheels0.variance(turn)"},
      {"wheels0.outliers", "wheels0.variance(speed)"},
      {"poses.outliers", "poses.variance(speed)"},
  };
}

std::size_t wrong_noise(const Outcome& outcome) {
  std::size_t wrong = outcome.found.unknown.size();
  for (const FoundCause& c : outcome.found.causes)
    wrong += outcome.hidden.secret.contains(c.effect) ? 0 : 1;
  for (const auto& [name, size] : outcome.hidden.secret)
    wrong += outcome.cause(name) == nullptr ? 1 : 0;
  return wrong;
}

void study_noise_pairs(std::size_t drives, std::uint64_t seed, int threads) {
  for (const auto& pair : noise_pairs()) {
    const std::vector<Outcome> outcomes = run_drives(drives, threads, [&](std::size_t i) {
      HiddenDriveOptions hidden;
      hidden.seed = Random(seed, "noise " + pair[0] + pair[1], i)() >> 1U;
      for (const std::string& name : pair)
        hidden.secret[name] = draw_size(range_of(name), hidden.seed);
      return hidden;
    });
    std::size_t right = 0, missed = 0;
    for (const Outcome& o : outcomes) {
      right += wrong_noise(o) == 0 ? 1 : 0;
      missed += missed_intervals(o);
      if (wrong_noise(o) > 0) std::printf("  %s\n", o.to_line().c_str());
    }
    std::printf("%s and %s: both, and nothing else, in %zu of %zu; outside their interval %zu\n",
                pair[0].c_str(), pair[1].c_str(), right, drives, missed);
    std::fflush(stdout);
  }
}

void study_noise_sizes(std::size_t drives, std::uint64_t seed, int threads) {
  std::vector<Secret> secrets;
  for (const char* stream : {"poses", "imu0", "wheels0"})
    for (const double share : {0.01, 0.03, 0.06, 0.1})
      secrets.push_back({{std::string(stream) + ".outliers", share}});
  for (const double share : {0.01, 0.05, 0.1})
    for (const double correlation : {0.4, 0.6, 0.8, 0.9})
      secrets.push_back({{"imu0.outliers", share}, {"imu0.correlation", correlation}});
  for (const double share : {0.02, 0.05})
    secrets.push_back(
        {{"imu0.gyro_bias", 0.004}, {"imu0.outliers", share}, {"imu0.correlation", 0.85}});
  for (const Secret& secret : secrets)
    print_sizes(run_drives(drives, threads, [&](std::size_t i) {
      HiddenDriveOptions hidden;
      hidden.seed = Random(seed, "noise sizes", i)() >> 1U;
      hidden.secret = secret;
      return hidden;
    }));
}

}  // namespace roadbook::test
