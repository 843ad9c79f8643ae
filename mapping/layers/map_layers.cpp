#include "mapping/layers/map_layers.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"
#include "mapping/layers/map_layers_raster.hpp"
#include "mapping/layers/map_layers_table.hpp"
#include "mapping/layers/stored_vector.hpp"
#include "mapping/store/map_file_open.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {
namespace {

// Everything in gpkg_contents but features and attributes is made of tiles, under several names.
constexpr bool kVector = true;
constexpr bool kRaster = false;

std::vector<std::string> names_in(const SqlDatabase& database) {
  const auto& own = map_table_names();
  std::vector<std::string> names;
  SqlStatement rows = database.prepare(
      "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT GLOB 'gpkg_*' AND name NOT "
      "GLOB 'rtree_*' AND name NOT GLOB 'sqlite_*' AND name != 'map_meta' ORDER BY name");
  while (rows.step())
    if (std::find(own.begin(), own.end(), rows.text(0)) == own.end()) names.push_back(rows.text(0));
  return names;
}

}  // namespace

struct MapLayers::Impl {
  Impl(const std::filesystem::path& map, VerifiedPart part)
      : verified(part),
        database(part == VerifiedPart::kAll ? open_verified(map) : open_registries(map)) {}

  // A name without a table is left to the reader.
  void verify(const std::string& table) {
    if (verified != VerifiedPart::kWhatIsRead || right.contains(table)) return;
    SqlStatement found =
        database.prepare("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?");
    found.bind_text(1, table);
    if (!found.step() || found.integer(0) == 0) return;
    verify_table(database, table);
    right.insert(table);
  }

  void require(const std::string& name, bool vector) {
    SqlStatement found = database.prepare(
        "SELECT count(*) FROM gpkg_contents WHERE table_name = ? AND (data_type = 'features') = ? "
        "AND data_type != 'attributes'");
    found.bind_text(1, name).bind(2, vector ? 1 : 0);
    if (found.step() && found.integer(0) == 1) return verify(name);
    std::vector<std::string> names;
    SqlStatement rows = database.prepare(
        "SELECT table_name FROM gpkg_contents WHERE (data_type = 'features') = ? AND data_type != "
        "'attributes'");
    rows.bind(1, vector ? 1 : 0);
    while (rows.step()) names.push_back(rows.text(0));
    const auto nearest = nearest_name(name, names);
    throw BadInput(Problem{Severity::kError, database.file().string(), 0, "layer", name,
                           nearest ? *nearest : "a layer of this map"});
  }

  VerifiedPart verified;
  SqlDatabase database;
  std::set<std::string> right;  // tables that were verified
};

MapLayers::MapLayers(const std::filesystem::path& map, VerifiedPart verified)
    : impl_(std::make_unique<Impl>(map, verified)) {}
MapLayers::MapLayers(MapLayers&&) noexcept = default;
MapLayers& MapLayers::operator=(MapLayers&&) noexcept = default;
MapLayers::~MapLayers() = default;

const std::filesystem::path& MapLayers::file() const { return impl_->database.file(); }

std::vector<LayerInfo> MapLayers::list() const {
  std::vector<LayerInfo> layers;
  SqlStatement rows = impl_->database.prepare(
      "SELECT table_name, coalesce(description, ''), data_type != 'features' FROM gpkg_contents "
      "WHERE data_type != 'attributes' "
      "ORDER BY table_name");
  while (rows.step()) layers.push_back({rows.text(0), rows.text(1), rows.integer(2) != 0});
  return layers;
}

bool MapLayers::has(const std::string& name) const {
  SqlStatement row = impl_->database.prepare(
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?");
  row.bind_text(1, name);
  return row.step() && row.integer(0) == 1;
}

std::vector<std::string> MapLayers::all_names() const { return names_in(impl_->database); }

std::vector<std::string> layer_names(const std::filesystem::path& map) {
  return names_in(open_registries(map));
}

VectorLayer MapLayers::read_layer(const std::string& name) const {
  impl_->require(name, kVector);
  return read_stored_vector(impl_->database, name);
}

RasterInfo MapLayers::raster_info(const std::string& name) const {
  impl_->require(name, kRaster);
  return geopackage_raster_info(file(), name);
}

cv::Mat MapLayers::read_raster(const std::string& name, const RasterWindow& window) const {
  impl_->require(name, kRaster);
  return read_geopackage_raster(file(), name, window);
}

PlainTable MapLayers::read_table(const std::string& name) const {
  impl_->verify(name);
  return read_plain_table(impl_->database, name);
}

}  // namespace roadbook
