#pragma once

#include <cstddef>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "exchange/export/export_notes.hpp"

namespace roadbook::test {

using SumoLines = std::map<std::string, std::vector<std::string>>;

/// Lines of the checker by their first word.
inline SumoLines sumo_lines(const std::string& text) {
  SumoLines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const auto blank = line.find(' ');
    lines[line.substr(0, blank)].push_back(blank == std::string::npos ? ""
                                                                      : line.substr(blank + 1));
  }
  return lines;
}

/// The number of objects that the notes name `what`.
inline std::size_t count_noted(const ExportNotes& notes, const std::string& what) {
  for (const ExportNote& note : notes)
    if (note.what == what) return note.count;
  return 0;
}

}  // namespace roadbook::test
