#include "apps/diagnosis_study.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <mutex>

#include "apps/hidden_drive.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "diagnosis/drive_streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {
namespace {

double thread_seconds() {
  std::timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Hidden, written, read again, diagnosed.
void study(StudiedDrive& drive,
           const std::filesystem::path& folder,
           std::uint64_t seed,
           double length_m) {
  EffectSizes hidden = drive.beside;
  if (!drive.effect.empty()) hidden[drive.effect] = drive.size;
  write_hidden_drive(folder, seed, length_m, hidden);
  DriveOptions options;
  options.num_threads = 1;
  const MotionStreams streams = motion_streams(Drive::open(folder, options));
  const double start = thread_seconds();
  DiagnosisOptions diagnosis;
  if (drive.removed) diagnosis.library.without = {drive.effect};
  drive.found = diagnose(streams, folder.string(), diagnosis);
  drive.seconds = thread_seconds() - start;
  drive.oracle = ask_oracle(streams, hidden);
  std::filesystem::remove_all(folder);
}

}  // namespace

bool StudiedDrive::named_first() const {
  return !found.causes.empty() && found.causes.front().effect == effect &&
         (found.unknown.empty() ||
          found.unknown.front().gain.total < found.causes.front().gain.total);
}

bool StudiedDrive::in_set() const {
  if (named_first()) return true;
  if (found.causes.empty()) return false;
  const auto& set = found.causes.front().inseparable;
  return std::find(set.begin(), set.end(), effect) != set.end();
}

bool StudiedDrive::all_named() const {
  EffectSizes hidden = beside;
  hidden[effect] = size;
  return std::all_of(hidden.begin(), hidden.end(), [&](const auto& one) {
    return std::any_of(found.causes.begin(), found.causes.end(), [&](const FoundCause& c) {
      return c.effect == one.first || std::find(c.inseparable.begin(), c.inseparable.end(),
                                                one.first) != c.inseparable.end();
    });
  });
}

std::string StudiedDrive::answer() const {
  if (silent()) return "nothing";
  const bool unknown_first =
      found.causes.empty() || (!found.unknown.empty() &&
                               found.unknown.front().gain.total >= found.causes.front().gain.total);
  if (!unknown_first) return found.causes.front().effect;
  const UnknownCause& u = found.unknown.front();
  return "unknown: " + u.stream + "." + u.hook + " ~ " + u.depends_on;
}

const FoundCause* StudiedDrive::finding() const {
  const auto at = std::find_if(found.causes.begin(), found.causes.end(),
                               [&](const FoundCause& c) { return c.effect == effect; });
  return at == found.causes.end() ? nullptr : &*at;
}

std::vector<StudiedDrive> run_diagnosis_study(const DiagnosisStudyOptions& options,
                                              const Progress& progress) {
  std::vector<StudiedDrive> drives;
  std::vector<std::uint64_t> seeds;
  for (const EffectRange& range : practical_effects())
    for (std::size_t i = 0; i < options.drives_an_effect; ++i) {
      seeds.push_back(Random(options.seed, "diagnosis study " + range.name, i)() >> 1U);
      drives.emplace_back();
      drives.back().effect = range.name;
      drives.back().size = draw_size(range, seeds.back());
    }
  for (std::size_t i = 0; i < options.null_drives; ++i) {
    seeds.push_back(Random(options.seed, "diagnosis study null", i)() >> 1U);
    drives.emplace_back();
  }
  const std::vector<EffectRange>& ranges = practical_effects();
  for (std::size_t i = 0; i < options.pair_drives; ++i) {
    Random random(options.seed, "diagnosis study pair", i);
    const std::size_t a = random.below(ranges.size());
    const std::size_t b = (a + 1 + random.below(ranges.size() - 1)) % ranges.size();
    seeds.push_back(random() >> 1U);
    drives.emplace_back();
    drives.back().effect = ranges[a].name;
    drives.back().size = draw_size(ranges[a], seeds.back());
    drives.back().beside[ranges[b].name] = draw_size(ranges[b], seeds.back());
  }
  for (const EffectRange& range : ranges)
    for (std::size_t i = 0; i < options.removed_an_effect; ++i) {
      seeds.push_back(Random(options.seed, "diagnosis study removed " + range.name, i)() >> 1U);
      drives.emplace_back();
      drives.back().effect = range.name;
      drives.back().size = draw_size(range, seeds.back());
      drives.back().removed = true;
    }
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(drives.size(), options.num_threads, [&](std::size_t i) {
    study(drives[i], options.folder / ("drive" + std::to_string(i)), seeds[i], options.length_m);
    const std::lock_guard lock(mutex);
    report(progress, "drives", ++done, drives.size());
  });
  return drives;
}

void DiagnosisScore::add(const StudiedDrive& d) {
  ++drives;
  seconds += d.seconds;
  const bool right = d.in_set();
  first += d.named_first() ? 1 : 0;
  in_set += right ? 1 : 0;
  unnamed += d.silent() ? 1 : 0;
  doubted += right && !d.found.unexplained.empty() ? 1 : 0;
  wrong += !d.silent() && !right ? 1 : 0;
  const std::size_t count = d.found.causes.size() + d.found.unknown.size();
  if (right && count > 1) further += count - 1;
  if (d.oracle.strength >= 8.0) {
    ++strong;
    strong_in_set += right ? 1 : 0;
  }
  if (!d.found.causes.empty()) {
    ++sets;
    set_members += 1 + d.found.causes.front().inseparable.size();
  }
  // A share of outliers is a lower bound: no interval.
  const bool bound = d.effect.ends_with("outliers");
  if (const FoundCause* cause = d.finding(); cause != nullptr && !bound) {
    ++intervals;
    z.push_back(2.0 * 1.96 * (cause->size - d.size) / (cause->high - cause->low));
    covered += d.size >= cause->low && d.size <= cause->high ? 1 : 0;
    if (d.oracle.gain > 0.0) gain_over_oracle.push_back(cause->gain.total / d.oracle.gain);
  }
}

std::vector<PowerBin> power_of(const std::vector<StudiedDrive>& drives) {
  constexpr std::array kEdges{0.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0, 20.0, 50.0, 1e9};
  std::vector<PowerBin> bins;
  // Of noise no oracle knows how strongly it shows.
  for (std::size_t b = 0; b + 1 < kEdges.size(); ++b) {
    PowerBin bin{kEdges[b], kEdges[b + 1]};
    for (const StudiedDrive& d : drives) {
      if (d.effect.empty() || !d.beside.empty() || d.removed || d.oracle.strength == 0.0 ||
          d.oracle.strength < bin.low || d.oracle.strength >= bin.high)
        continue;
      ++bin.drives;
      bin.in_set += d.in_set() ? 1 : 0;
    }
    if (bin.drives > 0) bins.push_back(bin);
  }
  return bins;
}

}  // namespace roadbook
