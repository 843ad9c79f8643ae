#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/pipeline/build_map.hpp"
#include "mapping/store/existing_map.hpp"

namespace roadbook {

// What a map is made from, and how that compares with the map that is there.

/// Digest of everything that the checkpoints of a build depend on: drives, options, seed, version
/// of the pipeline.
[[nodiscard]] std::string inputs_key(const std::vector<Drive>& drives, const MapOptions& options);

/// What `map_meta` says of the inputs of a map made so: options, seed and the key of all inputs.
[[nodiscard]] std::map<std::string, std::string> inputs_meta(const std::vector<Drive>& drives,
                                                             const MapOptions& options);

/// The map at `file` beside the drives; empty where there is none. Throws BadInput for a map that
/// is damaged, and for one of other drives unless `options.replace`.
[[nodiscard]] std::optional<ExistingMap> existing_map(const std::filesystem::path& file,
                                                      const std::vector<Drive>& drives,
                                                      const MapOptions& options);

/// Whether the map was made from exactly these drives, options, seed and version of the program,
/// and no build of it waits to be finished: a build would end at the same content.
[[nodiscard]] bool is_built_from(const ExistingMap& existing,
                                 const std::filesystem::path& file,
                                 const std::vector<Drive>& drives,
                                 const MapOptions& options);

/// Tables of the map that is there which the new one takes over (`tables_that_stay`). Warns where
/// the map goes on with other options.
[[nodiscard]] std::vector<std::string> tables_to_keep(const ExistingMap& existing,
                                                      const std::filesystem::path& file,
                                                      const std::vector<Drive>& drives,
                                                      const MapOptions& options,
                                                      std::vector<Problem>& warnings);

/// Whether vehicles stand in `after` exactly where and when they stood in `before`, with the same
/// measures and cameras: what was made from the poses is then right as it is.
[[nodiscard]] bool has_same_poses(const Map& before, const Map& after);

}  // namespace roadbook
