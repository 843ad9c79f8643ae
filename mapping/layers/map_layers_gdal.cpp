#include "mapping/layers/map_layers_gdal.hpp"

#include <cpl_conv.h>

#include <array>
#include <mutex>
#include <utility>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"

namespace roadbook {
namespace {

constexpr std::array<const char*, 2> kOptions{"OGR_CURRENT_DATE", "OGR_SQLITE_SYNCHRONOUS"};

void register_drivers() {
  static std::once_flag once;
  std::call_once(once, [] { GDALAllRegister(); });
}

}  // namespace

GdalScope::GdalScope(std::string content_time) {
  register_drivers();
  CPLPushErrorHandlerEx(&GdalScope::handle, this);
  if (!content_time.empty()) CPLSetThreadLocalConfigOption(kOptions[0], content_time.c_str());
  // The finished file is flushed as a whole before it takes its place.
  CPLSetThreadLocalConfigOption(kOptions[1], "OFF");
}

GdalScope::~GdalScope() {
  for (const char* option : kOptions) CPLSetThreadLocalConfigOption(option, nullptr);
  CPLPopErrorHandler();
}

void GdalScope::handle(CPLErr severity, CPLErrorNum /*number*/, const char* text) {
  auto* scope = static_cast<GdalScope*>(CPLGetErrorHandlerUserData());
  if (severity >= CE_Failure && scope->fault_.empty()) scope->fault_ = text;
}

void GdalScope::check(const std::filesystem::path& file, const std::string& what) const {
  require(true, file, what);
}

void GdalScope::require(bool ok, const std::filesystem::path& file, const std::string& what) const {
  if (ok && fault_.empty()) return;
  const std::string disk = write_fault(file);
  const std::string got = disk.starts_with("no space") ? disk
                          : fault_.empty()             ? "no reason from GDAL"
                                                       : fault_;
  throw StorageError(to_line(
      {Severity::kError, file.string(), 0, what, got, "a writable file with room on its disk"}));
}

GdalDataset create_geopackage(const GdalScope& scope, const std::filesystem::path& file) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  ROADBOOK_ASSERT(driver != nullptr);
  GdalDataset dataset(driver->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  scope.require(dataset != nullptr, file, "create");
  return dataset;
}

GdalDataset open_geopackage(const GdalScope& scope, const std::filesystem::path& file) {
  const std::array<const char*, 2> drivers{"GPKG", nullptr};
  GdalDataset dataset(GDALDataset::Open(
      file.c_str(), GDAL_OF_VECTOR | GDAL_OF_RASTER | GDAL_OF_UPDATE, drivers.data()));
  scope.require(dataset != nullptr, file, "open");
  return dataset;
}

}  // namespace roadbook
