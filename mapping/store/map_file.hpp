#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "mapping/layers/map_layers.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// The map file (docs/reference/map_file.md): one GeoPackage that holds struct Map, the layers drawn
// from it and what else is known of the place. Layout of the file:
// mapping/store/map_file_tables.hpp.
//
// Files are opened defensively. Opening throws BadInput for a file that is missing, damaged, not
// complete or of a schema this program does not know; StorageError for permission, disk and locks.

/// Meta data of a map file.
struct MapMeta {
  int schema_version = 0;
  std::string state;   ///< "complete" for a finished map
  std::string digest;  ///< as stored; see `map_digest`
  std::map<std::string, std::string> table_digests;
  /// Everything else: what was passed to `MapFileBuilder::finish`, the coordinate system, ...
  std::map<std::string, std::string> values;
};

/// The map, after all digests have been found right. Observations come keyframe by keyframe.
/// Corners that no landmark explains stay in the file: only the extension of a map uses them.
[[nodiscard]] Map load_map(const std::filesystem::path& path);

/// The same, with these corners.
[[nodiscard]] Map load_map_with_corners(const std::filesystem::path& path);

/// The sessions alone, without their cameras and wheels: quick, digests are not checked.
[[nodiscard]] std::vector<Session> load_sessions(const std::filesystem::path& path);

/// The meta table alone, verified: quick, other tables are not read.
[[nodiscard]] MapMeta load_meta(const std::filesystem::path& path);

/// Digest over the content of all tables, computed and compared with the stored ones. The same
/// content has the same digest, wherever the file lies and however its pages are laid out.
[[nodiscard]] std::string map_digest(const std::filesystem::path& path);

/// A change of a finished map: works on a copy that replaces MAP when it is whole.
///
/// Until `commit` MAP is untouched; without it the copy is dropped. Holds the builders' lock.
class MapUpdate {
 public:
  /// Verifies and copies MAP. Throws StorageError where another process is changing it.
  explicit MapUpdate(const std::filesystem::path& map);
  ~MapUpdate();
  MapUpdate(const MapUpdate&) = delete;
  MapUpdate& operator=(const MapUpdate&) = delete;

  /// Replaces the map itself: the private tables, and the layers of poses and landmarks. Throws
  /// Refused for a map that contradicts itself (`map_problems`).
  void write_map(const Map& map);
  /// Creates the layer, or replaces the one of that name.
  void write_layer(const VectorLayer& layer);
  /// Creates or replaces a raster layer from a GeoTIFF (see mapping/layers/map_layers.hpp).
  void write_raster(const std::string& name,
                    const std::filesystem::path& geotiff,
                    const RasterLayerOptions& options = {});
  /// Creates or replaces a plain table, which GIS programs do not show. Roadbook's own are refused.
  void write_table(const PlainTable& table);
  /// Removes a layer or plain table; false if it does not exist.
  bool remove(const std::string& name);
  /// Value in `map_meta`; keys that begin with `place.` are not part of the content digest.
  void set_meta(const std::string& key, const std::string& value);
  /// Where the drives of the sessions are now, in their order, relative to the map's folder where
  /// possible. Not part of the content digest.
  void set_drive_paths(const std::vector<std::string>& paths);
  /// A line in the history of the map, which `commit` adds if anything has changed.
  void note(const std::string& action, const std::string& detail);

  /// Digests, syncs and renames over MAP. An update that changed nothing leaves MAP as it is, to
  /// the byte. The update must not be used afterwards.
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
