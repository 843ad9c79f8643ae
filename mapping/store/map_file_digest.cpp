#include "mapping/store/map_file_digest.hpp"

#include <algorithm>
#include <array>

#include "base/digest.hpp"
#include "mapping/store/file_digest.hpp"
#include "mapping/store/map_file_codec.hpp"

namespace roadbook {
namespace {

void add_value(std::string& row, const SqlStatement& rows, int column) {
  const int type = rows.type(column);
  pack(row, static_cast<std::uint8_t>(type));
  if (type == SQLITE_INTEGER) {
    pack(row, rows.integer(column));
  } else if (type == SQLITE_FLOAT) {
    pack(row, rows.real(column));
  } else if (type != SQLITE_NULL) {
    const std::string_view bytes = rows.bytes(column);
    pack(row, static_cast<std::uint64_t>(bytes.size()));
    row.append(bytes);
  }
}

std::string digest_rows(SqlStatement rows) {
  Sha256 sha;
  std::string row;
  while (rows.step()) {
    row.clear();
    for (int c = 0; c < rows.columns(); ++c) add_value(row, rows, c);
    sha.update(row);
  }
  return sha.hex();
}

struct TableName {
  std::string name;
  bool is_virtual = false;
};

// Tables in which an R-tree keeps its nodes. Their rows depend on the order in which the entries
// came: their digests find damage, but are no part of the content.
constexpr std::array kRtreeParts{"_node", "_parent", "_rowid"};

bool is_rtree_part(std::string_view table) {
  return table.starts_with("rtree_") &&
         std::any_of(kRtreeParts.begin(), kRtreeParts.end(),
                     [&](const char* suffix) { return table.ends_with(suffix); });
}

std::vector<TableName> tables_of(const SqlDatabase& database) {
  std::vector<TableName> tables;
  SqlStatement rows = database.prepare(
      "SELECT name, sql LIKE 'CREATE VIRTUAL%' FROM sqlite_master WHERE type = 'table' "
      "AND name NOT LIKE 'sqlite\\_%' ESCAPE '\\' ORDER BY name");
  while (rows.step()) tables.push_back({rows.text(0), rows.integer(1) != 0});
  return tables;
}

constexpr const char* kOwnKeys = "key NOT LIKE 'digest%' AND key != 'schema_digest'";

std::string query_of(const TableName& table) {
  if (table.name == "map_meta")
    return std::string("SELECT key, value FROM map_meta WHERE ") + kOwnKeys + " ORDER BY rowid";
  if (is_event_table(table.name))
    return "SELECT event, chain FROM " + sql_name(table.name) + " ORDER BY rowid DESC LIMIT 1";
  // Sorting by rowid walks the table itself: a damaged index has no say.
  return "SELECT * FROM " + sql_name(table.name) +
         (table.is_virtual ? " ORDER BY 1" : " ORDER BY rowid");
}

bool is_content(std::string_view table) {
  return table != "session_places" && table != "map_meta" && !is_rtree_part(table);
}

std::string content_line(const std::string& table, const std::string& digest) {
  return table + ' ' + digest + '\n';
}

std::string meta_digest(const SqlDatabase& database) {
  return digest_rows(database.prepare(std::string("SELECT key, value FROM map_meta WHERE ") +
                                      kOwnKeys + " AND key NOT LIKE 'place.%' ORDER BY key"));
}

std::string schema_digest(const SqlDatabase& database) {
  return digest_rows(
      database.prepare("SELECT type, name, tbl_name, sql FROM sqlite_master ORDER BY type, name"));
}

std::string meta_value_of(const SqlDatabase& database, const std::string& key) {
  SqlStatement row = database.prepare("SELECT value FROM map_meta WHERE key = ?");
  row.bind_text(1, key);
  return row.step() ? row.text(0) : std::string{};
}

bool is_registry(std::string_view table) {
  return table.starts_with("gpkg_") || table == "map_meta";
}

// The digest of a table whose rows are taken in the order of their values.
std::string sorted_digest(const SqlDatabase& database, const TableName& table) {
  std::string order;
  const int columns = database.prepare(query_of(table)).columns();
  for (int c = 1; c <= columns; ++c) order += (c == 1 ? "" : ", ") + std::to_string(c);
  return digest_rows(database.prepare("SELECT * FROM (" + query_of(table) + ") ORDER BY " + order));
}

// Computes all digests. `seen` gets each as soon as it is known, with its key in map_meta.
template <typename Seen>
MapDigests digests_of(const SqlDatabase& database, const Seen& seen) {
  MapDigests digests;
  digests.schema = schema_digest(database);
  seen("schema_digest", digests.schema);
  Sha256 content;
  for (const TableName& table : tables_of(database)) {
    const std::string digest = digest_rows(database.prepare(query_of(table)));
    digests.tables[table.name] = digest;
    seen("digest." + table.name, digest);
    if (is_content(table.name)) content.update(content_line(table.name, digest));
  }
  content.update(meta_digest(database));
  digests.content = content.hex();
  return digests;
}

// The digests in map_meta, each compared once.
class StoredDigests {
 public:
  explicit StoredDigests(const SqlDatabase& database) : database_(database) {
    SqlStatement rows =
        database.prepare(std::string("SELECT key, value FROM map_meta WHERE key != '") +
                         kFileDigestKey + "' AND NOT (" + kOwnKeys + ")");
    while (rows.step()) {
      if (!stored_.emplace(rows.text(0), rows.text(1)).second) refuse(rows.text(0), "two digests");
      knows_rtree_parts_ = knows_rtree_parts_ || is_rtree_part(table_of(rows.text(0)));
    }
  }
  void compare(const std::string& key, const std::string& digest) {
    const auto found = stored_.find(key);
    if (found == stored_.end()) {
      // Maps of earlier programs have no digests of the parts of R-trees.
      if (!knows_rtree_parts_ && is_rtree_part(table_of(key))) return;
      refuse(key, "no stored digest");
    }
    if (found->second != digest) refuse(key, "other content");
    stored_.erase(found);
  }
  void refuse_others() const {
    if (!stored_.empty()) refuse(stored_.begin()->first, "a table that is gone");
  }

 private:
  static std::string table_of(const std::string& key) { return key.substr(key.find('.') + 1); }
  [[noreturn]] void refuse(const std::string& key, const std::string& got) const {
    throw BadInput(
        {Severity::kError, database_.file().string(), 0, key, got, "the digest that was stored"});
  }

  const SqlDatabase& database_;
  std::map<std::string, std::string> stored_;
  bool knows_rtree_parts_ = false;
};

}  // namespace

bool is_event_table(std::string_view table) { return table.ends_with("_events"); }

MapDigests compute_digests(const SqlDatabase& database) {
  return digests_of(database, [](const std::string&, const std::string&) {});
}

void store_digests(const SqlDatabase& database, const MapDigests& digests) {
  database.run(std::string("DELETE FROM map_meta WHERE NOT (") + kOwnKeys + ")");
  SqlStatement insert = database.prepare("INSERT INTO map_meta(key, value) VALUES(?, ?)");
  insert.bind_text(1, "digest").bind_text(2, digests.content).run();
  insert.bind_text(1, "schema_digest").bind_text(2, digests.schema).run();
  for (const auto& [table, digest] : digests.tables) {
    const std::string key = "digest." + table;
    insert.bind_text(1, key).bind_text(2, digest).run();
  }
}

bool have_same_content(const SqlDatabase& file,
                       const SqlDatabase& copy,
                       const MapDigests& digests) {
  const auto tables = tables_of(file);
  const auto parts = std::count_if(tables.begin(), tables.end(),
                                   [](const TableName& t) { return is_rtree_part(t.name); });
  const auto now_parts = std::count_if(digests.tables.begin(), digests.tables.end(),
                                       [](const auto& t) { return is_rtree_part(t.first); });
  if (parts != now_parts || tables.size() != digests.tables.size() ||
      meta_value_of(file, "schema_digest") != digests.schema)
    return false;
  return std::all_of(tables.begin(), tables.end(), [&](const TableName& table) {
    const auto now = digests.tables.find(table.name);
    if (now == digests.tables.end()) return false;
    if (is_rtree_part(table.name) || meta_value_of(file, "digest." + table.name) == now->second)
      return true;
    return is_registry(table.name) && sorted_digest(file, table) == sorted_digest(copy, table);
  });
}

namespace {

// The digest of the content by the stored digests of the tables.
std::string content_by_stored(const SqlDatabase& database) {
  std::map<std::string, std::string> stored;
  SqlStatement rows =
      database.prepare("SELECT key, value FROM map_meta WHERE key LIKE 'digest.%' ORDER BY key");
  while (rows.step()) stored[rows.text(0).substr(std::string("digest.").size())] = rows.text(1);
  Sha256 content;
  for (const auto& [name, digest] : stored)
    if (is_content(name)) content.update(content_line(name, digest));
  return content.update(meta_digest(database)).hex();
}

}  // namespace

void renew_table_digest(const SqlDatabase& database, const std::string& table) {
  const auto write = [&](const std::string& key, const std::string& value) {
    database.prepare("UPDATE map_meta SET value = ? WHERE key = ?")
        .bind_text(1, value)
        .bind_text(2, key)
        .run();
    if (sqlite3_changes(database.handle()) == 0)
      database.prepare("INSERT INTO map_meta(key, value) VALUES(?, ?)")
          .bind_text(1, key)
          .bind_text(2, value)
          .run();
  };
  write("digest." + table, digest_rows(database.prepare(query_of({table, false}))));
  write("schema_digest", schema_digest(database));
  write("digest", content_by_stored(database));
  database.prepare("DELETE FROM map_meta WHERE key = ?").bind_text(1, kFileDigestKey).run();
}

MapDigests verified_digests(const SqlDatabase& database) {
  StoredDigests stored(database);
  MapDigests digests = digests_of(database, [&](const std::string& key, const std::string& digest) {
    stored.compare(key, digest);
  });
  stored.compare("digest", digests.content);
  stored.refuse_others();
  return digests;
}

namespace {

// A reader that searches by an index, as GDAL does for tiles, would miss rows that the index lacks.
void check_indices(const SqlDatabase& database, const std::string& table) {
  SqlStatement fault = database.prepare("SELECT integrity_check FROM pragma_integrity_check(?)");
  fault.bind_text(1, table);
  if (fault.step() && fault.text(0) != "ok")
    throw BadInput(Problem{Severity::kError, database.file().string(), 0, "table " + table,
                           fault.text(0), "indices that fit their rows"});
}

}  // namespace

void verify_registries(const SqlDatabase& database) {
  StoredDigests stored(database);
  stored.compare("schema_digest", schema_digest(database));
  stored.compare("digest", content_by_stored(database));
  for (const TableName& table : tables_of(database))
    if (is_registry(table.name)) {
      stored.compare("digest." + table.name, digest_rows(database.prepare(query_of(table))));
      check_indices(database, table.name);
    }
}

void verify_table(const SqlDatabase& database, const std::string& table) {
  StoredDigests(database).compare("digest." + table,
                                  digest_rows(database.prepare(query_of({table, false}))));
  check_indices(database, table);
}

}  // namespace roadbook
