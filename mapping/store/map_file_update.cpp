#include <ogrsf_frmts.h>

#include <utility>

#include "base/error.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/layers/map_layers_poses.hpp"
#include "mapping/layers/map_layers_raster.hpp"
#include "mapping/layers/map_layers_table.hpp"
#include "mapping/layers/map_layers_vector.hpp"
#include "mapping/store/map_bytes.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_content.hpp"
#include "mapping/store/map_file_disk.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_seal.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {

struct MapUpdate::Impl {
  explicit Impl(const std::filesystem::path& map_file)
      : map(map_file), lock(existing_map_file(map_file)), copy(beside(map_file, ".new")) {
    try {
      copy_map_file(map, copy);
      content_time = utc_text(newest_session_ns(open_map_file(copy)));
    } catch (...) {
      std::error_code ignored;  // half a copy would keep a full disk full
      std::filesystem::remove(copy, ignored);
      throw;
    }
  }

  [[nodiscard]] SqlDatabase database() const {
    SqlDatabase opened(copy, SqlMode::kReadWrite);
    opened.run("PRAGMA synchronous = OFF");
    return opened;
  }

  std::filesystem::path map;
  MapLock lock;
  std::filesystem::path copy;
  std::string content_time;
  std::vector<AuditLine> lines;  ///< for the history, if anything changes
};

MapUpdate::MapUpdate(const std::filesystem::path& map) : impl_(std::make_unique<Impl>(map)) {}

MapUpdate::~MapUpdate() {
  if (!impl_) return;
  try {
    remove_database(impl_->copy);
  } catch (const Error&) {
    // The next change removes a remaining copy; a destructor cannot report.
  }
}

void MapUpdate::write_map(const Map& map) {
  if (const auto problems = map_problems(map); !problems.empty()) {
    Problem first = problems.front();
    first.file = impl_->map.string();
    throw Refused(to_line(first));
  }
  const bool had_points = MapLayers(impl_->copy).has("landmark_points");
  {
    const SqlDatabase database = impl_->database();
    SqlTransaction transaction(database);
    create_map_tables(database);
    write_map_tables(database, map);
    transaction.commit();
  }
  (void)remove(kBeforeTable);
  write_layer(pose_layer(map));
  if (had_points) write_layer(landmark_layer(map));
  register_sessions(impl_->database(), map);
  impl_->database().run("VACUUM");  // a smaller map has a smaller file
}

void MapUpdate::write_layer(const VectorLayer& layer) {
  const GdalScope scope(impl_->content_time);
  GdalDataset dataset = open_geopackage(scope, impl_->copy);
  write_vector_layer(scope, *dataset, layer);
  dataset.reset();
  scope.check(impl_->copy, layer.name);
}

void MapUpdate::write_raster(const std::string& name,
                             const std::filesystem::path& geotiff,
                             const RasterLayerOptions& options) {
  check_layer_name(name);
  (void)remove(name);
  write_geopackage_raster(impl_->copy, name, geotiff, options, impl_->content_time);
}

void MapUpdate::write_table(const PlainTable& table) {
  write_plain_table(impl_->database(), table);
}

bool MapUpdate::remove(const std::string& name) {
  check_plain_name(name);
  const auto count = [&](const char* sql) {
    const SqlDatabase database = impl_->database();
    SqlStatement row = database.prepare(sql);
    row.bind_text(1, name);
    return row.step() ? row.integer(0) : 0;
  };
  if (count("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?") == 0)
    return false;
  if (count("SELECT count(*) FROM gpkg_contents WHERE table_name = ?") == 0) {
    impl_->database().run("DROP TABLE " + sql_name(name));
    return true;
  }
  const GdalScope scope(impl_->content_time);
  GdalDataset dataset = open_geopackage(scope, impl_->copy);
  // GDAL's own statement: it also removes GDAL's other entries about the layer.
  const std::string sql = "DROP TABLE " + sql_name(name);
  dataset->ReleaseResultSet(dataset->ExecuteSQL(sql.c_str(), nullptr, nullptr));
  dataset.reset();
  scope.check(impl_->copy, "remove " + name);
  return true;
}

void MapUpdate::set_meta(const std::string& key, const std::string& value) {
  set_meta_value(impl_->database(), key, value);
}

void MapUpdate::set_drive_paths(const std::vector<std::string>& paths) {
  const SqlDatabase database = impl_->database();
  SqlStatement update =
      database.prepare("UPDATE session_places SET drive_path = ? WHERE session = ?");
  for (std::size_t s = 0; s < paths.size(); ++s)
    update.bind_text(1, paths[s]).bind(2, static_cast<std::int64_t>(s)).run();
}

void MapUpdate::note(const std::string& action, const std::string& detail) {
  impl_->lines.emplace_back(action, detail);
}

void MapUpdate::commit() {
  if (seal_changed_copy(impl_->copy, impl_->map, impl_->lines))
    replace_file(impl_->copy, impl_->map);
  else
    remove_database(impl_->copy);
  impl_.reset();
}

}  // namespace roadbook
