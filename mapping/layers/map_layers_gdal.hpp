#pragma once

#include <gdal_priv.h>

#include <filesystem>
#include <memory>
#include <string>

namespace roadbook {

/// While it lives, collects the errors of GDAL on this thread instead of printing them. Also sets
/// the options with which GDAL writes the same bytes for the same content.
class GdalScope {
 public:
  /// `content_time`: date that GDAL writes (utc_text).
  explicit GdalScope(std::string content_time = {});
  ~GdalScope();
  GdalScope(const GdalScope&) = delete;
  GdalScope& operator=(const GdalScope&) = delete;

  /// First error so far; empty where there was none. Warnings do not count.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Throws StorageError with the first error, if there was one.
  void check(const std::filesystem::path& file, const std::string& what) const;
  /// The same, also where `ok` is false and GDAL gave no reason.
  void require(bool ok, const std::filesystem::path& file, const std::string& what) const;

 private:
  static void handle(CPLErr severity, CPLErrorNum number, const char* text);
  std::string fault_;
};

struct GdalClose {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using GdalDataset = std::unique_ptr<GDALDataset, GdalClose>;

/// An empty GeoPackage. Throws StorageError.
[[nodiscard]] GdalDataset create_geopackage(const GdalScope& scope,
                                            const std::filesystem::path& file);
/// Opens for changes of vectors and rasters. Throws StorageError.
[[nodiscard]] GdalDataset open_geopackage(const GdalScope& scope,
                                          const std::filesystem::path& file);

}  // namespace roadbook
