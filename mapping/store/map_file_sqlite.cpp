#include "mapping/store/map_file_sqlite.hpp"

#include <cerrno>
#include <utility>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "base/text_file.hpp"

namespace roadbook {
namespace {

bool is_storage_fault(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
    case SQLITE_NOMEM:
    case SQLITE_AUTH:
      return true;
    default:
      return false;
  }
}

[[noreturn]] void fail_database(sqlite3* database, int code, const std::filesystem::path& file) {
  const char* text = database != nullptr ? sqlite3_errmsg(database) : sqlite3_errstr(code);
  Problem problem{Severity::kError, file.string(), 0, "database", text, ""};
  if ((code & 0xff) == SQLITE_INTERRUPT)
    throw BadInput({Severity::kError, file.string(), 0, "database", "a query without end",
                    "a map file that roadbook has written"});
  if (!is_storage_fault(code)) {
    problem.want = "an undamaged map file";
    throw BadInput(std::move(problem));
  }
  const bool failed_write = (code & 0xff) == SQLITE_FULL || (code & 0xff) == SQLITE_IOERR;
  if (const std::string fault = write_fault(file, (code & 0xff) == SQLITE_FULL ? ENOSPC : 0);
      failed_write && fault.starts_with("no space"))
    problem.got = fault;
  problem.want = (code & 0xff) == SQLITE_BUSY
                     ? "a map that no other process is writing"
                     : "a readable and writable file with room on its disk";
  throw StorageError(to_line(problem));
}

// Larger than any row that roadbook writes; a damaged length cannot ask for more.
constexpr int kMaxValueBytes = 256 << 20;

// Steps of SQLite's virtual machine that a statement may take. Reading a row takes a few steps a
// column, a check of its pages some more; a byte a column is the least.
constexpr int kStepsOfCall = 100'000;
constexpr std::int64_t kLeastCalls = 200;
constexpr std::int64_t kStepsOfByte = 50;

// Another program that reads the map must not make a save fail.
constexpr int kWaitForOthersMs = 5000;

}  // namespace

SqlStatement::SqlStatement(sqlite3* database,
                           const std::filesystem::path& file,
                           const std::string& sql)
    : database_(database), file_(file) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database, sql.c_str(), static_cast<int>(sql.size() + 1),
                                      &statement, nullptr);
  statement_.reset(statement);
  if (code != SQLITE_OK) fail_database(database, code, file);
}

SqlStatement& SqlStatement::bind(int parameter, std::int64_t value) {
  const int code = sqlite3_bind_int64(statement_.get(), parameter, value);
  if (code != SQLITE_OK) fail_database(database_, code, file_);
  return *this;
}

SqlStatement& SqlStatement::bind(int parameter, double value) {
  const int code = sqlite3_bind_double(statement_.get(), parameter, value);
  if (code != SQLITE_OK) fail_database(database_, code, file_);
  return *this;
}

SqlStatement& SqlStatement::bind_null(int parameter) {
  const int code = sqlite3_bind_null(statement_.get(), parameter);
  if (code != SQLITE_OK) fail_database(database_, code, file_);
  return *this;
}

SqlStatement& SqlStatement::bind_text(int parameter, std::string_view text) {
  const char* data = text.empty() ? "" : text.data();
  const int code = sqlite3_bind_text64(statement_.get(), parameter, data, text.size(),
                                       SQLITE_STATIC, SQLITE_UTF8);
  if (code != SQLITE_OK) fail_database(database_, code, file_);
  return *this;
}

SqlStatement& SqlStatement::bind_blob(int parameter, std::string_view bytes) {
  // A null pointer would store NULL, not an empty blob.
  const char* data = bytes.empty() ? "" : bytes.data();
  const int code =
      sqlite3_bind_blob64(statement_.get(), parameter, data, bytes.size(), SQLITE_STATIC);
  if (code != SQLITE_OK) fail_database(database_, code, file_);
  return *this;
}

bool SqlStatement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) fail_database(database_, code, file_);
  return false;
}

void SqlStatement::run() {
  while (step()) {
  }
  sqlite3_reset(statement_.get());
}

std::string_view SqlStatement::bytes(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  const int size = sqlite3_column_bytes(statement_.get(), column);
  if (data == nullptr || size <= 0) return {};
  return {static_cast<const char*>(data), static_cast<std::size_t>(size)};
}

SqlDatabase::SqlDatabase(std::filesystem::path file, SqlMode mode) : file_(std::move(file)) {
  require_regular_file(file_, "a map file");
  // One thread at a time reads by a connection (its budget has no lock either). SQLite's own lock,
  // taken for each value, would cost a tenth of the time of a digest.
  const int flags = mode == SqlMode::kRead        ? SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX
                    : mode == SqlMode::kReadWrite ? SQLITE_OPEN_READWRITE
                                                  : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(file_.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);
  if (code != SQLITE_OK) fail_database(handle, code, file_);
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, kWaitForOthersMs);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kMaxValueBytes);
  if (mode == SqlMode::kRead) limit_steps();
  run("PRAGMA cell_size_check = ON");
}

void SqlDatabase::limit_steps() {
  std::error_code unknown;
  const auto bytes = std::filesystem::file_size(file_, unknown);
  budget_ = std::make_unique<Budget>();
  budget_->whole = kLeastCalls;
  if (!unknown) budget_->whole += static_cast<std::int64_t>(bytes) * kStepsOfByte / kStepsOfCall;
  budget_->left = budget_->whole;
  const auto spend = [](void* data) { return --static_cast<Budget*>(data)->left < 0 ? 1 : 0; };
  sqlite3_progress_handler(handle_.get(), kStepsOfCall, spend, budget_.get());
}

SqlStatement SqlDatabase::prepare(const std::string& sql) const {
  if (budget_) budget_->left = budget_->whole;
  return {handle_.get(), file_, sql};
}

void SqlDatabase::run(const std::string& sql) const {
  if (budget_) budget_->left = budget_->whole;
  const int code = sqlite3_exec(handle_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail_database(handle_.get(), code, file_);
}

std::string SqlDatabase::value(const std::string& sql) const {
  SqlStatement statement = prepare(sql);
  return statement.step() ? statement.text(0) : std::string{};
}

SqlTransaction::SqlTransaction(const SqlDatabase& database) : database_(database) {
  database_.run("BEGIN IMMEDIATE");
}

SqlTransaction::~SqlTransaction() {
  // Some failures have rolled back already; a second rollback then only reports that.
  if (open_) sqlite3_exec(database_.handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void SqlTransaction::commit() {
  database_.run("COMMIT");
  open_ = false;
}

std::string sql_name(std::string_view name) {
  std::string quoted = "\"";
  for (const char c : name) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + '"';
}

}  // namespace roadbook
