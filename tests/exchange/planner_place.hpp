#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "tests/exchange/stored_speeds.hpp"
#include "tests/support/command_output.hpp"
#include "tests/support/source_tree.hpp"

// Shared code for tests of planner formats: a place with spaces and crossings, and independent
// checkers in Python.

namespace roadbook::test {

using Corners = std::vector<std::pair<double, double>>;

/// Adds a layer of labelled outlines, on the slope of DrivenPlace; ids count from `first_id`.
inline void add_outlines(const std::filesystem::path& map,
                         const std::string& name,
                         const std::vector<Corners>& outlines,
                         std::int64_t first_id = 17) {
  VectorLayer layer;
  layer.name = name;
  layer.type = GeometryType::kPolygonZ;
  layer.fields = {{"space", FieldType::kInteger}};
  for (const Corners& outline : outlines) {
    Feature feature;
    for (const auto& [x, y] : outline) feature.points.emplace_back(x, y, 0.02 * x, 0.0);
    feature.points.push_back(feature.points.front());
    feature.values = {first_id++};
    layer.features.push_back(std::move(feature));
  }
  MapUpdate update(map);
  update.write_layer(layer);
  update.commit();
}

/// Spaces of DrivenPlace: a row of four that share corners, east of the aisle at x = 35; one at an
/// angle west of it; one along the lower side of the ring; one far from any lane; one that is no
/// rectangle.
inline std::vector<Corners> spaces_of_place() {
  std::vector<Corners> spaces;
  for (int i = 0; i < 4; ++i) {
    const double y = 16.0 + 2.5 * i;
    spaces.push_back({{42.0, y}, {42.0, y + 2.5}, {37.0, y + 2.5}, {37.0, y}});
  }
  spaces.push_back({{33.0, 20.0}, {33.0, 22.8}, {28.67, 25.3}, {28.67, 22.5}});
  spaces.push_back({{50.0, 1.9}, {55.5, 1.9}, {55.5, 4.2}, {50.0, 4.2}});
  spaces.push_back({{50.0, 20.0}, {52.5, 20.0}, {52.5, 25.0}, {50.0, 25.0}});
  spaces.push_back({{24.0, 2.0}, {26.5, 2.0}, {26.5, 6.0}, {25.0, 7.0}, {24.0, 6.0}});
  return spaces;
}
constexpr int kLinkedSpaces = 6;

/// Crossings of DrivenPlace: across the aisle, and across the lower side of the ring in five
/// corners.
inline std::vector<Corners> crossings_of_place() {
  return {{{33.0, 30.0}, {37.0, 30.0}, {37.0, 33.0}, {33.0, 33.0}},
          {{15.0, -2.0}, {18.0, -2.0}, {18.0, 2.0}, {16.5, 2.4}, {15.0, 2.0}}};
}

/// A place with speeds, spaces and crossings in its map file. The file is a copy of one that is
/// made once for all tests of a program.
struct PlannerPlace : Stored {
  PlannerPlace() {
    static const Folder once;
    static const std::filesystem::path made = [] {
      const auto file = copy_of_map(stored_once().map, once);
      add_outlines(file, "parking_spaces", spaces_of_place());
      add_outlines(file, "crossings", crossings_of_place());
      return file;
    }();
    copy_of_map(made, folder);
  }
};

/// Adds rows of spaces along each lane: square to it, at an angle or parallel to it. The gaps
/// between the corners of neighbours are -3 to 3 cm. Adds a crossing over the middle of each lane.
inline void add_random_places(const std::filesystem::path& map,
                              const std::vector<LanePath>& paths,
                              std::uint64_t seed) {
  Random random(seed, "places");
  std::vector<Corners> spaces;
  std::vector<Corners> crossings;
  for (const LanePath& path : paths) {
    if (path.length_m < 16.0) continue;
    const PathCurve curve(path.path);
    const auto outline = [&](double s, double e, double turn, double deep, double wide) {
      const PathPoint at = curve.at(s);
      const Eigen::Vector2d away = (e > 0.0 ? 1.0 : -1.0) * at.left();
      const Eigen::Vector2d u = Eigen::Rotation2Dd(turn) * away;
      const Eigen::Vector2d v(-u.y(), u.x());
      const Eigen::Vector2d first = at.position + e * at.left() - 0.5 * wide * v;
      Corners corners;
      for (const auto& [a, b] : {std::pair{0.0, 0.0}, {deep, 0.0}, {deep, wide}, {0.0, wide}}) {
        const Eigen::Vector2d p = first + a * u + b * v;
        corners.emplace_back(p.x(), p.y());
      }
      return corners;
    };
    const int kind = static_cast<int>(random.below(3));
    const double e = (random.below(2) == 0 ? 1.0 : -1.0) * random.uniform(1.2, 3.0);
    for (int i = 0; i < 3; ++i) {
      const double gap = random.uniform(-0.03, 0.03);
      if (kind == 0) spaces.push_back(outline(6.0 + 2.5 * i, e, 0.0, 5.0, 2.5 + gap));
      if (kind == 1) spaces.push_back(outline(6.0 + 2.9 * i, e, 0.5, 5.0, 2.5 + gap));
      if (kind == 2) spaces.push_back(outline(6.0 + 6.0 * i, e, 0.0, 2.2, 5.5 + gap));
    }
    crossings.push_back(outline(0.5 * path.length_m, -2.0, 0.1, -4.0, 3.0));
  }
  add_outlines(map, "parking_spaces", spaces);
  add_outlines(map, "crossings", crossings, 1000);
}

/// Runs a Python script of this folder.
inline std::string run_script(const std::string& command, int* status = nullptr) {
  return output_of("python3 " + (source_tree() / "tests/exchange" / command).string(), status);
}

/// Breaks an exported file in each of the named ways, with one start of Python: the broken files
/// lie beside it under the names of their faults.
inline void break_export(const std::filesystem::path& file,
                         const std::vector<std::string>& faults) {
  std::string command = "break_export.py " + file.string() + " " + file.parent_path().string();
  for (const std::string& fault : faults) command += " " + fault;
  int status = -1;
  const std::string said = run_script(command, &status);
  ASSERT_EQ(status, 0) << said;
}

/// Lines that begin with a word, without it, split at blanks.
inline std::vector<std::vector<std::string>> lines_with(const std::string& text,
                                                        const std::string& word) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first != word) continue;
    lines.emplace_back();
    for (std::string one; words >> one;) lines.back().push_back(one);
  }
  return lines;
}

inline double number_in(const std::string& text) { return parse_double(text).value(); }

}  // namespace roadbook::test
