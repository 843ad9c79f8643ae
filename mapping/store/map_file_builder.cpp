#include "mapping/store/map_file_builder.hpp"

#include <algorithm>
#include <utility>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "mapping/layers/map_layers_table.hpp"
#include "mapping/store/map_bytes.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_event_log.hpp"
#include "mapping/store/map_file_content.hpp"
#include "mapping/store/map_file_disk.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_seal.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kChunkBytes = 4 << 20;

/// Feeds a stage's names and sizes; the blobs' bytes follow each by `update`.
void add_heading(Sha256& sha, std::string_view name, std::size_t size) {
  sha.update(static_cast<std::uint64_t>(name.size())).update(name);
  sha.update(static_cast<std::uint64_t>(size));
}

std::string stage_digest(const std::map<std::string, std::string>& blobs) {
  Sha256 sha;
  for (const auto& [name, bytes] : blobs) {
    add_heading(sha, name, bytes.size());
    sha.update(bytes);
  }
  return sha.hex();
}

std::string stored_stage_digest(const SqlDatabase& database, const std::string& stage) {
  Sha256 sha;
  SqlStatement blobs =
      database.prepare("SELECT id, name, size FROM blob WHERE stage = ? ORDER BY name");
  SqlStatement chunks = database.prepare("SELECT data FROM chunk WHERE blob = ? ORDER BY id");
  blobs.bind_text(1, stage);
  while (blobs.step()) {
    add_heading(sha, blobs.bytes(1), static_cast<std::size_t>(blobs.integer(2)));
    chunks.bind(1, blobs.integer(0));
    while (chunks.step()) sha.update(chunks.bytes(0));
    chunks.reset();
  }
  return sha.hex();
}

}  // namespace

struct MapFileBuilder::Impl {
  Impl(std::filesystem::path map_file, std::string_view inputs_key)
      : map(std::move(map_file)), lock(map) {
    if (lock.was_damaged()) warn("a damaged file", "checkpoints of a stopped build");
    try {
      adopt(inputs_key);
    } catch (const BadInput& bad) {
      const Problem& fault = bad.problems().front();
      warn(fault.got + " (" + fault.field + ")", fault.want);
      lock.reset();
      stages.clear();
      adopt(inputs_key);
    }
  }

  void warn(const std::string& got, const std::string& want) {
    warnings.push_back({Severity::kWarning, database().file().string(), 0, "checkpoints", got,
                        want + "; the build starts afresh"});
  }
  [[nodiscard]] const SqlDatabase& database() const { return lock.database(); }

  /// Takes the checkpoints that belong to `inputs_key`; leaves an empty build otherwise.
  void adopt(std::string_view inputs_key) {
    if (database().value("PRAGMA quick_check(1)") != "ok")
      throw BadInput(
          Problem{Severity::kError, database().file().string(), 0, "quick_check", "damage", "ok"});
    create_tables();
    const std::string key = database().value("SELECT inputs_key FROM build");
    if (!key.empty() && key != inputs_key) {
      warn("a build begun with other inputs or options",
           "one of the same inputs, options and program");
      lock.reset();
      create_tables();
    }
    if (key != inputs_key)
      database().prepare("INSERT INTO build VALUES(1, ?)").bind_text(1, inputs_key).run();
    read_stages();
  }

  void create_tables() const {
    SqlTransaction transaction(database());
    database().run(
        "CREATE TABLE IF NOT EXISTS build(id INTEGER PRIMARY KEY, inputs_key TEXT NOT NULL) STRICT;"
        "CREATE TABLE IF NOT EXISTS stage(id INTEGER PRIMARY KEY, name TEXT NOT NULL, "
        "digest TEXT NOT NULL) STRICT;"
        "CREATE TABLE IF NOT EXISTS blob(id INTEGER PRIMARY KEY, stage TEXT NOT NULL, "
        "name TEXT NOT NULL, size INTEGER NOT NULL) STRICT;"
        "CREATE TABLE IF NOT EXISTS chunk(id INTEGER PRIMARY KEY, blob INTEGER NOT NULL, "
        "data BLOB NOT NULL) STRICT;"
        "CREATE INDEX IF NOT EXISTS chunk_of_blob ON chunk(blob)");
    transaction.commit();
  }

  void read_stages() {
    SqlStatement rows = database().prepare("SELECT name, digest FROM stage ORDER BY id");
    while (rows.step()) {
      if (stored_stage_digest(database(), rows.text(0)) != rows.bytes(1))
        throw BadInput(Problem{Severity::kError, database().file().string(), 0,
                               "stage " + rows.text(0), "other content",
                               "the digest that was stored"});
      stages.push_back(rows.text(0));
    }
  }

  void remove_stage(std::string_view stage) const {
    database()
        .prepare("DELETE FROM chunk WHERE blob IN (SELECT id FROM blob WHERE stage = ?)")
        .bind_text(1, stage)
        .run();
    database().prepare("DELETE FROM blob WHERE stage = ?").bind_text(1, stage).run();
    database().prepare("DELETE FROM stage WHERE name = ?").bind_text(1, stage).run();
  }

  void insert_blob(std::string_view stage, const std::string& name, std::string_view bytes) const {
    database()
        .prepare("INSERT INTO blob(stage, name, size) VALUES(?, ?, ?)")
        .bind_text(1, stage)
        .bind_text(2, name)
        .bind(3, static_cast<std::int64_t>(bytes.size()))
        .run();
    const std::int64_t id = sqlite3_last_insert_rowid(database().handle());
    SqlStatement insert = database().prepare("INSERT INTO chunk(blob, data) VALUES(?, ?)");
    for (std::size_t at = 0; at < bytes.size(); at += kChunkBytes)
      insert.bind(1, id).bind_blob(2, bytes.substr(at, kChunkBytes)).run();
  }

  std::filesystem::path map;
  MapLock lock;
  std::vector<std::string> stages;
  std::vector<Problem> warnings;
};

MapFileBuilder::MapFileBuilder(std::filesystem::path map, std::string_view inputs_key)
    : impl_(std::make_unique<Impl>(std::move(map), inputs_key)) {}
MapFileBuilder::~MapFileBuilder() = default;

const std::vector<std::string>& MapFileBuilder::stages() const { return impl_->stages; }
const std::vector<Problem>& MapFileBuilder::warnings() const { return impl_->warnings; }

bool MapFileBuilder::has(std::string_view stage) const {
  return std::find(impl_->stages.begin(), impl_->stages.end(), stage) != impl_->stages.end();
}

std::string MapFileBuilder::load(std::string_view stage, std::string_view name) const {
  SqlStatement blob =
      impl_->database().prepare("SELECT id, size FROM blob WHERE stage = ? AND name = ?");
  blob.bind_text(1, stage).bind_text(2, name);
  ROADBOOK_ASSERT(blob.step());
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(blob.integer(1)));
  SqlStatement chunks =
      impl_->database().prepare("SELECT data FROM chunk WHERE blob = ? ORDER BY id");
  chunks.bind(1, blob.integer(0));
  while (chunks.step()) bytes += chunks.bytes(0);
  return bytes;
}

void MapFileBuilder::save(std::string_view stage, const std::map<std::string, std::string>& blobs) {
  SqlTransaction transaction(impl_->database());
  impl_->remove_stage(stage);
  for (const auto& [name, bytes] : blobs) impl_->insert_blob(stage, name, bytes);
  impl_->database()
      .prepare("INSERT INTO stage(name, digest) VALUES(?, ?)")
      .bind_text(1, stage)
      .bind_text(2, stage_digest(blobs))
      .run();
  transaction.commit();
  std::erase(impl_->stages, stage);
  impl_->stages.emplace_back(stage);
}

void MapFileBuilder::finish(const Map& map,
                            const std::map<std::string, std::string>& meta,
                            const MapFinishOptions& options) {
  const std::vector<Problem> problems = map_problems(map);
  if (!problems.empty()) {
    Problem first = problems.front();
    first.file = impl_->map.string();
    throw Refused(to_line(first));
  }
  const std::filesystem::path file = beside(impl_->map, ".new");
  remove_database(file);
  try {
    if (options.keep_other_layers && std::filesystem::exists(impl_->map)) {
      copy_map_file(impl_->map, file);
      // It is the map before edits no more: it lacks what this build adds.
      SqlDatabase(file, SqlMode::kReadWrite).run("DROP TABLE IF EXISTS " + sql_name(kBeforeTable));
    }
    write_map_content(file, map, meta, options);
    if (std::filesystem::exists(impl_->map)) {
      carry_event_logs(impl_->map, file);
      carry_tables(impl_->map, file, options.keep_tables);
    }
    seal_map_file(file);
    replace_file(file, impl_->map);
  } catch (...) {
    remove_database(file);
    throw;
  }
  impl_->lock.remove_file();
  impl_.reset();
}

}  // namespace roadbook
