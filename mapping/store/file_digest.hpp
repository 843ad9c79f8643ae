#pragma once

#include <filesystem>
#include <string>

#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

// The digest of the bytes of a map file, room between rows included, which the digests of tables do
// not cover. It stands in `map_meta` of the file itself: its own digits count as zeros, and so do
// the fields of SQLite's header that change when another program has opened the file (journal mode,
// change counter, version of SQLite). A change in place (an event) drops it.

inline constexpr const char* kFileDigestKey = "digest_of_file";

/// Reserves the place of the digest in `map_meta`. To be called last in the transaction that seals
/// the file.
void reserve_file_digest(const SqlDatabase& database);

/// Writes the digest into its place, once all connections to the file are closed. Throws
/// StorageError.
void write_file_digest(const std::filesystem::path& file);

/// Whether the bytes of the file are those that were sealed; also true without a stored digest.
/// Throws StorageError if the file cannot be read.
[[nodiscard]] bool has_sealed_bytes(const std::filesystem::path& file, const std::string& stored);

}  // namespace roadbook
