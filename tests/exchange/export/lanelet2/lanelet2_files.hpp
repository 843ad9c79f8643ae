#pragma once

#include <filesystem>
#include <string>

#include "exchange/export/export_map.hpp"
#include "tests/exchange/planner_place.hpp"
#include "tests/exchange/planner_routes.hpp"

namespace roadbook::test {

inline const GeoOrigin kPlaceOnEarth{47.3769, 8.5417, 30.0};

/// Runs the checker on a file; `status` is its exit status.
inline std::string check_osm(const std::filesystem::path& file,
                             const std::string& profile,
                             int* status) {
  return run_script("check_lanelet2.py " + file.string() + " 47.3769 8.5417 " + profile, status);
}

/// Exports a map in a profile of Lanelet2 beside it.
inline std::filesystem::path written(const std::filesystem::path& map,
                                     const std::string& profile,
                                     ExportNotes* notes = nullptr) {
  ExportOptions options;
  options.origin = kPlaceOnEarth;
  options.profile = profile;
  const auto out = map.parent_path() / (profile + ".osm");
  export_map(map, "lanelet2", out, options, notes);
  return out;
}

/// The problems in the output of the checker, a line each.
inline std::string problems_of(const std::string& text) {
  std::string problems;
  for (const auto& words : lines_with(text, "problem")) {
    for (const std::string& word : words) problems += word + " ";
    problems += "\n";
  }
  return problems;
}

}  // namespace roadbook::test
