#pragma once

#include <filesystem>

#include "mapping/store/map_file_digest.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// Throws BadInput of one fault of a file.
[[noreturn]] void refuse_file(const std::filesystem::path& path,
                              const std::string& field,
                              const std::string& got,
                              const std::string& want);

/// Returns `path`, if it is an existing file; throws BadInput otherwise. To be called before the
/// map is locked, so that a wrong name leaves no lock file.
[[nodiscard]] const std::filesystem::path& existing_map_file(const std::filesystem::path& path);

/// Opens a map file for reading: it exists, SQLite finds no fault in its pages, its schema version
/// is known, its state is complete. Digests are not compared. Throws BadInput, StorageError.
[[nodiscard]] SqlDatabase open_map_file(const std::filesystem::path& path);

/// The same, with all digests verified. A file that this process has verified and that has not
/// changed since (inode, size and times) is not read again.
[[nodiscard]] SqlDatabase open_verified(const std::filesystem::path& path);

/// The same as open_map_file, without a look at all pages: registries are verified
/// (verify_registries), and a reader calls verify_table before it reads a table. What is not read
/// may be damaged.
[[nodiscard]] SqlDatabase open_registries(const std::filesystem::path& path);

/// `map_meta` of an open file; empty where there is no such key.
[[nodiscard]] std::string meta_value(const SqlDatabase& database, const std::string& key);
void set_meta_value(const SqlDatabase& database, const std::string& key, const std::string& value);

/// A line in the history (`audit`).
void add_audit(const SqlDatabase& database, const std::string& action, const std::string& detail);

/// Stamp of the newest session's end [ns]; 0 without sessions.
[[nodiscard]] std::int64_t newest_session_ns(const SqlDatabase& database);

}  // namespace roadbook
