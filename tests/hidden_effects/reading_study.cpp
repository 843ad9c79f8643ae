// Study of readings: hidden_readings_study friction|range|detector effects|nulls|removed|outside
// DRIVES SEED [EFFECT]. One line a drive, then a table.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include "base/random.hpp"
#include "tests/hidden_effects/reading_study_cases.hpp"

namespace {

using namespace roadbook;        // NOLINT
using namespace roadbook::test;  // NOLINT

struct Tally {
  int drives = 0, first = 0, set = 0, wrong = 0, further = 0, unnamed = 0, covered = 0, sized = 0;
  int unknown = 0, silent = 0, flagged = 0;
  double seconds = 0.0;
};

ReadingOutcome run(const std::string& kind,
                   std::uint64_t seed,
                   const Secret& secret,
                   const std::filesystem::path& folder,
                   const std::vector<std::string>& without) {
  if (kind == "friction") {
    FrictionSecret hidden;
    hidden.seed = seed;
    hidden.secret = secret;
    return run_friction(hidden, folder, without);
  }
  if (kind == "detector") {
    DetectorSecret hidden;
    hidden.seed = seed;
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
  if (const FoundCause* c = o.cause(effect)) {
    ++t.sized;
    t.covered += c->low <= size && size <= c->high;
  }
}

void say(const std::string& name, const Tally& t) {
  std::printf(
      "%-28s drives %d first %d set %d unnamed %d wrong %d further %d unknown %d cover "
      "%d/%d silent %d mean %.2fs\n",
      name.c_str(), t.drives, t.first, t.set, t.unnamed, t.wrong, t.further, t.unknown, t.covered,
      t.sized, t.silent, t.seconds / std::max(1, t.drives));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::cerr << "friction|range|detector effects|nulls|removed|outside DRIVES SEED [EFFECT]\n";
    return 1;
  }
  const std::string kind = argv[1], what = argv[2];
  const int drives = std::atoi(argv[3]);
  const std::uint64_t base = std::strtoull(argv[4], nullptr, 10);
  const std::string only = argc > 5 ? argv[5] : "";
  const auto folder = std::filesystem::temp_directory_path() /
                      ("hidden_readings_" + kind + what + std::to_string(base) + only);
  Tally all;
  const auto& ranges = what == "outside"    ? outside_detector_ranges()
                       : kind == "friction" ? friction_ranges()
                       : kind == "detector" ? detector_ranges()
                                            : range_ranges();
  if (what == "nulls") {
    for (int i = 0; i < drives; ++i) {
      const auto o = run(kind, base + static_cast<std::uint64_t>(i), {}, folder, {});
      count(o, "", 0.0, all);
      if (!o.silent() || !o.found.unexplained.empty()) std::cout << o.to_line() << std::endl;
    }
    say("nulls (wrong = alarms)", all);
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
            what == "removed" ? std::vector<std::string>{range.name} : std::vector<std::string>{});
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
