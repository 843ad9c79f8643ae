#pragma once

#include <filesystem>

namespace roadbook {

// Steps that make a finished file replace the old one whole or not at all. All throw StorageError.

/// Removes a file and SQLite's journal of it; missing files are no error.
void remove_database(const std::filesystem::path& file);

/// Flushes `file` to the disk, renames it over `target` and flushes the folder.
void replace_file(const std::filesystem::path& file, const std::filesystem::path& target);

/// Rolls back an unfinished change of a killed writer in `file` (its hot journal). A journal must
/// not remain, or SQLite would apply it to the next file of this name.
void recover_database(const std::filesystem::path& file);

}  // namespace roadbook
