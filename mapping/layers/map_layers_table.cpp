#include "mapping/layers/map_layers_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "mapping/layers/map_layers_vector.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {
namespace {

constexpr std::array<std::pair<FieldType, const char*>, 4> kTypes{{{FieldType::kInteger, "INTEGER"},
                                                                   {FieldType::kReal, "REAL"},
                                                                   {FieldType::kText, "TEXT"},
                                                                   {FieldType::kBytes, "BLOB"}}};

const char* sql_type(FieldType type) {
  for (const auto& [known, name] : kTypes)
    if (known == type) return name;
  return "BLOB";
}

std::string_view view(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void bind_value(SqlStatement& statement, int parameter, const FieldValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    statement.bind(parameter, *number);
  } else if (const auto* real = std::get_if<double>(&value); real && !std::isnan(*real)) {
    statement.bind(parameter, *real);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    statement.bind_text(parameter, *text);
  } else if (const auto* bytes = std::get_if<Bytes>(&value)) {
    statement.bind_blob(parameter, view(*bytes));
  } else {
    statement.bind_null(parameter);
  }
}

FieldValue field_of(const SqlStatement& row, int column) {
  switch (row.type(column)) {
    case SQLITE_INTEGER:
      return row.integer(column);
    case SQLITE_FLOAT:
      return row.real(column);
    case SQLITE_TEXT:
      return row.text(column);
    case SQLITE_BLOB: {
      const std::string_view bytes = row.bytes(column);
      return Bytes(bytes.begin(), bytes.end());
    }
    default:
      return std::monostate{};
  }
}

}  // namespace

void check_plain_name(const std::string& name) {
  check_layer_name(name);
  const auto& own = map_table_names();
  if (name == "map_meta" || std::find(own.begin(), own.end(), name) != own.end())
    throw InvalidOption("table name", name, "a name that roadbook does not use itself");
}

void write_plain_table(const SqlDatabase& database, const PlainTable& table) {
  SqlTransaction transaction(database);
  replace_plain_table(database, table);
  transaction.commit();
}

void replace_plain_table(const SqlDatabase& database, const PlainTable& table) {
  check_plain_name(table.name);
  std::string columns;
  std::string parameters;
  for (const Field& field : table.fields) {
    check_layer_name(field.name);
    columns += (columns.empty() ? "" : ", ") + sql_name(field.name) + " " + sql_type(field.type);
    parameters += parameters.empty() ? "?" : ", ?";
  }
  database.run("DROP TABLE IF EXISTS " + sql_name(table.name));
  database.run("CREATE TABLE " + sql_name(table.name) + "(" + columns + ") STRICT");
  SqlStatement insert =
      database.prepare("INSERT INTO " + sql_name(table.name) + " VALUES(" + parameters + ")");
  for (const auto& row : table.rows) {
    if (row.size() != table.fields.size())
      throw InvalidOption(table.name + ".rows", std::to_string(row.size()),
                          std::to_string(table.fields.size()));
    for (std::size_t i = 0; i < row.size(); ++i)
      bind_value(insert, static_cast<int>(i) + 1, row[i]);
    insert.run();
  }
}

PlainTable read_plain_table(const SqlDatabase& database, const std::string& name) {
  PlainTable table;
  table.name = name;
  SqlStatement columns = database.prepare("SELECT name, type FROM pragma_table_info(?)");
  columns.bind_text(1, name);
  while (columns.step()) {
    FieldType type = FieldType::kBytes;
    for (const auto& [known, sql] : kTypes)
      if (columns.bytes(1) == sql) type = known;
    table.fields.push_back({columns.text(0), type});
  }
  if (table.fields.empty())
    throw BadInput(Problem{Severity::kError, database.file().string(), 0, "table", name,
                           "a table of this map"});
  SqlStatement rows = database.prepare("SELECT * FROM " + sql_name(name) + " ORDER BY rowid");
  while (rows.step()) {
    std::vector<FieldValue> row;
    for (int c = 0; c < rows.columns(); ++c) row.push_back(field_of(rows, c));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void carry_tables(const std::filesystem::path& from,
                  const std::filesystem::path& to,
                  const std::vector<std::string>& names) {
  const SqlDatabase source = open_verified(from);
  const SqlDatabase target(to, SqlMode::kReadWrite);
  for (const std::string& name : names) {
    SqlStatement found =
        source.prepare("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?");
    found.bind_text(1, name);
    if (found.step() && found.integer(0) == 1)
      write_plain_table(target, read_plain_table(source, name));
  }
}

}  // namespace roadbook
