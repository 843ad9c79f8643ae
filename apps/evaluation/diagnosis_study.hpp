#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "apps/evaluation/hidden_drive.hpp"
#include "apps/evaluation/hidden_readings.hpp"
#include "base/progress.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/oracle.hpp"

namespace roadbook {

// The performance of the diagnosis on drives with known truth: the numbers of `roadbook evaluate
// diagnosis`.

struct DiagnosisStudyOptions {
  std::filesystem::path folder;  ///< holds the simulated drives during their diagnosis
  std::uint64_t seed = 1;
  std::size_t drives_an_effect = 8;
  std::size_t null_drives = 40;
  std::size_t lasting_drives = 0;     ///< for each correlation time of the reference's errors
  std::size_t pair_drives = 0;        ///< drives with two effects
  std::size_t removed_an_effect = 0;  ///< drives whose true cause is not in the catalogue
  double length_m = 300.0;            ///< of drives for the diagnosis of motion
  std::string only;      ///< prefixes of effect names ("a,b": a or b); selects these effects and
                         ///< their kinds
  bool readings = true;  ///< include friction, range and detector
  int num_threads = 1;
};

/// One drive: the hidden effect (empty name: none) and the diagnosis of its files.
struct StudiedDrive {
  HiddenKind kind = HiddenKind::kMotion;
  std::string effect;
  double size = 0.0;
  EffectSizes beside;  ///< the second effect of a pair
  LastingReference reference;
  bool removed = false;  ///< the effect is left out of the catalogue
  OracleAnswer oracle;
  Diagnosis found;
  double seconds = 0.0;  ///< processor time of the diagnosis alone

  [[nodiscard]] bool named_first() const;
  [[nodiscard]] bool in_set() const;  ///< first, or in the confounded set of the first
  [[nodiscard]] bool silent() const { return found.causes.empty() && found.unknown.empty(); }
  /// For a drive without an effect: something is named. That errors of the reference correlate is
  /// right where they do.
  [[nodiscard]] bool raises_alarm() const;
  /// Each hidden effect is named, or is in the confounded set of a named one.
  [[nodiscard]] bool all_named() const;
  /// A confident name without any flag. It is wrong if the true cause is not in the catalogue.
  [[nodiscard]] bool unflagged() const {
    return !found.causes.empty() && found.unknown.empty() && found.unexplained.empty();
  }
  /// For a drive whose effect is not in the catalogue: the true effect fits better than the answer
  /// by less than the limit of a confounded set, so that no method could separate them.
  [[nodiscard]] bool is_indistinguishable() const {
    return oracle.gain - found.fit_gain < kConfoundedLoss;
  }
  /// First name, "unknown: HOOK ~ COVARIATE", or "nothing".
  [[nodiscard]] std::string answer() const;
  /// The finding of the hidden effect, or null.
  [[nodiscard]] const FoundCause* finding() const;
};

/// Runs the study and returns the drives in order: the effects in the order of `practical_effects`
/// and `practical_reading_effects`, the null drives of each kind, the pairs, and the drives whose
/// effect is not in the catalogue. The same options give the same result for any number of threads
/// (except `seconds`). Throws StorageError, Interrupted.
[[nodiscard]] std::vector<StudiedDrive> run_diagnosis_study(const DiagnosisStudyOptions& options,
                                                            const Progress& progress = {});

/// True for effects that change the scatter of readings and no mean.
[[nodiscard]] bool is_noise_effect(const std::string& effect);

/// The share of drives whose effect was in the set, for a range of size over standard error.
struct PowerBin {
  double low = 0.0, high = 0.0;
  std::size_t drives = 0;
  std::size_t in_set = 0;
};

struct DiagnosisScore {
  std::size_t drives = 0, first = 0, in_set = 0, unnamed = 0, wrong = 0, further = 0;
  std::size_t doubted = 0;  ///< in the set, but the diagnosis also reports an unexplained rest
  std::size_t strong = 0, strong_in_set = 0;  ///< size of at least 8 standard errors
  std::size_t intervals = 0, covered = 0;
  std::size_t set_members = 0, sets = 0;
  std::vector<double> gain_over_oracle;
  std::vector<double> z;  ///< error of each size over its standard error
  double seconds = 0.0;

  void add(const StudiedDrive& drive);
};

[[nodiscard]] std::vector<PowerBin> power_of(const std::vector<StudiedDrive>& drives);

}  // namespace roadbook
