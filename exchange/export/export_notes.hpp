#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace roadbook {

/// What an export leaves out, because its format has no place for it.
struct ExportNote {
  std::string what;       ///< plural, e.g. "parking spaces"
  std::size_t count = 0;  ///< how many of them
  std::string why;        ///< and what holds them, where another format or profile does
};

using ExportNotes = std::vector<ExportNote>;

/// Appends a note where `count` is above 0.
inline void add_note(ExportNotes& notes, std::string what, std::size_t count, std::string why) {
  if (count > 0) notes.push_back({std::move(what), count, std::move(why)});
}

}  // namespace roadbook
