#include "mapping/store/foreign_parts.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Beginnings of the names of triggers; the name of the table that they watch follows. Those of a
// raster's tiles begin with the table: overhead_zoom_insert.
constexpr std::array kTriggers{"", "rtree_", "trigger_insert_feature_count_",
                               "trigger_delete_feature_count_"};
// GeoPackage's triggers have single statements on single rows. These words begin others.
constexpr std::array kForeignWords{"WITH", "RECURSIVE", "JOIN", "UNION", "INSTEAD"};

bool has_word(const std::string& upper, const std::string& word) {
  const auto is_letter = [&](std::size_t i) {
    return i < upper.size() &&
           (std::isalnum(static_cast<unsigned char>(upper[i])) != 0 || upper[i] == '_');
  };
  for (std::size_t at = upper.find(word); at != std::string::npos; at = upper.find(word, at + 1))
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + word.size())) return true;
  return false;
}

bool is_known_trigger(const std::string& name, const std::string& table, std::string sql) {
  std::transform(sql.begin(), sql.end(), sql.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (std::any_of(kForeignWords.begin(), kForeignWords.end(),
                  [&](const char* word) { return has_word(sql, word); }))
    return false;
  return std::any_of(kTriggers.begin(), kTriggers.end(),
                     [&](const char* begin) { return name.starts_with(begin + table); });
}

bool is_rtree(const std::string& sql) {
  return sql.find(" USING rtree(") != std::string::npos ||
         sql.find(" USING \"rtree\"(") != std::string::npos;
}

}  // namespace

void refuse_foreign_parts(const SqlDatabase& database) {
  SqlStatement rows = database.prepare(
      "SELECT type, name, tbl_name, sql FROM sqlite_master WHERE type NOT IN ('table', 'index') "
      "OR sql LIKE 'CREATE VIRTUAL%' ORDER BY type, name");
  while (rows.step()) {
    const std::string type = rows.text(0);
    if (type == "table" && is_rtree(rows.text(3))) continue;
    if (type == "trigger" && is_known_trigger(rows.text(1), rows.text(2), rows.text(3))) continue;
    throw BadInput({Severity::kError, database.file().string(), 0, "schema",
                    type + " " + rows.text(1), "only tables and triggers that roadbook writes"});
  }
}

}  // namespace roadbook
