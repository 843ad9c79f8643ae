#pragma once

#include <filesystem>

namespace roadbook {

// Steps that make a finished file replace the old one whole or not at all. All throw StorageError.

/// The file that a symbolic link, or a chain of them, names; `path` itself if it is none. The file
/// need not exist. Throws StorageError for links in a circle.
[[nodiscard]] std::filesystem::path linked_file(std::filesystem::path path);

/// Removes a file and SQLite's journal of it; missing files are no error.
void remove_database(const std::filesystem::path& file);

/// Flushes `file` to the disk, renames it over `target` and flushes the folder. A symbolic link
/// stays: the file that it names is replaced.
void replace_file(const std::filesystem::path& file, const std::filesystem::path& target);

/// Rolls back an unfinished change of a killed writer in `file` (its hot journal). A journal must
/// not remain, or SQLite would apply it to the next file of this name.
void recover_database(const std::filesystem::path& file);

}  // namespace roadbook
