#include "mapping/store/rtree_check.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

namespace roadbook {
namespace {

using Bounds = std::array<double, 4>;  // least x, greatest x, least y, greatest y

constexpr std::size_t kHeaderBytes = 8;     // of a GeoPackage geometry: magic, version, flags, SRS
constexpr std::size_t kWkbHeaderBytes = 5;  // byte order, type

double number_at(std::string_view bytes, std::size_t offset) {
  double value = NAN;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

// Returns the bounds that a geometry's header states, or those of a point; empty for other kinds of
// geometry without stated bounds and for big-endian ones, which roadbook does not write.
std::optional<Bounds> bounds_of(std::string_view geometry) {
  static_assert(std::endian::native == std::endian::little);
  if (geometry.size() < kHeaderBytes || geometry.substr(0, 2) != "GP") return std::nullopt;
  const auto flags = static_cast<unsigned char>(geometry[3]);
  const bool has_bounds = ((flags >> 1U) & 7U) != 0;
  if ((flags & 1U) == 0) return std::nullopt;
  if (has_bounds) {
    if (geometry.size() < kHeaderBytes + 4 * sizeof(double)) return std::nullopt;
    Bounds bounds{};
    for (std::size_t i = 0; i < bounds.size(); ++i)
      bounds[i] = number_at(geometry, kHeaderBytes + i * sizeof(double));
    return bounds;
  }
  const std::size_t begin = kHeaderBytes + kWkbHeaderBytes;
  if (geometry.size() < begin + 2 * sizeof(double) || geometry[kHeaderBytes] != 1)
    return std::nullopt;
  std::uint32_t kind = 0;
  std::memcpy(&kind, geometry.data() + kHeaderBytes + 1, sizeof(kind));
  if ((kind & 0x0fffffffU) % 1000 != 1) return std::nullopt;
  const double x = number_at(geometry, begin);
  const double y = number_at(geometry, begin + sizeof(double));
  return Bounds{x, x, y, y};
}

// An R-tree keeps float32, rounded outwards.
bool fit(const Bounds& geometry, const Bounds& entry) {
  for (std::size_t i = 0; i < geometry.size(); ++i) {
    const double outwards = i % 2 == 0 ? geometry[i] - entry[i] : entry[i] - geometry[i];
    const double step = 1e-6 * std::abs(geometry[i]) + 1e-30;
    if (!(outwards >= 0.0 && outwards <= step)) return false;
  }
  return true;
}

std::string fault_of(const SqlDatabase& database,
                     const std::string& rtree,
                     const std::string& table,
                     const std::string& column) {
  SqlStatement check = database.prepare("SELECT rtreecheck('main', ?)");
  check.bind_text(1, rtree);
  std::string fault = check.step() ? check.text(0) : "no answer";
  if (fault != "ok") return fault.substr(0, fault.find('\n'));
  SqlStatement key =
      database.prepare("SELECT name FROM pragma_table_info(?) WHERE pk = 1 AND type = 'INTEGER'");
  key.bind_text(1, table);
  if (!key.step()) return "a table without ids";
  const std::string id = key.text(0);
  SqlStatement entry =
      database.prepare("SELECT minx, maxx, miny, maxy FROM " + sql_name(rtree) + " WHERE id = ?");
  SqlStatement rows =
      database.prepare("SELECT " + sql_name(id) + ", " + sql_name(column) + " FROM " +
                       sql_name(table) + " WHERE " + sql_name(column) + " NOT NULL");
  std::int64_t features = 0;
  for (; rows.step(); ++features) {
    const auto bounds = bounds_of(rows.bytes(1));
    entry.reset();
    entry.bind(1, rows.integer(0));
    if (!entry.step()) return "no entry of feature " + rows.text(0);
    if (bounds && !fit(*bounds, {entry.real(0), entry.real(1), entry.real(2), entry.real(3)}))
      return "other bounds than feature " + rows.text(0);
  }
  if (database.value("SELECT count(*) FROM " + sql_name(rtree)) != std::to_string(features))
    return "entries of no feature";
  return {};
}

}  // namespace

std::vector<Problem> rtree_problems(const SqlDatabase& database) {
  std::vector<Problem> problems;
  SqlStatement layers =
      database.prepare("SELECT table_name, column_name FROM gpkg_geometry_columns ORDER BY 1");
  SqlStatement there =
      database.prepare("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?");
  while (layers.step()) {
    const std::string rtree = "rtree_" + layers.text(0) + "_" + layers.text(1);
    there.reset();
    there.bind_text(1, rtree);
    if (!there.step() || there.integer(0) == 0) continue;
    const std::string fault = fault_of(database, rtree, layers.text(0), layers.text(1));
    if (!fault.empty())
      problems.push_back({Severity::kError, database.file().string(), 0, rtree, fault,
                          "the R-tree of the layer's geometries"});
  }
  return problems;
}

}  // namespace roadbook
