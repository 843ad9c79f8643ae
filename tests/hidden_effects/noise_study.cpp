#include "tests/hidden_effects/noise_study.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "base/parallel.hpp"
#include "base/random.hpp"

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
  const auto folder =
      std::filesystem::temp_directory_path() / ("roadbook_study_" + std::to_string(::getpid()));
  for (const auto& pair : noise_pairs()) {
    std::vector<Outcome> outcomes(drives);
    parallel_for(drives, threads, [&](std::size_t i) {
      HiddenDriveOptions hidden;
      hidden.seed = Random(seed, "noise " + pair[0] + pair[1], i)() >> 1U;
      for (const std::string& name : pair)
        hidden.secret[name] = draw_size(range_of(name), hidden.seed);
      const auto drive = folder / std::to_string(i);
      outcomes[i] = run_hidden(hidden, drive);
      std::filesystem::remove_all(drive);
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
  std::filesystem::remove_all(folder);
}

}  // namespace roadbook::test
