#include "exchange/layers/occupancy_layers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "exchange/layers/packed_numbers.hpp"
#include "exchange/layers/table_row.hpp"
#include "exchange/layers/value_raster.hpp"
#include "mapping/occupancy/cell_rules.hpp"

namespace roadbook {
namespace {

constexpr const char* kWantOccupancy = "an occupancy grid (roadbook occupancy writes it)";
constexpr std::array<std::pair<OccupancyUpdate, const char*>, 3> kUpdates{
    {{OccupancyUpdate::kLogOdds, "log-odds"},
     {OccupancyUpdate::kBayes, "bayes"},
     {OccupancyUpdate::kNaive, "naive"}}};

std::vector<std::uint16_t> ends_of(const OccupancyPatch& patch) {
  return patch.ends.empty() ? std::vector<std::uint16_t>(patch.hits.size(), 0) : patch.ends;
}

PlainTable patch_table(const std::vector<OccupancyPatch>& patches) {
  PlainTable table;
  table.name = "occupancy_patches";
  table.fields = {{"session", FieldType::kText},
                  {"t_ns", FieldType::kInteger},
                  {"drive", FieldType::kText},
                  {"begin_ns", FieldType::kInteger},
                  {"end_ns", FieldType::kInteger},
                  {"x_m", FieldType::kReal},
                  {"y_m", FieldType::kReal},
                  {"heading_rad", FieldType::kReal},
                  {"placed_x_m", FieldType::kReal},
                  {"placed_y_m", FieldType::kReal},
                  {"placed_heading_rad", FieldType::kReal},
                  {"cell_m", FieldType::kReal},
                  {"rows", FieldType::kInteger},
                  {"columns", FieldType::kInteger},
                  {"log_odds", FieldType::kBytes},
                  {"seen", FieldType::kBytes},
                  {"hits", FieldType::kBytes},
                  {"ends", FieldType::kBytes}};
  for (const OccupancyPatch& p : patches)
    table.rows.push_back(
        {p.session, p.t_ns, p.drive, p.begin_ns, p.end_ns, p.vehicle_patch.x_m, p.vehicle_patch.y_m,
         p.vehicle_patch.heading_rad, p.placed.x_m, p.placed.y_m, p.placed.heading_rad, p.cell_m,
         std::int64_t{p.rows}, std::int64_t{p.columns}, packed_numbers<std::int16_t>(p.log_odds),
         packed_numbers<std::uint16_t>(p.seen), packed_numbers<std::uint16_t>(p.hits),
         packed_numbers<std::uint16_t>(ends_of(p))});
  return table;
}

PlainTable settings_of(const StoredOccupancy& stored) {
  PlainTable table;
  table.name = "occupancy_settings";
  table.fields = {{"drive", FieldType::kText},
                  {"drive_digest", FieldType::kText},
                  {"sensor", FieldType::kText},
                  {"model", FieldType::kText},
                  {"localised", FieldType::kInteger},
                  {"begin_ns", FieldType::kInteger},
                  {"end_ns", FieldType::kInteger},
                  {"scans", FieldType::kInteger},
                  {"max_m", FieldType::kReal},
                  {"cone_rad", FieldType::kReal},
                  {"temper", FieldType::kReal},
                  {"hit", FieldType::kReal},
                  {"short", FieldType::kReal},
                  {"maximum", FieldType::kReal},
                  {"crosstalk", FieldType::kReal},
                  {"sigma_m", FieldType::kReal},
                  {"wide", FieldType::kReal},
                  {"short_rate_per_m", FieldType::kReal},
                  {"cell_m", FieldType::kReal},
                  {"surfaces_per_m", FieldType::kReal},
                  {"prior", FieldType::kReal},
                  {"updating", FieldType::kText},
                  {"updates", FieldType::kReal},
                  {"sights_raised", FieldType::kReal},
                  {"sights_raised_free", FieldType::kReal}};
  for (const OccupancyDrive& d : stored.drives) {
    const RangeMixture& m = d.mixture;
    table.rows.push_back({d.drive,
                          d.digest,
                          d.sensor,
                          d.model,
                          std::int64_t{d.localised ? 1 : 0},
                          d.begin_ns,
                          d.end_ns,
                          d.scans,
                          d.max_m,
                          d.cone_rad,
                          d.temper,
                          m.hit(),
                          m.share[kShort],
                          m.share[kMaximum],
                          m.share[kCrosstalk],
                          m.sigma_m,
                          m.wide,
                          m.short_rate_per_m,
                          stored.cell_m,
                          stored.surfaces_per_m,
                          stored.prior,
                          std::string(to_text(stored.update)),
                          static_cast<double>(d.updates),
                          finite_or_null(d.sights_raised),
                          finite_or_null(d.sights_raised_free)});
  }
  return table;
}

// A raster over the grid: value(cell) where a reading reached the cell.
template <typename Value>
ValueRaster raster_of(const OccupancyGrid& grid, const Value& value) {
  const CellShape& shape = grid.shape;
  ValueRaster raster;
  raster.place.resolution_m = shape.cell_m;
  raster.place.west_m = shape.low.x();
  raster.place.north_m = shape.low.y() + shape.rows * shape.cell_m;
  raster.place.columns = shape.columns;
  raster.place.rows = shape.rows;
  raster.values.assign(shape.size(), NAN);
  for (int r = 0; r < shape.rows; ++r)
    for (int c = 0; c < shape.columns; ++c) {
      const std::size_t cell = shape.index(c, r);
      if (grid.seen[cell] > 0)
        raster.values[shape.index(c, shape.rows - 1 - r)] = static_cast<float>(value(cell));
    }
  return raster;
}

void write_occupancy_rasters(MapUpdate& update,
                             const StoredOccupancy& stored,
                             const OccupancyGrid& grid) {
  const double prior = stored.prior_log_odds();
  std::int64_t newest = 0;
  for (const OccupancyPatch& p : stored.patches) newest = std::max(newest, p.end_ns);
  const ValueRaster probability =
      raster_of(grid, [&](std::size_t i) { return grid.probability(i, prior); });
  write_value_raster(update, "occupancy", "probability that a cell is occupied", probability);
  write_value_raster(update, "occupancy_sigma", "standard deviation of the probability",
                     raster_of(grid, [&](std::size_t i) { return grid.sigma(i, prior); }));
  write_value_raster(update, "occupancy_age", "age before the newest reading [s]",
                     raster_of(grid, [&](std::size_t i) {
                       const auto patch = static_cast<std::size_t>(grid.newest[i]);
                       return 1e-9 * static_cast<double>(newest - stored.patches[patch].end_ns);
                     }));
  write_value_raster(update, "occupancy_coverage", "readings that reached the cell",
                     raster_of(grid, [&](std::size_t i) { return grid.seen[i]; }));
  write_value_raster(update, "occupancy_sessions", "drives that saw the cell",
                     raster_of(grid, [&](std::size_t i) { return grid.drives[i]; }));
  write_colour_raster(update, "occupancy_colours",
                      "occupancy: dark where free, yellow where occupied", probability, 0.0, 1.0);
}

OccupancyDrive drive_from(const TableRow& row) {
  OccupancyDrive d;
  d.drive = row.get<std::string>("drive");
  d.digest = row.get<std::string>("drive_digest");
  d.sensor = row.get<std::string>("sensor");
  d.model = row.get<std::string>("model");
  d.localised = row.get<std::int64_t>("localised") != 0;
  d.begin_ns = row.get<std::int64_t>("begin_ns");
  d.end_ns = row.get<std::int64_t>("end_ns");
  d.scans = row.get<std::int64_t>("scans");
  d.max_m = row.get<double>("max_m");
  d.cone_rad = row.get<double>("cone_rad");
  d.temper = row.get<double>("temper");
  // Grids of earlier versions do not have these three.
  d.updates = static_cast<std::int64_t>(row.number("updates", 0.0));
  d.sights_raised = row.number("sights_raised", NAN);
  d.sights_raised_free = row.number("sights_raised_free", NAN);
  d.mixture.share = {row.get<double>("short"), row.get<double>("maximum"),
                     row.get<double>("crosstalk"), 0.0};
  d.mixture.sigma_m = row.get<double>("sigma_m");
  d.mixture.wide = row.get<double>("wide");
  d.mixture.short_rate_per_m = row.get<double>("short_rate_per_m");
  return d;
}

template <typename Number>
std::vector<Number> numbers_from(const TableRow& row, const char* column, std::size_t count) {
  auto numbers = unpacked_numbers<Number>(row.get<Bytes>(column), count);
  if (!numbers) row.fail(column, "other bytes than " + std::to_string(count) + " packed numbers");
  return std::move(*numbers);
}

OccupancyPatch patch_from(const TableRow& row, double cell_m) {
  OccupancyPatch p;
  p.session = row.get<std::string>("session");
  p.t_ns = row.get<std::int64_t>("t_ns");
  p.drive = row.get<std::string>("drive");
  p.begin_ns = row.get<std::int64_t>("begin_ns");
  p.end_ns = row.get<std::int64_t>("end_ns");
  p.vehicle_patch = {row.get<double>("x_m"), row.get<double>("y_m"),
                     row.get<double>("heading_rad")};
  p.placed = {row.get<double>("placed_x_m"), row.get<double>("placed_y_m"),
              row.get<double>("placed_heading_rad")};
  for (const double number : {p.vehicle_patch.x_m, p.vehicle_patch.y_m, p.placed.x_m, p.placed.y_m})
    if (!(std::abs(number) < 1e7)) row.fail("x_m", std::to_string(number));
  p.cell_m = row.get<double>("cell_m");
  if (p.cell_m != cell_m) row.fail("cell_m", std::to_string(p.cell_m));
  const std::int64_t rows = row.get<std::int64_t>("rows");
  const std::int64_t columns = row.get<std::int64_t>("columns");
  constexpr std::int64_t kMost = 16384;
  if (rows < 1 || rows >= kMost) row.fail("rows", std::to_string(rows));
  if (columns < 1 || columns >= kMost) row.fail("columns", std::to_string(columns));
  p.rows = static_cast<int>(rows);
  p.columns = static_cast<int>(columns);
  const auto count = static_cast<std::size_t>(rows * columns);
  p.log_odds = numbers_from<std::int16_t>(row, "log_odds", count);
  p.seen = numbers_from<std::uint16_t>(row, "seen", count);
  p.hits = numbers_from<std::uint16_t>(row, "hits", count);
  // Grids of earlier versions do not have the ends.
  if (row.has("ends")) p.ends = numbers_from<std::uint16_t>(row, "ends", count);
  return p;
}

}  // namespace

double StoredOccupancy::prior_log_odds() const { return log_odds(prior); }

std::map<std::string, ReadingWeight> StoredOccupancy::reading_weights() const {
  std::map<std::string, ReadingWeight> by_drive;
  for (const OccupancyDrive& d : drives) by_drive[d.drive] = {d.temper, d.sensor == "cameras"};
  return by_drive;
}

const char* to_text(OccupancyUpdate update) {
  for (const auto& [one, text] : kUpdates)
    if (one == update) return text;
  return "";
}

std::optional<OccupancyUpdate> occupancy_update(const std::string& text) {
  for (const auto& [one, name] : kUpdates)
    if (text == name) return one;
  return std::nullopt;
}

void write_occupancy_layers(MapUpdate& update,
                            const StoredOccupancy& stored,
                            const OccupancyGrid& grid) {
  update.write_table(patch_table(stored.patches));
  update.write_table(settings_of(stored));
  write_occupancy_rasters(update, stored, grid);
}

std::optional<StoredOccupancy> read_occupancy_layers(const MapLayers& layers) {
  if (!layers.has("occupancy_settings") || !layers.has("occupancy_patches")) return std::nullopt;
  const std::string file = layers.file().string();
  const PlainTable settings = layers.read_table("occupancy_settings");
  if (settings.rows.empty()) return std::nullopt;
  StoredOccupancy stored;
  for (const auto& values : settings.rows) {
    const TableRow row(file, settings.name, settings.fields, values, kWantOccupancy);
    stored.drives.push_back(drive_from(row));
    stored.cell_m = row.get<double>("cell_m");
    stored.surfaces_per_m = row.get<double>("surfaces_per_m");
    stored.prior = row.get<double>("prior");
    if (!(stored.cell_m > 0.0)) row.fail("cell_m", std::to_string(stored.cell_m));
    if (!(stored.surfaces_per_m > 0.0))
      row.fail("surfaces_per_m", std::to_string(stored.surfaces_per_m));
    if (!(stored.prior > 0.0 && stored.prior < 1.0))
      row.fail("prior", std::to_string(stored.prior));
    const auto updating = occupancy_update(row.get<std::string>("updating"));
    if (!updating) row.fail("updating", row.get<std::string>("updating"));
    stored.update = *updating;
  }
  const PlainTable patches = layers.read_table("occupancy_patches");
  for (const auto& values : patches.rows)
    stored.patches.push_back(patch_from(
        TableRow(file, patches.name, patches.fields, values, kWantOccupancy), stored.cell_m));
  return stored;
}

}  // namespace roadbook
