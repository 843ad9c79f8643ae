#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/oracle.hpp"
#include "tests/diagnosis/hidden_effects/detector_injector.hpp"
#include "tests/diagnosis/hidden_effects/friction_injector.hpp"
#include "tests/diagnosis/hidden_effects/range_injector.hpp"

namespace roadbook::test {

/// Diagnosis of one drive with hidden effects of friction, range or detector.
struct ReadingOutcome {
  Secret secret;
  std::uint64_t seed = 0;
  Diagnosis found;
  OracleAnswer oracle;   ///< of one who knows the secret
  double seconds = 0.0;  ///< of processor time, from files to result

  [[nodiscard]] bool silent() const { return found.causes.empty() && found.unknown.empty(); }
  [[nodiscard]] bool named_first(const std::string& effect) const;
  [[nodiscard]] bool in_set(const std::string& effect) const;
  [[nodiscard]] const FoundCause* cause(const std::string& effect) const;
  [[nodiscard]] std::string to_line() const;
};

[[nodiscard]] ReadingOutcome run_friction(const FrictionSecret& hidden,
                                          const std::filesystem::path& folder,
                                          const std::vector<std::string>& without = {});
[[nodiscard]] ReadingOutcome run_range(const RangeSecret& hidden,
                                       const std::filesystem::path& folder,
                                       const std::vector<std::string>& without = {});
[[nodiscard]] ReadingOutcome run_detector(const DetectorSecret& hidden,
                                          const std::filesystem::path& folder,
                                          const std::vector<std::string>& without = {});

}  // namespace roadbook::test
