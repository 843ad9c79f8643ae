#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

/// Diagnosis of one drive with hidden effects.
struct Outcome {
  HiddenDriveOptions hidden;
  Diagnosis found;
  double strength = 0.0;     ///< size over its standard error, of the strongest hidden effect
  double oracle_gain = 0.0;  ///< [nats] of the true model over the nominal one; named effects only
  double seconds = 0.0;      ///< of processor time, from streams to result

  [[nodiscard]] bool named_first(const std::string& effect) const;
  /// True if `effect` is the first one found or in its equivalence set.
  [[nodiscard]] bool in_set(const std::string& effect) const;
  [[nodiscard]] const FoundCause* cause(const std::string& effect) const;
  /// True if the report has an unknown with one of the right streams and covariates.
  [[nodiscard]] bool unknown_but_right(const OutsideEffect& outside) const;
  [[nodiscard]] std::string to_line() const;
};

/// Records a drive, writes it to `folder` and diagnoses the files. `without`: effects left out of
/// the catalogue. Asks no oracle, which would take a third of the time: strength and gain are 0.
[[nodiscard]] Outcome diagnose_hidden(const HiddenDriveOptions& hidden,
                                      const std::filesystem::path& folder,
                                      const std::vector<std::string>& without = {});
/// The same with the oracle's answer.
[[nodiscard]] Outcome run_hidden(const HiddenDriveOptions& hidden,
                                 const std::filesystem::path& folder,
                                 const std::vector<std::string>& without = {});

}  // namespace roadbook::test
