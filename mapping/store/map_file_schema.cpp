#include <array>
#include <string_view>

#include "mapping/store/map_file_tables.hpp"

namespace roadbook {
namespace {

struct TableSql {
  std::string_view name;
  std::string_view columns;
};

// STRICT: a text in a column of numbers is an error. All keys are row ids: no index that a flipped
// bit could set against its table.
constexpr std::array<TableSql, 15> kTables{{
    {"sessions",
     "id INTEGER PRIMARY KEY, name TEXT NOT NULL, drive_digest TEXT NOT NULL, "
     "wheel_scale REAL NOT NULL, wheel_scale_sigma REAL, scale_source TEXT NOT NULL, "
     "scale_sigma REAL, t_begin_ns INTEGER NOT NULL, t_end_ns INTEGER NOT NULL, "
     "localised_share REAL"},
    {"session_places", "session INTEGER PRIMARY KEY, drive_path TEXT NOT NULL"},
    {"cameras",
     "id INTEGER PRIMARY KEY, session INTEGER NOT NULL, camera INTEGER NOT NULL, "
     "name TEXT NOT NULL, model TEXT NOT NULL, width INTEGER NOT NULL, height INTEGER NOT NULL, "
     "max_angle_rad REAL NOT NULL, time_offset_s REAL NOT NULL, parameters BLOB NOT NULL, "
     "T_vehicle_camera BLOB NOT NULL, exposed_after_s REAL, rolling_shutter_s REAL"},
    {"wheel_models",
     "session INTEGER PRIMARY KEY, radius_left_m REAL NOT NULL, radius_right_m REAL NOT NULL, "
     "track_width_m REAL NOT NULL, wheelbase_m REAL NOT NULL, steering_ratio REAL NOT NULL, "
     "ticks_per_turn REAL NOT NULL, time_offset_s REAL NOT NULL, "
     "sigma_distance_per_sqrt_m REAL NOT NULL, sigma_heading_per_sqrt_m REAL NOT NULL, "
     "sigma_lateral_per_sqrt_m REAL NOT NULL, sigma_angle_rad REAL NOT NULL"},
    {"vehicles",
     "session INTEGER PRIMARY KEY, source TEXT NOT NULL, length_m REAL, width_m REAL, "
     "height_m REAL, rear_overhang_m REAL, wheelbase_m REAL, track_width_m REAL"},
    {"map_frames", "id INTEGER PRIMARY KEY, T_map_frame BLOB NOT NULL"},
    {"keyframes",
     "id INTEGER PRIMARY KEY, session INTEGER NOT NULL, t_ns INTEGER NOT NULL, "
     "drive_frame INTEGER NOT NULL, map_frame INTEGER NOT NULL, T_frame_vehicle BLOB NOT NULL, "
     "covariance BLOB, travelled_m REAL NOT NULL, reversing INTEGER NOT NULL, "
     "after_gap INTEGER NOT NULL, piece INTEGER NOT NULL"},
    {"keyframe_motions",
     "keyframe INTEGER PRIMARY KEY, motion BLOB NOT NULL, covariance BLOB NOT NULL, "
     "distance_m REAL NOT NULL, reversing INTEGER NOT NULL"},
    {"keyframe_corners",
     "id INTEGER PRIMARY KEY, keyframe INTEGER NOT NULL, camera INTEGER NOT NULL, "
     "count INTEGER NOT NULL, data BLOB NOT NULL"},
    {"landmarks",
     "id INTEGER PRIMARY KEY, map_frame INTEGER NOT NULL, x REAL NOT NULL, y REAL NOT NULL, "
     "z REAL NOT NULL, covariance BLOB, ground INTEGER NOT NULL"},
    {"descriptors", "landmark INTEGER PRIMARY KEY, data BLOB NOT NULL"},
    {"observations",
     "id INTEGER PRIMARY KEY, keyframe INTEGER NOT NULL, camera INTEGER NOT NULL, "
     "count INTEGER NOT NULL, data BLOB NOT NULL"},
    {"landmark_sessions",
     "id INTEGER PRIMARY KEY, landmark INTEGER NOT NULL, session INTEGER NOT NULL, "
     "expected INTEGER NOT NULL, seen INTEGER NOT NULL, last_ns INTEGER"},
    {"loops",
     "id INTEGER PRIMARY KEY, from_keyframe INTEGER NOT NULL, to_keyframe INTEGER NOT NULL, "
     "T_from_to BLOB NOT NULL, information BLOB NOT NULL, inliers INTEGER NOT NULL, "
     "accepted INTEGER NOT NULL, weight REAL NOT NULL, reason TEXT NOT NULL"},
    {"audit", "id INTEGER PRIMARY KEY, action TEXT NOT NULL, detail TEXT NOT NULL"},
}};

void create_table(const SqlDatabase& database, const TableSql& table) {
  database.run("CREATE TABLE IF NOT EXISTS " + std::string(table.name) + "(" +
               std::string(table.columns) + ") STRICT");
}

// Columns that earlier programs did not write stand at the end.
void add_real_column(const SqlDatabase& database,
                     const std::string& table,
                     const std::string& column) {
  if (database.value("SELECT count(*) FROM pragma_table_info('" + table + "') WHERE name = '" +
                     column + "'") == "0")
    database.run("ALTER TABLE " + table + " ADD COLUMN " + column + " REAL");
}

}  // namespace

const std::vector<std::string>& map_table_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const TableSql& table : kTables) list.emplace_back(table.name);
    return list;
  }();
  return names;
}

void create_map_tables(const SqlDatabase& database) {
  for (const TableSql& table : kTables) {
    const std::string name(table.name);
    // The audit is a history: it is never taken away.
    if (table.name != "audit") database.run("DROP TABLE IF EXISTS " + name);
    create_table(database, table);
  }
  database.run(
      "CREATE TABLE IF NOT EXISTS map_meta(id INTEGER PRIMARY KEY, key TEXT NOT NULL, "
      "value TEXT NOT NULL) STRICT");
}

void migrate_map_tables(const SqlDatabase& database) {
  for (const TableSql& table : kTables) create_table(database, table);
  add_real_column(database, "sessions", "localised_share");
  add_real_column(database, "cameras", "exposed_after_s");
  add_real_column(database, "cameras", "rolling_shutter_s");
}

}  // namespace roadbook
