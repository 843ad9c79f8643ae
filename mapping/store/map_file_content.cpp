#include "mapping/store/map_file_content.hpp"

#include <ogrsf_frmts.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/layers/map_layers_poses.hpp"
#include "mapping/layers/map_layers_vector.hpp"
#include "mapping/store/map_file_disk.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {
namespace {

std::string content_time(const Map& map) {
  std::int64_t newest = 0;
  for (const Session& session : map.sessions) newest = std::max(newest, session.t_end_ns);
  return utc_text(newest);
}

void write_layers(const std::filesystem::path& file,
                  const Map& map,
                  bool landmark_points,
                  const std::vector<VectorLayer>& more) {
  const GdalScope scope(content_time(map));
  GdalDataset dataset =
      std::filesystem::exists(file) ? open_geopackage(scope, file) : create_geopackage(scope, file);
  write_vector_layer(scope, *dataset, pose_layer(map));
  if (landmark_points) write_vector_layer(scope, *dataset, landmark_layer(map));
  for (const VectorLayer& layer : more) write_vector_layer(scope, *dataset, layer);
  // Spatial indices and extents are written on closing.
  dataset.reset();
  scope.check(file, "layers");
}

// A build that was killed at its very end and is run again has one entry: the content is that of
// one build.
void note_build(const SqlDatabase& database, const Map& map) {
  const std::string detail = std::to_string(map.sessions.size()) + " sessions, " +
                             std::to_string(map.keyframes.size()) + " keyframes, " +
                             std::to_string(map.landmarks.size()) + " landmarks";
  const std::string newest =
      database.value("SELECT action || ': ' || detail FROM audit ORDER BY id DESC LIMIT 1");
  if (newest != "map: " + detail) add_audit(database, "map", detail);
}

}  // namespace

void write_map_content(const std::filesystem::path& file,
                       const Map& map,
                       const std::map<std::string, std::string>& meta,
                       const MapFinishOptions& options) {
  const bool landmark_points = map.landmarks.size() <= options.max_landmark_points;
  write_layers(file, map, landmark_points, options.layers);

  const SqlDatabase database(file, SqlMode::kReadWrite);
  database.run("PRAGMA synchronous = OFF");  // flushed as a whole before it takes its place
  SqlTransaction transaction(database);
  create_map_tables(database);
  write_map_tables(database, map);
  set_meta_value(database, "state", "part");
  set_meta_value(database, "crs_wkt", map_crs_wkt());
  set_meta_value(database, "landmark_points", landmark_points ? "all" : "left out: too many");
  for (const auto& [key, value] : meta) set_meta_value(database, key, value);
  note_build(database, map);
  register_sessions(database, map);
  transaction.commit();
}

void register_sessions(const SqlDatabase& database, const Map& map) {
  const std::string newest = content_time(map);  // outlives the statement it is bound to
  database
      .prepare(
          "INSERT OR REPLACE INTO gpkg_contents(table_name, data_type, identifier, description, "
          "last_change) VALUES('sessions', 'attributes', 'sessions', 'Drives in the map', ?)")
      .bind_text(1, newest)
      .run();
}

void copy_map_file(const std::filesystem::path& map, const std::filesystem::path& file) {
  const SqlDatabase source = open_verified(map);
  // A reader's lock keeps writers away until the copy is made.
  source.run("BEGIN; SELECT count(*) FROM map_meta");
  remove_database(file);
  std::error_code error;
  std::filesystem::copy_file(map, file, error);
  if (error)
    throw StorageError(to_line({Severity::kError, file.string(), 0, "copy",
                                write_fault(file, error.value()), "room on its disk"}));
}

}  // namespace roadbook
