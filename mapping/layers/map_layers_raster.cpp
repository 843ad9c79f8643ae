#include "mapping/layers/map_layers_raster.hpp"

#include <gdal_utils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "mapping/store/map_file_open.hpp"

namespace roadbook {
namespace {

using GeoTransform = std::array<double, 6>;

GeoTransform transform_of(GDALDataset& dataset, const std::filesystem::path& file) {
  GeoTransform t{};
  if (dataset.GetGeoTransform(t.data()) != CE_None)
    refuse_file(file, "geotransform", "none", "a raster in map coordinates");
  const bool north_up = t[2] == 0.0 && t[4] == 0.0 && t[1] > 0.0;
  // Square pixels: what a resolution in metres can describe.
  if (!north_up || !(std::abs(t[1] + t[5]) <= 1e-9 * t[1]))
    refuse_file(file, "geotransform", "rotated or oblong pixels",
                "square pixels, rows from north to south");
  return t;
}

/// The same pixels in the coordinate system of the map. Rasters come in map coordinates, whatever
/// their file says: GeoTIFFs of earlier versions name another datum.
GdalDataset in_map_frame(GDALDataset& source) {
  CPLStringList options;
  for (const char* word : {"-of", "VRT", "-a_srs", map_crs_wkt().c_str()}) options.AddString(word);
  GDALTranslateOptions* const parsed = GDALTranslateOptionsNew(options.List(), nullptr);
  GDALDatasetH view = GDALTranslate("", GDALDataset::ToHandle(&source), parsed, nullptr);
  GDALTranslateOptionsFree(parsed);
  return GdalDataset(GDALDataset::FromHandle(view));
}

/// GeoPackage holds 8-bit images, or one band of numbers.
void check_type(GDALDataset& dataset, const std::filesystem::path& file) {
  const int bands = dataset.GetRasterCount();
  if (bands < 1) refuse_file(file, "bands", "0", "1 to 4");
  const GDALDataType type = dataset.GetRasterBand(1)->GetRasterDataType();
  const bool image = type == GDT_Byte && bands <= 4;
  const bool numbers = (type == GDT_UInt16 || type == GDT_Float32) && bands == 1;
  if (!image && !numbers)
    refuse_file(file, "bands", std::to_string(bands) + " of " + GDALGetDataTypeName(type),
                "1 to 4 of Byte, or 1 of UInt16 or Float32");
}

int cv_depth(GDALDataType type, const std::filesystem::path& file) {
  switch (type) {
    case GDT_Byte:
      return CV_8U;
    case GDT_UInt16:
      return CV_16U;
    case GDT_Float32:
      return CV_32F;
    default:
      refuse_file(file, "raster type", GDALGetDataTypeName(type), "Byte, UInt16 or Float32");
  }
}

void check_window(const RasterWindow& w, int width, int height) {
  const bool inside = w.column >= 0 && w.row >= 0 && w.width > 0 && w.height > 0 &&
                      w.width <= width - w.column && w.height <= height - w.row;
  if (inside) return;
  throw InvalidOption("raster window",
                      std::to_string(w.column) + "," + std::to_string(w.row) + " " +
                          std::to_string(w.width) + "x" + std::to_string(w.height),
                      "within " + std::to_string(width) + "x" + std::to_string(height));
}

}  // namespace

GdalDataset open_raster_layer(const GdalScope& scope,
                              const std::filesystem::path& file,
                              const std::string& name) {
  const std::string address = "GPKG:" + file.string() + ":" + name;
  const std::array<const char*, 2> drivers{"GPKG", nullptr};
  GdalDataset dataset(
      GDALDataset::Open(address.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data()));
  if (dataset == nullptr)
    refuse_file(file, "raster " + name, scope.fault(), "a readable raster layer");
  return dataset;
}

void build_overviews(const GdalScope& scope,
                     GDALDataset& dataset,
                     int tile_px,
                     const std::filesystem::path& file) {
  std::vector<int> factors;
  const int longest = std::max(dataset.GetRasterXSize(), dataset.GetRasterYSize());
  for (int factor = 2; longest > factor / 2 * tile_px; factor *= 2) factors.push_back(factor);
  if (factors.empty()) return;
  const CPLErr code = dataset.BuildOverviews("AVERAGE", static_cast<int>(factors.size()),
                                             factors.data(), 0, nullptr, nullptr, nullptr);
  scope.require(code == CE_None, file, "overviews");
}

void write_geopackage_raster(const std::filesystem::path& file,
                             const std::string& name,
                             const std::filesystem::path& geotiff,
                             const RasterLayerOptions& options,
                             const std::string& content_time) {
  const GdalScope scope(content_time);
  const std::array<const char*, 2> drivers{"GTiff", nullptr};
  const GdalDataset source(
      GDALDataset::Open(geotiff.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data()));
  if (source == nullptr) refuse_file(geotiff, "geotiff", scope.fault(), "a readable GeoTIFF");
  (void)transform_of(*source, geotiff);
  check_type(*source, geotiff);
  const bool image = source->GetRasterBand(1)->GetRasterDataType() == GDT_Byte;

  CPLStringList creation;
  creation.SetNameValue("APPEND_SUBDATASET", "YES");
  creation.SetNameValue("RASTER_TABLE", name.c_str());
  creation.SetNameValue("BLOCKSIZE", std::to_string(options.tile_px).c_str());
  creation.SetNameValue("RASTER_DESCRIPTION", options.description.c_str());
  creation.SetNameValue("TILE_FORMAT", image ? "PNG" : "TIFF");
  const GdalDataset placed = in_map_frame(*source);
  scope.require(placed != nullptr, file, "raster " + name);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  GdalDataset target(
      driver->CreateCopy(file.c_str(), placed.get(), 0, creation.List(), nullptr, nullptr));
  scope.require(target != nullptr, file, "raster " + name);
  build_overviews(scope, *target, options.tile_px, file);
  target.reset();
  scope.check(file, "raster " + name);
}

RasterInfo geopackage_raster_info(const std::filesystem::path& file, const std::string& name) {
  const GdalScope scope;
  const GdalDataset dataset = open_raster_layer(scope, file, name);
  const GeoTransform t = transform_of(*dataset, file);
  return {dataset->GetRasterXSize(),
          dataset->GetRasterYSize(),
          dataset->GetRasterCount(),
          {t[0], t[3]},
          t[1]};
}

cv::Mat read_geopackage_raster(const std::filesystem::path& file,
                               const std::string& name,
                               const RasterWindow& window) {
  const GdalScope scope;
  const GdalDataset dataset = open_raster_layer(scope, file, name);
  check_window(window, dataset->GetRasterXSize(), dataset->GetRasterYSize());
  const int bands = dataset->GetRasterCount();
  const GDALDataType type = dataset->GetRasterBand(1)->GetRasterDataType();
  cv::Mat pixels(window.height, window.width, CV_MAKETYPE(cv_depth(type, file), bands));
  const auto element = static_cast<GSpacing>(pixels.elemSize());
  const CPLErr code = dataset->RasterIO(
      GF_Read, window.column, window.row, window.width, window.height, pixels.data, window.width,
      window.height, type, bands, nullptr, element, static_cast<GSpacing>(pixels.step),
      static_cast<GSpacing>(pixels.elemSize1()), nullptr);
  if (code != CE_None || !scope.fault().empty())
    refuse_file(file, "raster " + name, scope.fault(), "tiles that can be decoded");
  return pixels;
}

}  // namespace roadbook
