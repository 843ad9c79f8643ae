#include "mapping/layers/stored_vector.hpp"

#include <array>
#include <utility>

#include "base/error.hpp"
#include "mapping/store/map_file_codec.hpp"

namespace roadbook {
namespace {

struct StoredGeometry {
  GeometryType type;
  const char* name;  // in gpkg_geometry_columns
  bool measured;
  std::uint32_t code;  // of well-known binary (ISO 13249-3)
};
constexpr std::array<StoredGeometry, 4> kStored{
    {{GeometryType::kPointZ, "POINT", false, 1001},
     {GeometryType::kPointZM, "POINT", true, 3001},
     {GeometryType::kLineStringZ, "LINESTRING", false, 1002},
     {GeometryType::kPolygonZ, "POLYGON", false, 1003}}};
constexpr std::array<std::pair<const char*, FieldType>, 4> kColumns{
    {{"INTEGER", FieldType::kInteger},
     {"REAL", FieldType::kReal},
     {"TEXT", FieldType::kText},
     {"BLOB", FieldType::kBytes}}};

/// Reads numbers one after the other and refuses to go beyond the end.
class GeometryBytes {
 public:
  GeometryBytes(std::string_view bytes, std::string file, std::string layer)
      : bytes_(bytes), file_(std::move(file)), layer_(std::move(layer)) {}

  template <typename T>
  T next() {
    need(sizeof(T));
    const T value = unpack<T>(bytes_, at_);
    at_ += sizeof(T);
    return value;
  }
  void skip(std::size_t count) {
    need(count);
    at_ += count;
  }
  void need(std::size_t count) const {
    if (count > bytes_.size() - at_) refuse(std::to_string(bytes_.size()) + " bytes");
  }
  [[noreturn]] void refuse(const std::string& got) const {
    throw BadInput(Problem{Severity::kError, file_, 0, "layer " + layer_, got,
                           "a geometry that roadbook writes"});
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::string file_;
  std::string layer_;
};

/// The header of a geometry in a GeoPackage (section 2.1.3 of its standard).
void skip_header(GeometryBytes& bytes) {
  constexpr std::array<std::size_t, 5> kEnvelopes{0, 32, 48, 48, 64};
  if (bytes.next<char>() != 'G' || bytes.next<char>() != 'P')
    bytes.refuse("no GeoPackage geometry");
  bytes.skip(1);
  const auto flags = bytes.next<std::uint8_t>();
  const std::size_t envelope = (flags >> 1) & 7U;
  if ((flags & 1U) == 0 || envelope >= kEnvelopes.size())
    bytes.refuse("flags " + std::to_string(flags));
  bytes.skip(sizeof(std::int32_t) + kEnvelopes[envelope]);
}

std::vector<Eigen::Vector4d> points_in(GeometryBytes& bytes, const StoredGeometry& geometry) {
  skip_header(bytes);
  if (bytes.next<std::uint8_t>() != 1) bytes.refuse("big-endian numbers");
  if (const auto code = bytes.next<std::uint32_t>(); code != geometry.code)
    bytes.refuse("geometry " + std::to_string(code));
  std::size_t count = 1;
  if (geometry.type == GeometryType::kPolygonZ && bytes.next<std::uint32_t>() == 0) return {};
  if (geometry.type == GeometryType::kLineStringZ || geometry.type == GeometryType::kPolygonZ)
    count = bytes.next<std::uint32_t>();
  bytes.need(count * (geometry.measured ? 4 : 3) * sizeof(double));
  std::vector<Eigen::Vector4d> points(count, Eigen::Vector4d::Zero());
  for (Eigen::Vector4d& p : points)
    for (int axis = 0; axis < (geometry.measured ? 4 : 3); ++axis) p[axis] = bytes.next<double>();
  return points;
}

FieldValue value_of(const SqlStatement& row, int column, FieldType type) {
  if (row.type(column) == SQLITE_NULL) return std::monostate{};
  if (type == FieldType::kInteger) return row.integer(column);
  if (type == FieldType::kReal) return row.real(column);
  if (type == FieldType::kText) return row.text(column);
  const std::string_view bytes = row.bytes(column);
  return Bytes(bytes.begin(), bytes.end());
}

/// A layer without features, and how its geometries are stored.
struct DescribedLayer {
  VectorLayer layer;
  StoredGeometry geometry{};
  std::string columns;  // of geometry and fields, for SQL
};

[[noreturn]] void refuse_type(const SqlDatabase& database,
                              const std::string& layer,
                              const std::string& got) {
  throw BadInput(Problem{Severity::kError, database.file().string(), 0, "layer " + layer, got,
                         "a type that roadbook writes"});
}

DescribedLayer described(const SqlDatabase& database, const std::string& name) {
  DescribedLayer result;
  result.layer.name = name;
  SqlStatement row = database.prepare(
      "SELECT g.column_name, g.geometry_type_name, g.z, g.m, coalesce(c.description, '') FROM "
      "gpkg_geometry_columns g JOIN gpkg_contents c USING (table_name) WHERE table_name = ?");
  row.bind_text(1, name);
  if (!row.step()) refuse_type(database, name, "no geometry");
  const std::string geometry_column = row.text(0);
  result.layer.description = row.text(4);
  bool known = false;
  for (const StoredGeometry& stored : kStored)
    if (row.text(1) == stored.name && row.integer(2) == 1 &&
        (row.integer(3) == 1) == stored.measured) {
      result.geometry = stored;
      known = true;
    }
  if (!known)
    refuse_type(database, name, row.text(1) + ", z " + row.text(2) + ", m " + row.text(3));
  result.layer.type = result.geometry.type;
  result.columns = sql_name(geometry_column);
  SqlStatement columns = database.prepare("SELECT name, type, pk FROM pragma_table_info(?)");
  columns.bind_text(1, name);
  while (columns.step()) {
    if (columns.integer(2) != 0 || columns.bytes(0) == geometry_column) continue;
    known = false;
    for (const auto& [sql, type] : kColumns)
      if (columns.bytes(1) == sql) {
        result.layer.fields.push_back({columns.text(0), type});
        known = true;
      }
    if (!known) refuse_type(database, name, columns.text(0) + " of another type");
    result.columns += ", " + sql_name(columns.bytes(0));
  }
  return result;
}

}  // namespace

VectorLayer read_stored_vector(const SqlDatabase& database, const std::string& name) {
  auto [layer, geometry, columns] = described(database, name);
  SqlStatement rows =
      database.prepare("SELECT " + columns + " FROM " + sql_name(name) + " ORDER BY rowid");
  while (rows.step()) {
    Feature feature;
    if (rows.type(0) != SQLITE_NULL) {
      GeometryBytes bytes(rows.bytes(0), database.file().string(), name);
      feature.points = points_in(bytes, geometry);
    }
    for (std::size_t i = 0; i < layer.fields.size(); ++i)
      feature.values.push_back(value_of(rows, static_cast<int>(i) + 1, layer.fields[i].type));
    layer.features.push_back(std::move(feature));
  }
  return std::move(layer);
}

}  // namespace roadbook
