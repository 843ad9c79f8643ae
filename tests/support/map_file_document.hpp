#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/source_tree.hpp"

namespace roadbook::test {

/// The layers, tables and rasters that docs/reference/map_file.md lists.
struct MapFileDocument {
  /// Names of the columns, in order, by name of the layer or table.
  std::map<std::string, std::vector<std::string>> columns;
  std::set<std::string> rasters;
};

/// Returns the words of `cell` that stand in backticks.
inline std::vector<std::string> quoted_names(const std::string& cell) {
  std::vector<std::string> names;
  std::istringstream text(cell);
  std::string part;
  for (bool inside = false; std::getline(text, part, '`'); inside = !inside)
    if (inside) names.push_back(part);
  return names;
}

/// Returns the cells of a row of a Markdown table; empty for another line.
inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  if (line.rfind("| ", 0) != 0) return cells;
  std::istringstream text(line.substr(1));
  for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
  return cells;
}

/// Reads the document. Only tables whose head begins with `layer`, `raster` or `table` count.
inline MapFileDocument read_map_file_document() {
  MapFileDocument document;
  std::ifstream page(source_tree() / "docs" / "reference" / "map_file.md");
  std::string kind;
  for (std::string line; std::getline(page, line);) {
    const auto cells = cells_of(line);
    if (cells.empty() && line.rfind("|--", 0) != 0) kind.clear();
    if (cells.empty()) continue;
    const auto names = quoted_names(cells.front());
    if (names.empty()) kind = cells.front();
    for (const std::string& name : names) {
      if (kind == " raster ") document.rasters.insert(name);
      if (kind == " layer ") document.columns[name] = quoted_names(cells.at(2));
      if (kind == " table ") document.columns[name] = quoted_names(cells.at(1));
    }
  }
  return document;
}

}  // namespace roadbook::test
