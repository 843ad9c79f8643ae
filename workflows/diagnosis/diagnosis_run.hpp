#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/messages.hpp"
#include "diagnosis/inference/findings.hpp"
#include "sensors/effects.hpp"
#include "workflows/diagnosis/advice.hpp"

namespace roadbook {

/// All inputs of a diagnosis except the data.
struct DiagnosisRequest {
  std::filesystem::path drive;                ///< folder of a drive, or YAML of a plain log
  std::filesystem::path map;                  ///< its views are diagnosed too; empty: no map
  EffectSizes known;                          ///< part of the model already
  std::vector<std::string> without;           ///< effects left out of the catalogue
  std::vector<std::filesystem::path> more{};  ///< further drives of the same vehicle
  bool compare = false;                       ///< with the simulation of the same drive
};

struct DiagnosisRun {
  Diagnosis diagnosis;
  std::string name;                       ///< of the drive, for people
  std::string digest;                     ///< of the drive, or of the log's description
  std::optional<StatedVehicle> stated{};  ///< empty: without wheels, or several drives
};

/// Runs a diagnosis. The result is the same for any number of threads (0: all cores). Throws
/// BadInput, StorageError, Interrupted.
[[nodiscard]] DiagnosisRun run_diagnosis(const DiagnosisRequest& request,
                                         int num_threads,
                                         Messages& messages);

}  // namespace roadbook
