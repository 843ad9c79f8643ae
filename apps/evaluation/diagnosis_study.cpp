#include "apps/evaluation/diagnosis_study.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <mutex>
#include <sstream>

#include "apps/evaluation/hidden_drive.hpp"
#include "base/format.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {
namespace {

double thread_seconds() {
  std::timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void study_motion(StudiedDrive& drive, const Drive& recorded, const EffectSizes& hidden) {
  const MotionStreams streams = motion_streams(recorded);
  const double start = thread_seconds();
  DiagnosisOptions diagnosis;
  if (drive.removed) diagnosis.library.without = {drive.effect};
  drive.found = diagnose(streams, recorded.name(), diagnosis);
  drive.seconds = thread_seconds() - start;
  drive.oracle = ask_oracle(streams, hidden);
}

void study_readings(StudiedDrive& drive, const Drive& recorded, const EffectSizes& hidden) {
  const DriveReadings readings = drive_readings(recorded, motion_streams(recorded).poses);
  const double start = thread_seconds();
  LibraryOptions library;
  if (drive.removed) library.without = {drive.effect};
  drive.found = diagnose_readings(readings, {}, library);
  drive.seconds = thread_seconds() - start;
  drive.oracle = ask_oracle(readings, hidden);
}

// Writes a drive with the hidden effect, reads it again and diagnoses it.
void study(StudiedDrive& drive,
           const std::filesystem::path& folder,
           std::uint64_t seed,
           double length_m) {
  EffectSizes hidden = drive.beside;
  if (!drive.effect.empty()) hidden[drive.effect] = drive.size;
  const bool moves = drive.kind == HiddenKind::kMotion;
  if (moves)
    write_hidden_drive(folder, seed, length_m, hidden, drive.reference);
  else
    write_hidden_readings(folder, seed, drive.kind, hidden);
  DriveOptions options;
  options.num_threads = 1;
  (moves ? study_motion : study_readings)(drive, Drive::open(folder, options), hidden);
  std::filesystem::remove_all(folder);
}

// Returns whether the effect is requested. `only` has prefixes of names, separated by commas. Empty
// means all effects.
bool is_asked_for(const std::string& effect, const std::string& only) {
  std::istringstream beginnings(only);
  bool any = false;
  for (std::string beginning; std::getline(beginnings, beginning, ',');) {
    if (effect.starts_with(beginning)) return true;
    any = true;
  }
  return !any;
}

// Returns the requested effects, those of motion first.
std::vector<EffectRange> effects_of(const DiagnosisStudyOptions& options) {
  std::vector<EffectRange> all = practical_effects();
  const std::vector<EffectRange>& more = practical_reading_effects();
  all.insert(all.end(), more.begin(), more.end());
  std::erase_if(all, [&](const EffectRange& r) {
    return !is_asked_for(r.name, options.only) ||
           (!options.readings && kind_of_effect(r.name) != HiddenKind::kMotion);
  });
  return all;
}

// Correlation times of a reference's errors [s].
constexpr std::array kLastingS{0.3, 1.0, 3.0, 10.0};

struct Plan {
  std::vector<StudiedDrive> drives;
  std::vector<std::uint64_t> seeds;

  StudiedDrive& add(HiddenKind kind, std::uint64_t seed) {
    seeds.push_back(seed);
    drives.emplace_back();
    drives.back().kind = kind;
    return drives.back();
  }
  StudiedDrive& add(const EffectRange& range, std::uint64_t seed) {
    StudiedDrive& drive = add(kind_of_effect(range.name), seed);
    drive.effect = range.name;
    drive.size = draw_size(range, seed);
    return drive;
  }
};

// Adds drives with two effects of the same kind.
void add_pairs(const DiagnosisStudyOptions& options,
               const std::string& name,
               const std::vector<EffectRange>& ranges,
               Plan& plan) {
  if (ranges.size() < 2) return;
  for (std::size_t i = 0; i < options.pair_drives; ++i) {
    Random random(options.seed, "diagnosis study pair" + name, i);
    const std::size_t a = random.below(ranges.size());
    const std::size_t b = (a + 1 + random.below(ranges.size() - 1)) % ranges.size();
    StudiedDrive& drive = plan.add(ranges[a], random() >> 1U);
    drive.beside[ranges[b].name] = draw_size(ranges[b], plan.seeds.back());
  }
}

// Adds drives without an effect whose reference has errors that last, and as many with an effect.
void add_lasting(const DiagnosisStudyOptions& options, Plan& plan) {
  if (!is_asked_for("lasting", options.only)) return;
  std::vector<EffectRange> own = practical_effects();
  std::erase_if(own, [](const EffectRange& r) { return is_noise_effect(r.name); });
  for (const double time_s : kLastingS)
    for (std::size_t i = 0; i < options.lasting_drives; ++i) {
      const std::string name = "diagnosis study lasting " + fixed(time_s, 1);
      const std::uint64_t seed = Random(options.seed, name, i)() >> 1U;
      plan.add(HiddenKind::kMotion, seed).reference = draw_lasting_reference(time_s, seed);
      Random random(seed, "effect beside lasting errors");
      plan.add(own[random.below(own.size())], random() >> 1U).reference =
          draw_lasting_reference(time_s, plan.seeds.back());
    }
}

// Drives of readings take one to two seconds to make, so the study uses three tenths of the number.
std::size_t null_drives(const DiagnosisStudyOptions& options, HiddenKind kind) {
  return kind == HiddenKind::kMotion ? options.null_drives : (3 * options.null_drives + 9) / 10;
}

Plan plan_of(const DiagnosisStudyOptions& options) {
  const std::vector<EffectRange> ranges = effects_of(options);
  std::map<HiddenKind, std::vector<EffectRange>> kinds;
  for (const EffectRange& range : ranges) kinds[kind_of_effect(range.name)].push_back(range);
  const std::map<HiddenKind, std::string> names{{HiddenKind::kMotion, ""},
                                                {HiddenKind::kFriction, " friction"},
                                                {HiddenKind::kRange, " range"},
                                                {HiddenKind::kDetector, " detector"}};
  Plan plan;
  for (const EffectRange& range : ranges)
    for (std::size_t i = 0; i < options.drives_an_effect; ++i)
      plan.add(range, Random(options.seed, "diagnosis study " + range.name, i)() >> 1U);
  for (const auto& [kind, own] : kinds)
    for (std::size_t i = 0; i < null_drives(options, kind); ++i)
      plan.add(kind, Random(options.seed, "diagnosis study null" + names.at(kind), i)() >> 1U);
  add_lasting(options, plan);
  for (const auto& [kind, own] : kinds) add_pairs(options, names.at(kind), own, plan);
  for (const EffectRange& range : ranges)
    for (std::size_t i = 0; i < options.removed_an_effect; ++i)
      plan.add(range, Random(options.seed, "diagnosis study removed " + range.name, i)() >> 1U)
          .removed = true;
  return plan;
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

bool StudiedDrive::raises_alarm() const {
  const bool named = std::any_of(found.causes.begin(), found.causes.end(), [&](const auto& c) {
    return reference.time_s <= 0.0 || c.effect != "poses.correlation";
  });
  return named || !found.unknown.empty();
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
  Plan plan = plan_of(options);
  std::vector<StudiedDrive> drives = std::move(plan.drives);
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(drives.size(), options.num_threads, [&](std::size_t i) {
    study(drives[i], options.folder / ("drive" + std::to_string(i)), plan.seeds[i],
          options.length_m);
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
  if (const FoundCause* cause = d.finding()) {
    ++intervals;
    z.push_back(2.0 * 1.96 * (cause->size - d.size) / (cause->high - cause->low));
    covered += d.size >= cause->low && d.size <= cause->high ? 1 : 0;
    // The oracle does not know the possible gain of noise effects.
    if (d.oracle.gain > 0.0 && !cause->noise)
      gain_over_oracle.push_back(cause->gain.total / d.oracle.gain);
  }
}

std::vector<PowerBin> power_of(const std::vector<StudiedDrive>& drives) {
  constexpr std::array kEdges{0.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0, 20.0, 50.0, 1e9};
  std::vector<PowerBin> bins;
  // The oracle does not know the strength of noise effects.
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
