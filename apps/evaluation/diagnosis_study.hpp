#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "apps/evaluation/hidden_readings.hpp"
#include "base/progress.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/oracle.hpp"

namespace roadbook {

// How well diagnosis does on drives whose truth is known: the numbers behind
// `roadbook evaluate diagnosis`.

struct DiagnosisStudyOptions {
  std::filesystem::path folder;  ///< holds the simulated drives during their diagnosis
  std::uint64_t seed = 1;
  std::size_t drives_an_effect = 8;
  std::size_t null_drives = 40;
  std::size_t pair_drives = 0;        ///< of two effects at once
  std::size_t removed_an_effect = 0;  ///< whose true cause is not in the catalogue
  double length_m = 300.0;            ///< of drives for the diagnosis of motion
  std::string only;      ///< effects whose names begin so ("a,b": with a or b), and their kinds
  bool readings = true;  ///< friction, range and detector as well
  int num_threads = 1;
};

/// One drive: what was hidden (nothing: an empty name) and what was said of its files.
struct StudiedDrive {
  HiddenKind kind = HiddenKind::kMotion;
  std::string effect;
  double size = 0.0;
  EffectSizes beside;    ///< a second effect, of a pair
  bool removed = false;  ///< the effect is left out of the catalogue
  OracleAnswer oracle;
  Diagnosis found;
  double seconds = 0.0;  ///< of processor time, diagnosis alone

  [[nodiscard]] bool named_first() const;
  [[nodiscard]] bool in_set() const;  ///< first, or said to be inseparable from the first
  [[nodiscard]] bool silent() const { return found.causes.empty() && found.unknown.empty(); }
  /// Each hidden effect is named, or is in the set of inseparable causes of a named one.
  [[nodiscard]] bool all_named() const;
  /// A confident name without any flag: wrong where the true one is not in the catalogue.
  [[nodiscard]] bool unflagged() const {
    return !found.causes.empty() && found.unknown.empty() && found.unexplained.empty();
  }
  /// Of a drive whose effect is left out: the effect fits it no better than what was said, by less
  /// than what makes a set; no method could tell.
  [[nodiscard]] bool no_method_could_tell() const {
    return oracle.gain - found.fit_gain < SearchOptions{}.inseparable;
  }
  /// First name, "unknown: HOOK ~ COVARIATE", or "nothing".
  [[nodiscard]] std::string answer() const;
  /// The finding of the hidden effect, or null.
  [[nodiscard]] const FoundCause* finding() const;
};

/// Drives in order: effects as `practical_effects` and `practical_reading_effects` list them, those
/// without, as many of each kind, pairs, and those whose effect is left out of the catalogue. The
/// same for the same options, whatever the number of threads (but for `seconds`). Throws
/// StorageError, Interrupted.
[[nodiscard]] std::vector<StudiedDrive> run_diagnosis_study(const DiagnosisStudyOptions& options,
                                                            const Progress& progress = {});

/// Share of drives whose effect was in the set, by size over standard error.
struct PowerBin {
  double low = 0.0, high = 0.0;
  std::size_t drives = 0;
  std::size_t in_set = 0;
};

struct DiagnosisScore {
  std::size_t drives = 0, first = 0, in_set = 0, unnamed = 0, wrong = 0, further = 0;
  std::size_t doubted = 0;  ///< in the set, but something is said to be unexplained
  std::size_t strong = 0, strong_in_set = 0;  ///< size over standard error of 8 and more
  std::size_t intervals = 0, covered = 0;
  std::size_t set_members = 0, sets = 0;
  std::vector<double> gain_over_oracle;
  std::vector<double> z;  ///< error of each size over its standard error
  double seconds = 0.0;

  void add(const StudiedDrive& drive);
};

[[nodiscard]] std::vector<PowerBin> power_of(const std::vector<StudiedDrive>& drives);

}  // namespace roadbook
