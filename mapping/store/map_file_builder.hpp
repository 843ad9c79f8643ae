#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/map.hpp"
#include "mapping/store/map_finish_options.hpp"

namespace roadbook {

/// Builds a map stage by stage in MAP.part: a saved stage survives a kill.
/// `finish` renames the finished file over MAP, which stays unchanged until then. The file is
/// assembled as MAP.new, so that the checkpoints stay complete until the map is in place.
class MapFileBuilder {
 public:
  /// Opens or creates MAP.part and locks it against other builders (StorageError if another one
  /// works). Checkpoints are used if they were made for the same `inputs_key` (a hash over the
  /// drives' digests, options, seed, version). Otherwise, or if they are damaged, the build starts
  /// from the beginning, with a warning in `warnings`.
  MapFileBuilder(std::filesystem::path map, std::string_view inputs_key);
  ~MapFileBuilder();
  MapFileBuilder(const MapFileBuilder&) = delete;
  MapFileBuilder& operator=(const MapFileBuilder&) = delete;

  /// Stages completed so far, in the order they were saved.
  [[nodiscard]] const std::vector<std::string>& stages() const;
  [[nodiscard]] bool has(std::string_view stage) const;
  /// What was dropped on opening: warnings about MAP.part.
  [[nodiscard]] const std::vector<Problem>& warnings() const;

  /// A blob of a completed stage; asking for one that was not saved is our own mistake.
  [[nodiscard]] std::string load(std::string_view stage, std::string_view name) const;
  /// Saves the stage whole, in one transaction. Blobs may have hundreds of megabytes.
  void save(std::string_view stage, const std::map<std::string, std::string>& blobs);

  /// Writes tables, layers and meta of `map`, digests them, puts the file in MAP's place and
  /// removes MAP.part. `meta`: sources and their hashes, options, seed, ...; keys that begin with
  /// `place.` hold what belongs to this machine and are not part of the content digest.
  ///
  /// Throws Refused for a map that contradicts itself (`map_problems`), StorageError where the disk
  /// does not take it; MAP and the checkpoints are then as before. The build must not be used after
  /// success.
  void finish(const Map& map,
              const std::map<std::string, std::string>& meta,
              const MapFinishOptions& options = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
