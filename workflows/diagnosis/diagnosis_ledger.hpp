#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace roadbook {

// The ledger of the diagnoses of a place's drives, stored in its map (table `diagnosis_events`). It
// has each run of `diagnose` with its cause, evidence, change and gain. It also has all inputs
// needed to repeat the run with the same numbers.

struct LedgerRun {
  std::string drive;               ///< folder or log, relative to the map's folder
  std::string drive_digest;        ///< of the drive, or of the log's description and files
  nlohmann::ordered_json options;  ///< all inputs of the result except drive and map
  nlohmann::ordered_json result;   ///< as `diagnose --json` prints it
  std::string map_digest{};        ///< `viewed_content` of a run through the map; empty: not kept
};

/// Returns the digest of the parts of a map that a run reads: cameras, poses, landmarks and their
/// views. Labels, layers and the ledger are not part of it. Throws as `load_meta`.
[[nodiscard]] std::string viewed_content(const std::filesystem::path& map);

/// Returns all runs in order. Empty if the map has no ledger. Throws BadInput for a damaged ledger.
[[nodiscard]] std::vector<LedgerRun> read_ledger(const std::filesystem::path& map);

/// Adds a run and returns its number, from 1. The function uses one transaction, so that the map
/// does not change if anything fails.
std::int64_t add_to_ledger(const std::filesystem::path& map, const LedgerRun& run);

/// Returns one line for each cause of a run: "wheels0.radius = 0.0121 1 (0.0118 to 0.0124), gain
/// 311 nats; change: effects: wheels0.radius: 0.0121".
[[nodiscard]] std::vector<std::string> ledger_lines(const LedgerRun& run);

}  // namespace roadbook
