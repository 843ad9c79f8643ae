// Study of readings: hidden_readings_study friction|range|detector
// effects|nulls|pairs|removed|outside DRIVES SEED [EFFECT [PEOPLE | PLACES]]. One line a drive,
// then a table.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "tests/diagnosis/hidden_effects/reading_study_cases.hpp"

namespace {

using namespace roadbook;        // NOLINT
using namespace roadbook::test;  // NOLINT

struct Tally {
  int drives = 0, first = 0, set = 0, wrong = 0, further = 0, unnamed = 0, covered = 0, sized = 0;
  int unknown = 0, silent = 0, flagged = 0, sets = 0, members = 0, strong = 0, strong_set = 0;
  double seconds = 0.0;
  double best = 0.0;          // drives that the best of tests would name
  std::vector<double> gains;  // over the oracle's

  double gain(double share) {
    if (gains.empty()) return 0.0;
    std::sort(gains.begin(), gains.end());
    return gains[static_cast<std::size_t>(share * static_cast<double>(gains.size() - 1))];
  }
};

// Power of an ideal test that knows the effect and shares one false alarm in 200 drives with the
// other effects of its sensor. 1 for noise, which has no oracle.
double best_power(double strength, const std::string& effect) {
  const double two_sided = effect.starts_with("friction0.")  ? 3.29   // of 0.005 / 5
                           : effect.starts_with("detector.") ? 3.02   // of 0.005 / 2
                                                             : 3.14;  // of 0.005 / 3
  return strength > 0.0 ? 0.5 * std::erfc((two_sided - strength) / std::sqrt(2.0)) : 1.0;
}

ReadingOutcome run(const std::string& kind,
                   std::uint64_t seed,
                   const Secret& secret,
                   const std::filesystem::path& folder,
                   const std::vector<std::string>& without,
                   std::uint64_t number) {
  if (kind == "friction") {
    FrictionSecret hidden;
    hidden.seed = seed;
    hidden.secret = secret;
    if (number > 0) hidden.resurfaced = static_cast<int>(number);
    return run_friction(hidden, folder, without);
  }
  if (kind == "detector") {
    DetectorSecret hidden;
    hidden.seed = seed;
    hidden.people = number;
    hidden.secret = secret;
    return run_detector(hidden, folder, without);
  }
  RangeSecret hidden;
  hidden.seed = seed;
  hidden.secret = secret;
  return run_range(hidden, folder, without);
}

void count(const ReadingOutcome& o, const std::string& effect, double size, Tally& t) {
  ++t.drives;
  t.seconds += o.seconds;
  t.unknown += !o.found.unknown.empty();
  t.flagged += !o.found.unknown.empty() || !o.found.unexplained.empty();
  t.silent += !o.found.causes.empty() && o.found.unknown.empty() && o.found.unexplained.empty();
  t.first += o.named_first(effect);
  t.set += o.in_set(effect);
  t.unnamed += o.found.causes.empty();
  t.wrong += !o.found.causes.empty() && !o.in_set(effect);
  t.further += static_cast<int>(o.found.causes.size()) > 1 && o.in_set(effect);
  t.best += best_power(o.oracle.strength, effect);
  t.strong += o.oracle.strength >= 8.0;
  t.strong_set += o.oracle.strength >= 8.0 && o.in_set(effect);
  if (!o.found.causes.empty()) {
    ++t.sets;
    t.members += 1 + static_cast<int>(o.found.causes.front().inseparable.size());
  }
  if (const FoundCause* c = o.cause(effect)) {
    ++t.sized;
    t.covered += c->low <= size && size <= c->high;
    if (o.oracle.gain > 0.0 && !c->noise) t.gains.push_back(c->gain.total / o.oracle.gain);
  }
}

void say(const std::string& name, Tally& t) {
  std::printf(
      "%-28s drives %d first %d (best of tests %.1f) set %d unnamed %d wrong %d further %d unknown "
      "%d cover "
      "%d/%d silent %d strong %d/%d members %d/%d gain %.3f 3%%: %.3f mean %.2fs\n",
      name.c_str(), t.drives, t.first, t.best, t.set, t.unnamed, t.wrong, t.further, t.unknown,
      t.covered, t.sized, t.silent, t.strong_set, t.strong, t.members, t.sets, t.gain(0.5),
      t.gain(0.03), t.seconds / std::max(1, t.drives));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::cerr << "friction|range|detector effects|nulls|pairs|removed|outside DRIVES SEED [EFFECT "
                 "[PEOPLE | PLACES]]\n";
    return 1;
  }
  const std::string kind = argv[1], what = argv[2];
  const int drives = std::atoi(argv[3]);
  const std::uint64_t base = std::strtoull(argv[4], nullptr, 10);
  const std::string only = argc > 5 ? argv[5] : "";
  const std::uint64_t number = argc > 6 ? std::strtoull(argv[6], nullptr, 10) : 0;
  const auto folder = std::filesystem::temp_directory_path() /
                      ("hidden_readings_" + kind + what + std::to_string(base) + only);
  Tally all;
  const auto& ranges = what == "outside"    ? outside_detector_ranges()
                       : kind == "friction" ? friction_ranges()
                       : kind == "detector" ? detector_ranges()
                                            : range_ranges();
  if (what == "nulls") {
    for (int i = 0; i < drives; ++i) {
      const auto o = run(kind, base + static_cast<std::uint64_t>(i), {}, folder, {}, number);
      count(o, "", 0.0, all);
      if (!o.silent() || !o.found.unexplained.empty()) std::cout << o.to_line() << std::endl;
    }
    say("nulls (wrong = alarms)", all);
  } else if (what == "pairs") {
    int both = 0;
    for (int i = 0; i < drives; ++i) {
      Random random(base, "pair", static_cast<std::uint64_t>(i));
      const std::size_t a = random.below(ranges.size());
      const std::size_t b = (a + 1 + random.below(ranges.size() - 1)) % ranges.size();
      const std::uint64_t seed = random() % 1'000'000'007ULL;
      const auto o = run(kind, seed,
                         {{ranges[a].name, draw_size(ranges[a], seed)},
                          {ranges[b].name, draw_size(ranges[b], seed)}},
                         folder, {}, number);
      both += o.cause(ranges[a].name) != nullptr && o.cause(ranges[b].name) != nullptr;
      std::cout << o.to_line() << std::endl;
    }
    std::printf("pairs: both named %d of %d\n", both, drives);
  } else {
    for (const EffectRange& range : ranges) {
      if (!only.empty() && range.name != only) continue;
      Tally t;
      for (int i = 0; i < drives; ++i) {
        const std::uint64_t seed =
            Random(base, range.name, static_cast<std::uint64_t>(i))() % 1'000'000'007ULL;
        const double size = draw_size(range, seed);
        const auto o = run(
            kind, seed, {{range.name, size}}, folder,
            what == "removed" ? std::vector<std::string>{range.name} : std::vector<std::string>{},
            number);
        count(o, range.name, size, t);
        count(o, range.name, size, all);
        std::cout << o.to_line() << std::endl;
      }
      say(range.name, t);
    }
    say("all", all);
  }
  std::filesystem::remove_all(folder);
}
