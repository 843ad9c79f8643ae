#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace roadbook {

// What was found wrong with the sensors of a place's drives, kept in its map (table
// `diagnosis_events`): each run of `diagnose` with its cause, evidence, change and gain, and with
// all that is needed to make it again to the same numbers.

struct LedgerRun {
  std::string drive;               ///< folder or log, relative to the map's folder
  std::string drive_digest;        ///< of the drive, or of the log's description and files
  nlohmann::ordered_json options;  ///< all inputs of the result except drive and map
  nlohmann::ordered_json result;   ///< as `diagnose --json` prints it
  std::string map_digest{};        ///< `viewed_content` of a run through the map; empty: not kept
};

/// Digest of what a run through the map reads of it: cameras, poses, landmarks and their views; not
/// labels, layers and the ledger itself. Throws as `load_meta`.
[[nodiscard]] std::string viewed_content(const std::filesystem::path& map);

/// All runs, in order; none where the map has no ledger. Throws BadInput for a damaged one.
[[nodiscard]] std::vector<LedgerRun> read_ledger(const std::filesystem::path& map);

/// Adds a run; its number, from 1. One transaction; the map is untouched if anything fails.
std::int64_t add_to_ledger(const std::filesystem::path& map, const LedgerRun& run);

/// A line for each cause of a run: "wheels0.radius = 0.0121 1 (0.0118 to 0.0124), gain 311 nats;
/// change: effects: wheels0.radius: 0.0121".
[[nodiscard]] std::vector<std::string> ledger_lines(const LedgerRun& run);

}  // namespace roadbook
