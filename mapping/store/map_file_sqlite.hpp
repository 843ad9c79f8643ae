#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace roadbook {

// A thin, owning layer over sqlite3: errors become exceptions, parameters are always bound.
//
// A full disk, a missing permission or a lock gives StorageError; damage gives BadInput.

enum class SqlMode { kRead, kReadWrite, kCreate };

/// A prepared statement. Columns and parameters: columns count from 0, parameters from 1, as in
/// sqlite3.
class SqlStatement {
 public:
  SqlStatement(sqlite3* database, const std::filesystem::path& file, const std::string& sql);

  SqlStatement& bind(int parameter, std::int64_t value);
  SqlStatement& bind(int parameter, int value) { return bind(parameter, std::int64_t{value}); }
  SqlStatement& bind(int parameter, double value);
  SqlStatement& bind_null(int parameter);
  /// The bytes must live until the next `step` or `run`.
  SqlStatement& bind_text(int parameter, std::string_view text);
  SqlStatement& bind_blob(int parameter, std::string_view bytes);

  /// True while there is a row.
  bool step();
  void reset() { sqlite3_reset(statement_.get()); }
  /// Steps to the end and resets, so that the statement can be bound again.
  void run();

  [[nodiscard]] int columns() const { return sqlite3_column_count(statement_.get()); }
  [[nodiscard]] std::string column_name(int column) const {
    return sqlite3_column_name(statement_.get(), column);
  }
  [[nodiscard]] int type(int column) const { return sqlite3_column_type(statement_.get(), column); }
  [[nodiscard]] std::int64_t integer(int column) const {
    return sqlite3_column_int64(statement_.get(), column);
  }
  [[nodiscard]] double real(int column) const {
    return sqlite3_column_double(statement_.get(), column);
  }
  /// Text or blob as bytes; valid until the next step.
  [[nodiscard]] std::string_view bytes(int column) const;
  [[nodiscard]] std::string text(int column) const { return std::string(bytes(column)); }

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  sqlite3* database_;
  std::filesystem::path file_;
};

/// A connection, opened defensively: untrusted schema, no schema tricks, cell sizes checked. Each
/// statement of a connection that only reads has a number of steps that grows with the file: a
/// query without end (a recursive view) becomes BadInput.
class SqlDatabase {
 public:
  SqlDatabase(std::filesystem::path file, SqlMode mode);

  /// Executes statements that give no rows of interest.
  void run(const std::string& sql) const;
  [[nodiscard]] SqlStatement prepare(const std::string& sql) const;
  /// First column of the first row; empty without rows.
  [[nodiscard]] std::string value(const std::string& sql) const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] sqlite3* handle() const { return handle_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  void limit_steps();

  std::filesystem::path file_;
  struct Budget {
    std::int64_t whole = 0;  ///< calls of the progress handler that a statement may have
    std::int64_t left = 0;
  };
  std::unique_ptr<Budget> budget_;  ///< outlives the connection; empty where it may write
  std::unique_ptr<sqlite3, Close> handle_;
};

/// BEGIN IMMEDIATE ... COMMIT; rolled back where `commit` was not reached.
class SqlTransaction {
 public:
  explicit SqlTransaction(const SqlDatabase& database);
  ~SqlTransaction();
  SqlTransaction(const SqlTransaction&) = delete;
  SqlTransaction& operator=(const SqlTransaction&) = delete;
  void commit();

 private:
  const SqlDatabase& database_;
  bool open_ = true;
};

/// A name as SQL identifier: in double quotes.
[[nodiscard]] std::string sql_name(std::string_view name);

}  // namespace roadbook
