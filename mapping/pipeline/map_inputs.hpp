#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/pipeline/map_options.hpp"
#include "mapping/store/existing_map.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {

// What a map is made from, and how that compares with the map that is there.

/// Digest of everything that the checkpoints of a build depend on: drives, options, seed, and the
/// program itself. A newer program does not take up what an older one has begun.
[[nodiscard]] std::string checkpoint_key(const std::vector<Drive>& drives,
                                         const MapOptions& options);

/// Values of `map_meta` about the inputs of a map: options, seed, and the key of all inputs.
[[nodiscard]] std::map<std::string, std::string> inputs_meta(const std::vector<Drive>& drives,
                                                             const MapOptions& options);

/// The map at `file` with the new drives compared; empty if it does not exist. Throws BadInput if
/// the map is damaged, or if it has other drives and not `options.replace`.
[[nodiscard]] std::optional<ExistingMap> existing_map(const std::filesystem::path& file,
                                                      const std::vector<Drive>& drives,
                                                      const MapOptions& options);

/// Whether the map was made from exactly these drives, options, seed and version of the pipeline: a
/// build would end at the same content.
[[nodiscard]] bool is_built_from(const ExistingMap& existing,
                                 const std::filesystem::path& file,
                                 const std::vector<Drive>& drives,
                                 const MapOptions& options);

/// Tables of the existing map that the new one takes over (`tables_that_stay`). Warns if the map
/// continues with other options.
[[nodiscard]] std::vector<std::string> tables_to_keep(const ExistingMap& existing,
                                                      const std::filesystem::path& file,
                                                      const std::vector<Drive>& drives,
                                                      const MapOptions& options,
                                                      std::vector<Problem>& warnings);

/// True if `after` has exactly the poses and stamps of `before`, with the same measures and
/// cameras: layers made from the poses then stay valid.
[[nodiscard]] bool has_same_poses(const Map& before, const Map& after);

/// Values of `map_meta` for the map in `file`, extended by the one drive in `drives`.
[[nodiscard]] std::map<std::string, std::string> extension_meta(const std::filesystem::path& file,
                                                                const std::vector<Drive>& drives,
                                                                const MapOptions& options);

/// Values of `map_meta` for a map that a change makes from the one in `file`, in words or digests.
[[nodiscard]] std::map<std::string, std::string> meta_after(const std::filesystem::path& file,
                                                            const std::string& change);

/// Values of `map_meta` for the map in `file` after the drive with this digest was taken out.
[[nodiscard]] std::map<std::string, std::string> removal_meta(const std::filesystem::path& file,
                                                              const std::string& drive_digest);

/// Whether the map's last session came by extending it with the one drive in `drives` and these
/// options.
[[nodiscard]] bool is_extended_by(const std::filesystem::path& file,
                                  const std::vector<Drive>& drives,
                                  const MapOptions& options);

/// Whether the map's last session came by extending it, not by a build.
[[nodiscard]] bool was_extended(const std::filesystem::path& file);

/// Key of the checkpoints of an extension of the map with `map_digest`.
[[nodiscard]] std::string extension_checkpoint_key(const std::string& map_digest,
                                                   const std::vector<Drive>& drives,
                                                   const MapOptions& options);

/// The key of the checkpoints from which the map was extended last; empty if a build made it.
[[nodiscard]] std::string extension_of_build(const MapMeta& meta);

}  // namespace roadbook
