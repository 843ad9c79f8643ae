#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace roadbook {

// What was found wrong with the sensors of a place's drives, kept in its map: one run of
// `diagnose`, with all that is needed to make it again to the same numbers.
//
// Plain tables of the map: `diagnosis_runs` (run, drive, drive_digest, options, result) for the
// program, `diagnosis_ledger` (run, cause, size, interval, evidence, change, gain) for people.

struct LedgerRun {
  std::string drive;               ///< folder or log, relative to the map's folder
  std::string drive_digest;        ///< of the drive, or of the log's description
  nlohmann::ordered_json options;  ///< all that the result depends on
  nlohmann::ordered_json result;   ///< as `diagnose --json` prints it
};

/// All runs, in order; none where the map has no ledger. Throws BadInput for a damaged one.
[[nodiscard]] std::vector<LedgerRun> read_ledger(const std::filesystem::path& map);

/// Adds a run; its number, from 1. One transaction; the map is untouched if anything fails.
std::size_t add_to_ledger(const std::filesystem::path& map, const LedgerRun& run);

}  // namespace roadbook
