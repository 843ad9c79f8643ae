#include "base/error.hpp"
#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/layers/map_layers_raster.hpp"

namespace roadbook {
namespace {

// What each band is, where a GIS program shows it.
void describe_bands(GDALDataset& dataset, const std::string& description) {
  dataset.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", description.c_str());
  for (int band = 1; band <= dataset.GetRasterCount(); ++band) {
    GDALRasterBand* const one = dataset.GetRasterBand(band);
    one->SetDescription(dataset.GetRasterCount() == 1
                            ? description.c_str()
                            : GDALGetColorInterpretationName(one->GetColorInterpretation()));
  }
}

void write_geotiff(const std::filesystem::path& map,
                   const LayerInfo& layer,
                   const std::filesystem::path& out) {
  WholeFile output(out);
  const GdalScope scope;
  const GdalDataset source = open_raster_layer(scope, map, layer.name);
  CPLStringList creation;
  creation.SetNameValue("TILED", "YES");
  creation.SetNameValue("COMPRESS", "DEFLATE");
  creation.SetNameValue("BIGTIFF", "IF_SAFER");
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  GdalDataset target(driver->CreateCopy(output.part().c_str(), source.get(), 0, creation.List(),
                                        nullptr, nullptr));
  scope.require(target != nullptr, out, "geotiff");
  describe_bands(*target, layer.description);
  build_overviews(scope, *target, 256, out);
  target.reset();
  scope.check(out, "geotiff");
  output.commit();
}

LayerInfo info_of(const MapLayers& layers, const std::string& name) {
  for (const LayerInfo& layer : layers.list())
    if (layer.name == name) return layer;
  return {name, "", true};
}

}  // namespace

Paths export_geotiff(const std::filesystem::path& map,
                     const std::filesystem::path& out,
                     const ExportOptions& options) {
  const MapLayers layers(map);
  const std::vector<std::string> names = chosen_rasters(layers, options.layers);
  Paths files;
  for (const std::string& name : names) {
    (void)layers.raster_info(name);  // refuses a layer that is no raster
    files.push_back(names.size() == 1 ? out : with_suffix(out, name));
    write_geotiff(map, info_of(layers, name), files.back());
  }
  return files;
}

}  // namespace roadbook
