#include "mapping/layers/layer_styles.hpp"

#include "mapping/layers/layer_style_qml.hpp"

namespace roadbook {
namespace {

// Columns and types as QGIS creates the table itself.
constexpr const char* kTable =
    "CREATE TABLE layer_styles(id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, "
    "f_table_catalog TEXT(256), f_table_schema TEXT(256), f_table_name TEXT(256), "
    "f_geometry_column TEXT(256), styleName TEXT(30), styleQML TEXT, styleSLD TEXT, "
    "useAsDefault BOOLEAN, description TEXT, owner TEXT(30), ui TEXT(30), update_time DATETIME)";

}  // namespace

void write_layer_styles(const SqlDatabase& database, const std::string& content_time) {
  database.run("DROP TABLE IF EXISTS layer_styles");
  database.run(kTable);
  SqlStatement layers = database.prepare(
      "SELECT table_name, column_name FROM gpkg_geometry_columns ORDER BY table_name");
  SqlStatement insert = database.prepare(
      "INSERT INTO layer_styles(f_table_catalog, f_table_schema, f_table_name, f_geometry_column, "
      "styleName, styleQML, styleSLD, useAsDefault, description, owner, ui, update_time) "
      "VALUES('', '', ?, ?, 'roadbook', ?, '', 1, 'Over the overhead image', '', NULL, ?)");
  while (layers.step()) {
    const std::string name = layers.text(0);
    const std::string column = layers.text(1);
    const auto style = layer_style(name);
    if (!style) continue;
    const std::string qml = qml_of(*style);
    insert.bind_text(1, name).bind_text(2, column).bind_text(3, qml).bind_text(4, content_time);
    insert.run();
  }
  database
      .prepare(
          "INSERT OR REPLACE INTO gpkg_contents(table_name, data_type, identifier, description, "
          "last_change) VALUES('layer_styles', 'attributes', 'layer_styles', "
          "'How QGIS draws the layers', ?)")
      .bind_text(1, content_time)
      .run();
}

}  // namespace roadbook
