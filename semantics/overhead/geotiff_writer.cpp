#include "semantics/overhead/geotiff_writer.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <vector>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {
namespace {

GDALDataType gdal_type(PixelType type) {
  switch (type) {
    case PixelType::kByte:
      return GDT_Byte;
    case PixelType::kUInt16:
      return GDT_UInt16;
    case PixelType::kUInt32:
      return GDT_UInt32;
    case PixelType::kFloat32:
      return GDT_Float32;
  }
  return GDT_Unknown;
}

[[noreturn]] void fail(const std::filesystem::path& path, const char* what) {
  const std::string disk = write_fault(path);
  throw StorageError("error: " + path.string() + ": " + what + ": got " +
                     (disk.starts_with("no space") ? disk : CPLGetLastErrorMsg()) +
                     ", want a disk that takes it");
}

}  // namespace

struct GeoTiffWriter::Impl {
  std::filesystem::path path;
  RasterPlace place;
  int bands = 1;
  GDALDataset* dataset = nullptr;

  ~Impl() {
    if (dataset != nullptr) GDALClose(dataset);
  }
};

GeoTiffWriter::GeoTiffWriter(const std::filesystem::path& path,
                             const RasterPlace& place,
                             PixelType type,
                             int bands,
                             double nodata,
                             const std::string& description)
    : impl_(std::make_unique<Impl>()) {
  static std::once_flag registered;
  std::call_once(registered, [] {
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);  // our own messages report the error
  });
  impl_->path = path;
  impl_->place = place;
  impl_->bands = bands;
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) fail(path, "GDAL has no GeoTIFF driver");
  const std::string block = std::to_string(kBlock);
  const std::string predictor = type == PixelType::kFloat32 ? "PREDICTOR=3" : "PREDICTOR=2";
  CPLStringList options;
  options.AddString("TILED=YES");
  options.AddString(("BLOCKXSIZE=" + block).c_str());
  options.AddString(("BLOCKYSIZE=" + block).c_str());
  options.AddString("COMPRESS=DEFLATE");
  options.AddString("ZLEVEL=4");
  options.AddString(predictor.c_str());
  options.AddString("SPARSE_OK=TRUE");
  options.AddString("BIGTIFF=IF_SAFER");
  options.AddString("INTERLEAVE=BAND");
  impl_->dataset = driver->Create(path.c_str(), place.columns, place.rows, bands, gdal_type(type),
                                  options.List());
  if (impl_->dataset == nullptr) fail(path, "cannot be created");
  std::array<double, 6> transform{place.west_m, place.resolution_m, 0.0, place.north_m,
                                  0.0,          -place.resolution_m};
  OGRSpatialReference crs;
  if (impl_->dataset->SetGeoTransform(transform.data()) != CE_None ||
      crs.importFromWkt(map_crs_wkt().c_str()) != OGRERR_NONE ||
      impl_->dataset->SetSpatialRef(&crs) != CE_None)
    fail(path, "georeference cannot be written");
  impl_->dataset->SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", description.c_str());
  for (int band = 1; band <= bands; ++band)
    impl_->dataset->GetRasterBand(band)->SetNoDataValue(nodata);
}

GeoTiffWriter::~GeoTiffWriter() = default;
GeoTiffWriter::GeoTiffWriter(GeoTiffWriter&&) noexcept = default;
GeoTiffWriter& GeoTiffWriter::operator=(GeoTiffWriter&&) noexcept = default;

void GeoTiffWriter::write_block(int band, int block_column, int block_row, const void* pixels) {
  // GDAL takes a non-const pointer but only reads.
  if (impl_->dataset->GetRasterBand(band)->WriteBlock(block_column, block_row,
                                                      const_cast<void*>(pixels)) != CE_None)
    fail(impl_->path, "a block cannot be written");
}

void GeoTiffWriter::finish(OverviewMethod method) {
  std::vector<int> factors;
  const int side = std::max(impl_->place.columns, impl_->place.rows);
  for (int factor = 2; side / factor >= kBlock / 2; factor *= 2) factors.push_back(factor);
  const char* const name = method == OverviewMethod::kAverage ? "AVERAGE" : "NEAREST";
  impl_->dataset->FlushCache(false);
  if (!factors.empty() &&
      impl_->dataset->BuildOverviews(name, static_cast<int>(factors.size()), factors.data(), 0,
                                     nullptr, nullptr, nullptr) != CE_None)
    fail(impl_->path, "overviews cannot be built");
  CPLErrorReset();
  GDALClose(impl_->dataset);
  impl_->dataset = nullptr;
  if (CPLGetLastErrorType() >= CE_Failure) fail(impl_->path, "cannot be closed");
}

}  // namespace roadbook
