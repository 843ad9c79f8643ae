#pragma once

#include "mapping/map_file_sqlite.hpp"
#include "mapping/map_layers.hpp"

namespace roadbook {

/// Throws InvalidOption for a name that is no identifier or that roadbook uses itself.
void check_plain_name(const std::string& name);

/// Creates or replaces a plain table. Throws InvalidOption for a name that roadbook uses itself.
void write_plain_table(const SqlDatabase& database, const PlainTable& table);

/// Throws BadInput where there is no such table.
[[nodiscard]] PlainTable read_plain_table(const SqlDatabase& database, const std::string& name);

}  // namespace roadbook
