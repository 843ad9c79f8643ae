#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/messages.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "workflows/diagnosis/diagnosis_run.hpp"

namespace roadbook {

/// Holds the map from before a diagnosis reads it until its run is in the ledger: the run belongs
/// to the map that it has read. Throws BadInput without a map, StorageError if the map is locked.
[[nodiscard]] std::unique_ptr<MapHold> hold_ledger(const std::filesystem::path& map);

/// Adds a run to the ledger of `map`. Returns its number, from 1. Throws as `add_to_ledger`.
std::int64_t keep_in_ledger(const std::filesystem::path& map,
                            const DiagnosisRequest& request,
                            const DiagnosisRun& run);

/// A repeated run of the ledger.
struct RepeatedRun {
  Diagnosis diagnosis;
  bool is_same = false;    ///< all numbers agree
  std::string difference;  ///< why they differ; empty where they agree
};

/// Repeats run `number` (from 1) of the ledger of `map`. Throws InvalidOption if the ledger has no
/// such run, and BadInput if the drive has changed since.
[[nodiscard]] RepeatedRun repeat_ledger_run(const std::filesystem::path& map,
                                            int number,
                                            int num_threads,
                                            Messages& messages);

/// Throws InvalidOption if a name in `--without` is not an effect. Such a name would leave nothing
/// out.
void check_effects_left_out(const std::vector<std::string>& names);

}  // namespace roadbook
