#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// The result of `roadbook check MAP`.
struct MapReport {
  std::vector<Problem> problems;
  std::string digest;                       ///< empty where the file could not be read
  std::map<std::string, std::size_t> rows;  ///< of every table
};

/// Checks file, digests, schema, R-trees and content. The check ends at the first wrong digest.
/// Damage is reported, not thrown: only a disk that
/// cannot be read or a lock throws (StorageError).
[[nodiscard]] MapReport check_map(const std::filesystem::path& path);

/// Returns contradictions in a map, at most `limit`: ids without target, matrices that are no
/// rotations, values that are not finite, keyframes out of order, map frames without a keyframe.
[[nodiscard]] std::vector<Problem> map_problems(const Map& map, std::size_t limit = 20);

}  // namespace roadbook
