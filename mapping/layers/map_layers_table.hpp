#pragma once

#include "mapping/layers/layer_types.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {

/// Throws InvalidOption for a name that is no identifier or that roadbook uses itself.
void check_plain_name(const std::string& name);

/// Creates or replaces a plain table. Throws InvalidOption for a name that roadbook uses itself.
void write_plain_table(const SqlDatabase& database, const PlainTable& table);
/// The same within a transaction that is open.
void replace_plain_table(const SqlDatabase& database, const PlainTable& table);

/// Throws BadInput where there is no such table.
[[nodiscard]] PlainTable read_plain_table(const SqlDatabase& database, const std::string& name);

/// Copies the tables `names`, as far as map `from` has them, into file `to`, which is to replace
/// the map. Throws BadInput for a map that cannot be read.
void carry_tables(const std::filesystem::path& from,
                  const std::filesystem::path& to,
                  const std::vector<std::string>& names);

}  // namespace roadbook
