#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/random.hpp"
#include "tests/diagnosis/hidden_views/study_case.hpp"
#include "tests/support/found_causes.hpp"

// hidden_views_study MODE DRIVES SEED LENGTH [NAME]
//
// MODE is one of nulls | effects | pairs | removed | map | shifted | turned. NAME limits effects
// and pairs to effects whose name contains NAME. Mode map: effects that show against an earlier
// drive, with null drives among them. Modes shifted and turned: for how many cameras the diagnosis
// reports that whole images are shifted, or turned and stretched. The output has one line for each
// effect and one for each drive with a wrong result.

namespace roadbook::test {
namespace {

struct Study {
  std::size_t drives = 1;
  std::uint64_t seed = 1;
  double length_m = 300.0;
  std::string only;
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("roadbook_views_" + std::to_string(::getpid()));

  // Outliers in every other drive: 2 % of the views.
  [[nodiscard]] HiddenViewOptions drive(const std::string& name, std::size_t i) const {
    HiddenViewOptions o;
    o.seed = Random(seed, "study " + name, i)() >> 1U;
    o.length_m = length_m;
    o.outliers = i % 2 == 0 ? 0.0 : 0.02;
    return o;
  }
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void study_nulls(const Study& study) {
  std::size_t alarms = 0;
  double seconds = 0.0;
  for (std::size_t i = 0; i < study.drives; ++i) {
    const ViewOutcome o = run_hidden_views(study.drive("null", i), study.folder);
    seconds += o.seconds;
    if (o.extra() == 0 && o.found.unexplained.empty()) continue;
    ++alarms;
    std::printf("  %s\n", o.to_line().c_str());
  }
  std::printf("null: %zu alarms of %zu, %.2f s a drive\n", alarms, study.drives,
              seconds / static_cast<double>(study.drives));
}

struct Tally {
  std::size_t drives = 0, first = 0, set = 0, strong = 0, strong_set = 0, extra = 0;
  std::size_t covered = 0, intervals = 0, set_size = 0, sets = 0;
  std::vector<double> ratios;
  double seconds = 0.0, z2 = 0.0;

  void add(const ViewOutcome& o, const std::string& effect) {
    ++drives;
    seconds += o.seconds;
    const bool right = o.in_set(effect);
    first += o.named_first(effect) ? 1 : 0;
    set += right ? 1 : 0;
    extra += o.extra() > 0 ? 1 : 0;
    if (o.strength >= 8.0) {
      ++strong;
      strong_set += right ? 1 : 0;
    }
    if (!o.found.causes.empty()) {
      ++sets;
      set_size += 1 + o.found.causes.front().inseparable.size();
    }
    if (const FoundCause* cause = o.cause(effect)) {
      const double size = o.hidden.secret.at(effect);
      ++intervals;
      covered += size >= cause->low && size <= cause->high ? 1 : 0;
      z2 += std::pow((cause->size - size) / sigma_of(*cause), 2);
      if (o.oracle_gain > 0.0) ratios.push_back(cause->gain.total / o.oracle_gain);
    }
  }
  void print(const std::string& name) const {
    std::printf(
        "%-28s n %zu first %zu set %zu strong %zu/%zu extra %zu cover %zu/%zu z %.2f "
        "set size %.2f gain/oracle %.3f (3 %%: %.3f) %.2f s\n",
        name.c_str(), drives, first, set, strong_set, strong, extra, covered, intervals,
        std::sqrt(z2 / std::max(1.0, static_cast<double>(intervals))),
        static_cast<double>(set_size) / static_cast<double>(std::max<std::size_t>(sets, 1)),
        quantile(ratios, 0.5), quantile(ratios, 0.03), seconds / static_cast<double>(drives));
    std::fflush(stdout);
  }
};

void study_effects(const Study& study, bool removed) {
  Tally all;
  std::size_t silent = 0;
  for (const EffectRange& range : practical_view_ranges()) {
    if (range.name.find(study.only) == std::string::npos) continue;
    Tally tally;
    for (std::size_t i = 0; i < study.drives; ++i) {
      HiddenViewOptions hidden = study.drive(range.name, i);
      hidden.secret[range.name] = draw_size(range, hidden.seed);
      const ViewOutcome o = run_hidden_views(
          hidden, study.folder,
          removed ? std::vector<std::string>{range.name} : std::vector<std::string>());
      tally.add(o, range.name);
      all.add(o, range.name);
      const bool named = std::any_of(o.found.causes.begin(), o.found.causes.end(),
                                     [](const FoundCause& c) { return !c.noise; });
      const bool quiet = named && o.found.unknown.empty() && o.found.unexplained.empty();
      silent += quiet ? 1 : 0;
      const FoundCause* cause = o.cause(range.name);
      const double size = hidden.secret[range.name];
      const bool held = cause == nullptr || (size >= cause->low && size <= cause->high);
      if (removed ? quiet : !o.in_set(range.name) || o.extra() > 0 || !held)
        std::printf("  %s\n", o.to_line().c_str());
    }
    if (!removed) tally.print(range.name);
  }
  if (removed)
    std::printf("removed: silent wrong names in %zu of %zu\n", silent, all.drives);
  else
    all.print("all");
}

// Two different effects at once: both must be found or be in a set.
void study_pairs(const Study& study) {
  const std::vector<EffectRange>& ranges = practical_view_ranges();
  std::size_t drives = 0, both = 0, one_set = 0, extra = 0, intervals = 0, covered = 0;
  for (std::size_t i = 0; i < study.drives; ++i) {
    Random random(study.seed, "study pair", i);
    const std::size_t a = random.below(ranges.size());
    std::size_t b = random.below(ranges.size() - 1);
    b += b >= a ? 1 : 0;
    if ((ranges[a].name + " " + ranges[b].name).find(study.only) == std::string::npos) continue;
    ++drives;
    HiddenViewOptions hidden = study.drive("pair", i);
    for (const std::size_t k : {a, b})
      hidden.secret[ranges[k].name] =
          draw_size(ranges[k], Random(hidden.seed, ranges[k].name, 0)());
    const ViewOutcome o = run_hidden_views(hidden, study.folder);
    std::size_t named = 0;
    for (const auto& [name, size] : hidden.secret) {
      named += o.names(name) ? 1 : 0;
      if (const FoundCause* cause = o.cause(name)) {
        ++intervals;
        covered += size >= cause->low && size <= cause->high ? 1 : 0;
      }
    }
    both += named == 2 ? 1 : 0;
    one_set += named == 2 && o.found.causes.size() == 1 ? 1 : 0;
    extra += o.extra() > 0 ? 1 : 0;
    if (named < 2 || o.extra() > 0) std::printf("  %s\n", o.to_line().c_str());
    std::fflush(stdout);
  }
  std::printf(
      "pairs: both named in %zu of %zu (as one set in %zu), another beside them in %zu, cover "
      "%zu/%zu\n",
      both, drives, one_set, extra, covered, intervals);
}

void study_map(const Study& study) {
  std::vector<EffectRange> ranges = practical_map_ranges();
  ranges.push_back({"nothing", 0.0, 0.0});
  ranges.push_back({"nothing, half lost", 0.0, 0.0});
  for (const EffectRange& range : ranges) {
    if (range.name.find(study.only) == std::string::npos) continue;
    Tally tally;
    for (std::size_t i = 0; i < study.drives; ++i) {
      HiddenViewOptions hidden = study.drive("map " + range.name, i);
      hidden.earlier = true;
      // Objects of two metres have enough landmarks; half of these landmarks are not redetected.
      if (range.name == "map.landmarks_gone" || range.name == "nothing, half lost") {
        hidden.landmarks_per_m = 100.0;
        hidden.lost = 0.5;
      }
      if (range.high > 0.0) hidden.secret[range.name] = draw_size(range, hidden.seed);
      const ViewOutcome o = run_hidden_map(hidden, study.folder);
      tally.add(o, range.name);
      if (o.extra() > 0 || (range.high > 0.0 && !o.in_set(range.name)))
        std::printf("  %s\n", o.to_line().c_str());
    }
    tally.print(range.name);
  }
}

// Counts the cameras whose views are not white (p < 1e-6) and the drives with a false effect.
// `one`: kind of image error; `sizes`: its sizes.
void study_images(const Study& study,
                  double HiddenViewOptions::*one,
                  const std::vector<double>& sizes) {
  for (const double size : sizes) {
    std::vector<double> p;
    std::size_t causes = 0;
    for (std::size_t i = 0; i < study.drives; ++i) {
      HiddenViewOptions hidden = study.drive("shifted", i);
      hidden.*one = size;
      const ViewOutcome o = run_hidden_views(hidden, study.folder);
      causes += o.extra() > 0 ? 1 : 0;
      for (const ChannelCheck& c : o.found.after)
        if (c.channel == "reprojection") p.push_back(c.whiteness_p);
    }
    const auto told = std::count_if(p.begin(), p.end(), [](double x) { return x < 1e-6; });
    std::printf(
        "%g: cameras not white %td of %zu, p least %.2g, median %.2g, most %.2g; causes in %zu of "
        "%zu\n",
        size, told, p.size(), quantile(p, 0.0), quantile(p, 0.5), quantile(p, 1.0), causes,
        study.drives);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace roadbook::test

int main(int count, char** words) {
  if (count < 5) {
    std::fprintf(
        stderr,
        "usage: %s nulls|effects|pairs|removed|map|shifted|turned DRIVES SEED LENGTH [NAME]\n",
        words[0]);
    return 1;
  }
  const std::string mode = words[1];
  roadbook::test::Study study;
  study.drives = static_cast<std::size_t>(std::atoll(words[2]));
  study.seed = static_cast<std::uint64_t>(std::atoll(words[3]));
  study.length_m = std::atof(words[4]);
  if (count > 5) study.only = words[5];
  std::filesystem::create_directories(study.folder);
  if (mode == "nulls") roadbook::test::study_nulls(study);
  if (mode == "effects") roadbook::test::study_effects(study, false);
  if (mode == "pairs") roadbook::test::study_pairs(study);
  using Hidden = roadbook::test::HiddenViewOptions;
  if (mode == "shifted")
    roadbook::test::study_images(study, &Hidden::images_shift_px, {0.0, 0.1, 0.3, 1.0});
  if (mode == "turned")
    roadbook::test::study_images(study, &Hidden::images_turn, {3e-4, 1e-3, 3e-3});
  if (mode == "map") roadbook::test::study_map(study);
  if (mode == "removed") roadbook::test::study_effects(study, true);
  std::filesystem::remove_all(study.folder);
  return 0;
}
