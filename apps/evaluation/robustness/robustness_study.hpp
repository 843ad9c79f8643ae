#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/evaluation/robustness/drive_fault.hpp"
#include "base/progress.hpp"

namespace roadbook {

// What `map` does with damaged recordings. The study simulates a drive, damages its files, maps the
// damaged drive and compares the error with that of the clean drive.

/// The drive to damage.
struct RobustnessDrive {
  std::string scenario = "zurich";
  std::string size = "small";
  double image_scale = 0.5;
  double seconds = 0.0;  ///< 0: complete
};

/// What `map` made of one damaged drive.
enum class RobustnessOutcome {
  kRight,    ///< error at most 1.5 times that of the clean drive, at least 80 % of its keyframes
  kRefused,  ///< no map, and the message names the sensor
  kRefusedElse,  ///< no map, and the message names another thing
  kWrongSaid,    ///< a wrong map, with a warning that names the sensor
  kWrongSilent,  ///< a wrong map, without one
};

struct RobustnessRun {
  std::string fault;
  std::uint64_t seed = 0;
  RobustnessOutcome outcome = RobustnessOutcome::kRight;
  bool is_named = false;              ///< a message names the sensor
  bool names_cause = false;           ///< a message names the sensor and the cause
  double error_ratio = 0.0;           ///< to the clean drive's median error; NaN without a map
  double mapped_share = 0.0;          ///< keyframes, relative to those of the clean drive
  std::vector<std::string> messages;  ///< that the clean drive does not give, one line each
};

/// What the clean drive of a seed gave.
struct CleanRun {
  std::uint64_t seed = 0;
  double error_m = 0.0;  ///< median against the truth, SE(3) aligned
  std::size_t keyframes = 0;
  std::vector<std::string> messages;  ///< warnings
};

struct RobustnessResult {
  CleanRun clean;
  std::vector<RobustnessRun> runs;  ///< one a fault
};

/// Damages and maps one drive with each of the faults. Deterministic. Throws the exceptions of
/// `simulate`, and those of `map_drives` for the clean drive.
[[nodiscard]] RobustnessResult study_robustness(const RobustnessDrive& drive,
                                                const std::vector<DriveFault>& faults,
                                                std::uint64_t seed,
                                                int num_threads,
                                                const Progress& progress = {});

/// "right", "refused", ...
[[nodiscard]] std::string name_of(RobustnessOutcome outcome);

}  // namespace roadbook
