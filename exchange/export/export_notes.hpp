#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace roadbook {

/// Objects that an export leaves out, because the format cannot represent them.
struct ExportNote {
  std::string what;       ///< plural, e.g. "parking spaces"
  std::size_t count = 0;  ///< how many of them
  std::string why;        ///< the reason, and another format or profile that can hold them
};

using ExportNotes = std::vector<ExportNote>;

/// Appends a note if `count` is above 0.
inline void add_note(ExportNotes& notes, std::string what, std::size_t count, std::string why) {
  if (count > 0) notes.push_back({std::move(what), count, std::move(why)});
}

}  // namespace roadbook
