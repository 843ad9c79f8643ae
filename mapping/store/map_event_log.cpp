#include "mapping/store/map_event_log.hpp"

#include <utility>

#include "base/digest.hpp"
#include "mapping/layers/map_layers_table.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_content.hpp"
#include "mapping/store/map_file_digest.hpp"
#include "mapping/store/map_file_disk.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "mapping/store/map_file_open.hpp"

namespace roadbook {
namespace {

constexpr std::string_view kSuffix = "_events";
constexpr const char* kClasses = "label_classes";  // the one plain table that people write

std::string table_of(const std::string& name) {
  std::string table = name + std::string(kSuffix);
  check_plain_name(table);
  return table;
}

bool has_table(const SqlDatabase& database, const std::string& table) {
  SqlStatement row =
      database.prepare("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?");
  row.bind_text(1, table);
  return row.step() && row.integer(0) == 1;
}

std::string chained(const std::string& before, std::int64_t event, const std::string& content) {
  return Sha256().update(before).update(event).update(content).hex();
}

PlainTable empty_log(const std::string& table) {
  return {
      table,
      {{"event", FieldType::kInteger}, {"content", FieldType::kText}, {"chain", FieldType::kText}},
      {}};
}

std::vector<std::string> event_tables(const SqlDatabase& database) {
  std::vector<std::string> tables;
  SqlStatement rows =
      database.prepare("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name");
  while (rows.step())
    if (is_event_table(rows.text(0))) tables.push_back(rows.text(0));
  return tables;
}

struct Log {
  std::vector<std::string> events;
  std::string chain;
};

Log read_log(const SqlDatabase& database, const std::string& table) {
  Log log;
  SqlStatement rows =
      database.prepare("SELECT event, content, chain FROM " + sql_name(table) + " ORDER BY rowid");
  while (rows.step()) {
    const auto want = static_cast<std::int64_t>(log.events.size() + 1);
    std::string content = rows.text(1);
    log.chain = chained(log.chain, want, content);
    if (rows.integer(0) != want || rows.text(2) != log.chain)
      throw BadInput({Severity::kError, database.file().string(), want, table, "a changed event",
                      "the chain that was stored"});
    log.events.push_back(std::move(content));
  }
  return log;
}

}  // namespace

struct MapEventLog::Impl {
  Impl(const std::filesystem::path& map, const std::string& name)
      : table(table_of(name)),
        hold(existing_map_file(map)),
        lock((begin(map, table), map)),
        database(map, SqlMode::kReadWrite) {
    log = read_log(database, table);
  }
  // Verifies the map, and adds the table if it is missing. Events go into the file in place: a file
  // of several names (hard links) is copied first, so that each name has its own lock and log.
  static void begin(const std::filesystem::path& map, const std::string& table) {
    if (std::filesystem::hard_link_count(map) > 1) {
      const std::filesystem::path copy = beside(map, ".new");
      copy_map_file(map, copy);
      replace_file(copy, map);
    }
    if (has_table(open_verified(map), table)) return;
    MapUpdate update(map);
    update.write_table(empty_log(table));
    update.commit();
  }

  std::string table;
  MapHold hold;  ///< over the two steps: the table is begun, then the log is opened
  MapLock lock;
  SqlDatabase database;
  Log log;
};

MapEventLog::MapEventLog(const std::filesystem::path& map, const std::string& name)
    : impl_(std::make_unique<Impl>(map, name)) {}
MapEventLog::~MapEventLog() = default;

const std::vector<std::string>& MapEventLog::events() const { return impl_->log.events; }

std::int64_t MapEventLog::append(const std::vector<std::string>& contents,
                                 const PlainTable* table) {
  Impl& log = *impl_;
  const auto first = static_cast<std::int64_t>(log.log.events.size() + 1);
  if (contents.empty()) return first;
  std::string chain = log.log.chain;
  SqlTransaction transaction(log.database);
  SqlStatement insert =
      log.database.prepare("INSERT INTO " + sql_name(log.table) + " VALUES(?, ?, ?)");
  for (std::size_t i = 0; i < contents.size(); ++i) {
    const std::int64_t event = first + static_cast<std::int64_t>(i);
    chain = chained(chain, event, contents[i]);
    insert.bind(1, event).bind_text(2, contents[i]).bind_text(3, chain).run();
  }
  renew_table_digest(log.database, log.table);
  if (table != nullptr) {
    replace_plain_table(log.database, *table);
    renew_table_digest(log.database, table->name);
  }
  transaction.commit();
  log.log.events.insert(log.log.events.end(), contents.begin(), contents.end());
  log.log.chain = chain;
  return first;
}

void MapEventLog::write_table(const PlainTable& table) {
  const SqlDatabase& database = impl_->database;
  SqlTransaction transaction(database);
  replace_plain_table(database, table);
  renew_table_digest(database, table.name);
  transaction.commit();
}

std::vector<std::string> read_event_log(const std::filesystem::path& map, const std::string& name) {
  const std::string table = table_of(name);
  const SqlDatabase database = open_verified(map);
  if (!has_table(database, table)) return {};
  return read_log(database, table).events;
}

void carry_event_logs(const std::filesystem::path& from, const std::filesystem::path& to) {
  const SqlDatabase source = open_verified(from);
  const SqlDatabase target(to, SqlMode::kReadWrite);
  for (const std::string& table : event_tables(source)) {
    if (has_table(target, table)) continue;
    (void)read_log(source, table);  // whole, or nothing is carried
    write_plain_table(target, empty_log(table));
    SqlTransaction transaction(target);
    SqlStatement insert = target.prepare("INSERT INTO " + sql_name(table) + " VALUES(?, ?, ?)");
    SqlStatement rows =
        source.prepare("SELECT event, content, chain FROM " + sql_name(table) + " ORDER BY rowid");
    while (rows.step())
      insert.bind(1, rows.integer(0)).bind_text(2, rows.bytes(1)).bind_text(3, rows.bytes(2)).run();
    transaction.commit();
  }
  if (has_table(source, kClasses) && !has_table(target, kClasses))
    write_plain_table(target, read_plain_table(source, kClasses));
}

std::vector<Problem> event_log_problems(const SqlDatabase& database) {
  std::vector<Problem> problems;
  for (const std::string& table : event_tables(database)) {
    try {
      (void)read_log(database, table);
    } catch (const BadInput& bad) {
      problems.insert(problems.end(), bad.problems().begin(), bad.problems().end());
    }
  }
  return problems;
}

}  // namespace roadbook
