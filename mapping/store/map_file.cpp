#include "mapping/store/map_file.hpp"

#include "base/text.hpp"
#include "mapping/store/file_digest.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {

Map load_map(const std::filesystem::path& path) {
  return read_map_tables(open_verified(path), false);
}

Map load_map_with_corners(const std::filesystem::path& path) {
  return read_map_tables(open_verified(path), true);
}

std::vector<Session> load_sessions(const std::filesystem::path& path) {
  return read_session_table(open_map_file(path));
}

MapMeta load_meta(const std::filesystem::path& path) {
  const SqlDatabase database = open_registries(path);
  MapMeta meta;
  constexpr std::string_view kDigest = "digest.";
  SqlStatement rows = database.prepare("SELECT key, value FROM map_meta ORDER BY id");
  while (rows.step()) {
    const std::string key = rows.text(0);
    if (key == "schema_version") {
      meta.schema_version = static_cast<int>(parse_int(rows.bytes(1)).value_or(0));
    } else if (key == "state") {
      meta.state = rows.text(1);
    } else if (key == "digest") {
      meta.digest = rows.text(1);
    } else if (key.starts_with(kDigest)) {
      meta.table_digests[key.substr(kDigest.size())] = rows.text(1);
    } else if (key != "schema_digest" && key != kFileDigestKey) {
      meta.values[key] = rows.text(1);
    }
  }
  return meta;
}

std::string map_digest(const std::filesystem::path& path) {
  return verified_digests(open_map_file(path)).content;
}

}  // namespace roadbook
